/* Effects beyond the plain contact model, one function per effect. Each is off at its default amplitude.
   Every expression gives the same bits on both sides of a contact, so that momentum is conserved.
   Formulas and sources: kernels/README.md, "Effects". */

/* Effective modulus of grains of unequal stiffness, E_i = E / (1 + excess_compliance_i):
   1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j; the shear modulus likewise. A wall has no excess compliance. */
INLINE lanes scattered_modulus(Grain at, Neighbours neighbour, lanes modulus, lanes compliance,
                               lanes compliance_there) {
    const lanes excess = at.now.excess_compliance;
#if SPECIES > 1
    return modulus /
           (R(1) + modulus * add_alike(compliance * excess, compliance_there * neighbour.excess_compliance));
#else
    return modulus / (R(1) + modulus * compliance * (excess + neighbour.excess_compliance));
#endif
}

/* Surface displacements reduced to `part` of their value if the undeformed grains do not overlap. The factor
   increases linearly with the geometric overlap, and is 1 once that overlap equals the displacements. */
INLINE lanes counted_displacements(lanes gap, lanes outward, real part) {
    const lanes share = clamp(-gap / fmax(fabs(outward), (lanes)(R(1e-30))), (lanes)(R(0)), (lanes)(R(1)));
    return outward * (part + (R(1) - part) * share);
}

/* Plasticity: a part d_p = p d_max of the largest overlap is permanent. Unloading follows
   F(d_max) ((d - d_p)/(d_max - d_p))^(3/2), which is Walton & Braun (1986) with Hertz's exponent instead of
   straight lines. It equals Hertz's law at the overlap (d - d_p)/(1 - p). Below d_p there is a gap d_p - d.
 */
INLINE lanes plastic_approach(lanes approach, real part, mask occupied, lanes* restrict deepest) {
    *deepest = WHERE(occupied, fmax(*deepest, approach), R(0));
    const lanes left = approach - part * *deepest;
    return WHERE(AS_MASK(left > R(0)), left / (R(1) - part), left);
}

/* Standard linear solid in each contact (Zener 1948): F = max(F_H - a q, 0), dq/dt = (F_H - q)/T. The step of
   q is exact for a constant F_H. */
INLINE lanes relaxing_force(lanes elastic, real part, real share, lanes* restrict relaxed) {
    const lanes force = fmax(elastic - part * *relaxed, (lanes)(R(0)));
    *relaxed += share * (elastic - *relaxed);
    return force;
}

/* Attraction of two grains [N].
   Adhesion: 2 pi w R*, independent of the overlap (Derjaguin, Muller & Toporov 1975). In a gap it decreases
   linearly to zero over 0.01 R*, or over a longer range if its slope would otherwise exceed m* / (20 dt^2).
   The range never exceeds the probed gap.
   Cohesion: k times the area 2 pi R* delta of the circle in which spheres that overlap by delta intersect
   ("SJKR" of LIGGGHTS). */
typedef struct {
    lanes adhesion, range, cohesion, force;
} Attraction;

INLINE Attraction attraction(global const Replica* restrict replica, lanes approach, lanes overlap,
                             Reduced pair, mask occupied) {
    const real dt = replica->time_step;
    const lanes pull_off_force = replica->adhesion * pair.radius;
    const lanes resolved = fmax(R(0.01) * pair.radius, R(20) * dt * dt * pull_off_force / pair.mass);
    Attraction a;
    a.range = fmax(fmin(resolved, (lanes)(replica->probe_gap)), (lanes)(R(1e-30)));
    a.adhesion = WHERE(occupied,
                       pull_off_force * clamp(R(1) + approach / a.range, (lanes)(R(0)), (lanes)(R(1))), R(0));
    a.cohesion = replica->cohesion * pair.radius * overlap;
    a.force = a.adhesion + a.cohesion;
    return a;
}

/* Hertz force times 1 + c delta/R*. For c < 0 it is divided by 1 - c delta/R* instead: equal to first order,
   and the force still increases with the overlap. */
INLINE lanes stiffened(global const Replica* restrict replica, lanes elastic, lanes overlap,
                       lanes reduced_radius) {
    const lanes change = replica->stiffening * overlap / reduced_radius;
    return replica->stiffening > R(0) ? elastic * (R(1) + change) : elastic / (R(1) - change);
}

/* Hertz force times (delta / (0.1 R*))^m: the force grows with the power 3/2 + m of the overlap. It is
   Hertz's at a tenth of R*, where soft grains are pressed. Without overlap it is zero. */
INLINE lanes with_exponent(real exponent, lanes elastic, lanes overlap, lanes reduced_radius) {
    const lanes relative = R(10) * overlap / reduced_radius;
    return elastic * pow(fmax(relative, (lanes)(R(1e-6))), (lanes)(exponent));
}

/* Stored energy of a contact in excess of 2/5 F delta [J], without what relaxation and plasticity have
   dissipated. The integral of F over the overlap is exact for stiffening; for softening it is approximated by
   a rational function, within 3 % with Hertz's exponent. */
INLINE lanes effect_energy(global const Replica* restrict replica, lanes elastic, lanes relaxed_force,
                           lanes overlap, lanes reduced_radius) {
    const lanes change = fabs(replica->stiffening) * overlap / reduced_radius;
    const real stored = R(1) / (R(2.5) + replica->law_exponent),
               next = R(1) / (R(3.5) + replica->law_exponent);
    const real slower = replica->stiffening > R(0) ? R(1) : R(2) * next / stored - R(1);
    const lanes loading = elastic * overlap * (stored + change * next) / (R(1) + change * slower);
    const lanes lasting =
        (R(1) - replica->plasticity) * (loading - stored * (elastic - relaxed_force) * overlap);
    return lasting - R(0.4) * elastic * overlap;
}

/* Energy of the attraction, zero beyond its range [J]. */
INLINE lanes attraction_energy(Attraction a, lanes overlap, lanes approach) {
    const lanes inside = clamp(a.range + approach, (lanes)(R(0)), a.range);
    return -a.adhesion * (R(0.5) * inside + overlap) - R(0.5) * a.cohesion * overlap;
}

/* Rolling resistance: a spring between the rotations of two grains across the normal, with stiffness
   k_r = 8 G* a R*^2 (Iwashita & Oda 1998: the tangential stiffness times R*^2), damped as the tangential
   spring is, and cut at the torque mu_r R* F_n (Ai et al. 2011, model C). It keeps its couple while the
   normal load increases, with every law of friction. Twisting is not resisted. `spring` is that of the
   tangential force with the limit F_n. Returns the torque on this grain [N m]; updates the spring's `couple`.
 */
INLINE lanes3 rolling_couple(Grain at, Neighbours neighbour, lanes reduced_radius, SpringTerms spring,
                             real elapsed, lanes3* restrict couple, lanes* restrict power) {
    const lanes r = at.now.radius, r_there = neighbour.radius;
    lanes fifth = r * r * r * r * r;
    lanes fifth_there = r_there * r_there * r_there * r_there * r_there;
#if SPECIES > 1
    fifth *= OWN(at, relative_density);
    fifth_there *= of_neighbours(at, neighbour, PLACE_OF(relative_density));
#endif
    spring.limit *= at.replica->rolling_resistance * reduced_radius;
    spring.stiffness *= reduced_radius * reduced_radius;
    spring.kept = fmin(spring.kept, (lanes)(R(1)));
    spring.reduced_mass = at.materials->density * (R(8) / R(15)) * PI *
                          WHERE(neighbour.wall, fifth, R(1) / (R(1) / fifth + R(1) / fifth_there));
    const lanes3 turning = subtract3(neighbour.spin, at.now.spin);
    const lanes3 rolling = add_scaled3(turning, -dot3(turning, neighbour.normal), neighbour.normal);
    return cut_spring(spring, rolling, neighbour.normal, elapsed, couple, power);
}
