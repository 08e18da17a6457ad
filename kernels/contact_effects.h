/* What goes beyond the plain contact, effect by effect, each off at its default. Every expression is the same
   seen from both sides, to the last bit. */

/* Grains of unequal stiffness, E_i = E / (1 + excess_compliance_i):
   1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j, the shear modulus likewise; a wall's excess compliance is zero.
 */
INLINE lanes scattered_modulus(Grain at, Neighbours seen, lanes modulus, lanes compliance,
                               lanes compliance_there) {
    const lanes excess = at.now.excess_compliance;
#if SPECIES > 1
    return modulus /
           (R(1) + modulus * add_alike(compliance * excess, compliance_there * seen.excess_compliance));
#else
    return modulus / (R(1) + modulus * compliance * (excess + seen.excess_compliance));
#endif
}

/* The displacements as far as they count: only `part` of them where the grains by themselves do not overlap,
   all of them from where the geometric overlap is as large as they are. */
INLINE lanes counted_displacements(lanes gap, lanes outward, real part) {
    const lanes share = clamp(-gap / fmax(fabs(outward), (lanes)(R(1e-30))), (lanes)(R(0)), (lanes)(R(1)));
    return outward * (part + (R(1) - part) * share);
}

/* A part of the deepest overlap stays: d_p = p d_max. Unloading follows F(d_max) ((d - d_p)/(d_max -
   d_p))^(3/2) (Walton & Braun 1986 with Hertz's power in place of straight lines), that is Hertz's law at the
   overlap (d - d_p)/(1 - p); beyond d_p there is a gap of d_p - d. */
INLINE lanes plastic_approach(lanes approach, real part, mask occupied, lanes* restrict deepest) {
    *deepest = WHERE(occupied, fmax(*deepest, approach), R(0));
    const lanes left = approach - part * *deepest;
    return WHERE(AS_MASK(left > R(0)), left / (R(1) - part), left);
}

/* Standard linear solid in each contact (Zener 1948): F = F_H - a q, dq/dt = (F_H - q)/T, with q taken over
   the step exactly for a force that stays. A contact does not pull by it. */
INLINE lanes relaxing_force(lanes elastic, real part, real share, lanes* restrict relaxed) {
    const lanes force = fmax(elastic - part * *relaxed, (lanes)(R(0)));
    *relaxed += share * (elastic - *relaxed);
    return force;
}

/* Attraction of touching grains, 2 pi w R* whatever the overlap (Derjaguin, Muller & Toporov 1975). In a gap
   it fades to zero over a hundredth of R*, or as far as it takes for its slope to stay below m* / (20 dt^2).
 */
typedef struct {
    lanes force, range;
} Attraction;

INLINE Attraction attraction(global const Replica* restrict replica, lanes approach, lanes reduced_radius,
                             lanes reduced_mass, mask occupied) {
    const real dt = replica->time_step;
    const lanes pull_off_force = replica->adhesion * reduced_radius;
    const lanes resolved = fmax(R(0.01) * reduced_radius, R(20) * dt * dt * pull_off_force / reduced_mass);
    Attraction a;
    a.range = fmax(fmin(resolved, (lanes)(replica->probe_gap)), (lanes)(R(1e-30)));
    a.force = WHERE(occupied, pull_off_force * clamp(R(1) + approach / a.range, (lanes)(R(0)), (lanes)(R(1))),
                    R(0));
    return a;
}

/* Hertz's force times 1 + c delta/R* at large strain; softening by 1/(1 - c delta/R*) instead, the same to
   first order and a force that still grows with the overlap. */
INLINE lanes stiffened(global const Replica* restrict replica, lanes elastic, lanes overlap,
                       lanes reduced_radius) {
    const lanes change = replica->stiffening * overlap / reduced_radius;
    return replica->stiffening > R(0) ? elastic * (R(1) + change) : elastic / (R(1) - change);
}

/* What the springs of a contact store beyond 2/5 F delta, nothing of what has relaxed or stays behind for
   good [J]. The integral of F over the overlap is exact for stiffening; for softening a rational function
   meets it within 3 %. */
INLINE lanes effect_energy(global const Replica* restrict replica, lanes elastic, lanes relaxed_force,
                           lanes overlap, lanes reduced_radius) {
    const lanes change = fabs(replica->stiffening) * overlap / reduced_radius;
    const real slower = replica->stiffening > R(0) ? R(1) : R(3) / R(7);
    const lanes loading = elastic * overlap * (R(0.4) + change * R(2) / R(7)) / (R(1) + change * slower);
    const lanes lasting =
        (R(1) - replica->plasticity) * (loading - R(0.4) * (elastic - relaxed_force) * overlap);
    return lasting - R(0.4) * elastic * overlap;
}

/* Energy of the attraction, zero out of its range [J]. */
INLINE lanes attraction_energy(Attraction a, lanes overlap, lanes approach) {
    const lanes inside = clamp(a.range + approach, (lanes)(R(0)), a.range);
    return -a.force * (R(0.5) * inside + overlap);
}

/* Couple of constant size mu_r R* F_n against the relative angular velocity, rolling and twisting alike (Zhou
   et al. 1999; model A of Ai et al. 2011). It fades to a viscous one as saturated friction does. */
INLINE lanes3 rolling_couple(Grain at, Neighbours seen, lanes normal_force, lanes reduced_radius) {
    global const Replica* restrict replica = at.replica;
    const lanes r = at.now.radius;
    const lanes r_there = seen.radius;
    lanes fifth = r * r * r * r * r;
    lanes fifth_there = r_there * r_there * r_there * r_there * r_there;
#if SPECIES > 1
    fifth *= OWN(at, relative_density);
    fifth_there *= of_neighbours(at, seen, PLACE_OF(relative_density));
#endif
    const lanes reduced_inertia = at.materials->density * (R(8) / R(15)) * PI *
                                  WHERE(seen.wall, fifth, R(1) / (R(1) / fifth + R(1) / fifth_there));
    const lanes3 relative = subtract3(seen.spin, at.now.spin);
    const lanes slow = replica->sliding_velocity / reduced_radius;
    const lanes limit = replica->rolling_resistance * reduced_radius * fmax(normal_force, (lanes)(R(0)));
    const lanes viscosity = fmin(limit / sqrt(dot3(relative, relative) + slow * slow),
                                 reduced_inertia * (R(0.1) / replica->time_step));
    return scale3(viscosity, relative);
}
