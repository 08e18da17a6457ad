/* Finite strain of a grain (contact model `hyperelastic_sphere`). A grain that fills its cell becomes stiffer
   with its mean pressure P = sum F/(4 pi E R^2). The work of its surface displacements, in units of E R^3, is
     (1 - e) H + g W + z^(5/3) Z + 4 pi (P (q P^2 + t D) z^2 - integral of u(P)),
     e = (1 + c_h P)^(-2/3), g = 1/(1 + c P), z = 1/(1 + c_z P),
     D   squared deviator of the mean stress: tr(T^2) - P^2/3, T = sum F n n/(4 pi E R^2), tr T = P
     H   3/5 sum F h, with h this grain's share of the Hertz overlap
     W   work at small strain of point forces, and of each contact's own displacement beyond Hertz
     Z   contribution of the finite contact sizes to this work
     u   overlap over R by uniform compression, which is not part of W.
   The surface displacement at a contact is the derivative with respect to its force, so the forces have a
   potential. The coefficients are fitted to finite elements of one sphere (host/elasticity). */

/* Pressure in E, energies in E R^3. */
typedef struct {
    lanes pressure;               /* P = sum F / (4 pi R^2 E) */
    lanes deviator;               /* D */
    lanes hertz, work, size_work; /* H, W, Z */
} Confined;

/* 1/E_i of the grain [1/Pa]. */
INLINE lanes own_compliance(Grain at) { return OWN(at, sphere_scale) * (R(1) + at.now.excess_compliance); }

/* Factor of F/a in this grain's share of the Hertz overlap [m2/N]. */
INLINE lanes hertz_share(Grain at) {
    return R(0.75) * OWN(at, grain_compliance) * (R(1) + at.now.excess_compliance);
}

/* Work of a contact's own displacement beyond Hertz [J]. */
INLINE lanes own_work(Grain at, lanes force, lanes contact_radius) {
    const lanes radius = at.now.radius;
    return force * force * self_work(at, contact_radius / radius) * (own_compliance(at) / radius);
}

/* T, the mean stress of a grain over E: diagonal, and the components yz, xz, xy. */
typedef struct {
    lanes3 diagonal, mixed;
} MeanStress;

/* Factor of a force in T and P [1/N]. */
INLINE lanes stress_per_force(Grain at) {
    return own_compliance(at) / (R(4) * PI * at.now.radius * at.now.radius);
}

INLINE MeanStress mean_stress(Grain at, EXCHANGE const ContactTable* table) {
    MeanStress sum = {ZERO3, ZERO3};
#pragma unroll 1 /* unrolling would need too many registers on GPUs */
    for (int k = 0; k < CONTACT_SLOTS(at); ++k) {
        const lanes x = table->x[k], y = table->y[k], z = table->z[k];
        const lanes3 load = scale3(table->elastic[k], (lanes3){x, y, z});
        sum.diagonal = add3(sum.diagonal, (lanes3){load.x * x, load.y * y, load.z * z});
        sum.mixed = add3(sum.mixed, (lanes3){load.y * z, load.x * z, load.x * y});
    }
    const lanes scale = stress_per_force(at);
    return (MeanStress){scale3(scale, sum.diagonal), scale3(scale, sum.mixed)};
}

/* n T n - P/3 in the direction n of slot `slot`. */
INLINE lanes deviator_along(MeanStress stress, EXCHANGE const ContactTable* table, int slot) {
    const lanes x = table->x[slot], y = table->y[slot], z = table->z[slot];
    const lanes3 d = stress.diagonal, m = stress.mixed;
    return x * x * d.x + y * y * d.y + z * z * d.z + R(2) * (y * z * m.x + x * z * m.y + x * y * m.z) -
           (d.x + d.y + d.z) / R(3);
}

/* Overwrites the direction of slot v, which is no longer needed: x becomes the work of point forces, y the
   contribution of contact sizes, z the deviator along the direction. The point part scales with the square of
   the forces (factor 1/2), the size part with the power 8/3 (factor 3/8). */
INLINE void tabulate_work(Grain at, MeanStress stress, SurfaceDisplacement b, int v,
                          EXCHANGE ContactTable* table) {
    const int slot = SLOT(v);
    const lanes force = table->elastic[slot], contact_radius = table->radius[slot];
    lanes work = R(0.5) * force * b.point;
    if (at.replica->confinement) work += own_work(at, force, contact_radius);
    table->z[slot] = deviator_along(stress, table, slot);
    table->x[slot] = work;
    table->y[slot] = R(0.375) * force * b.size;
}

/* Pressure and energies of a grain. `b`: surface displacements at its slots, at small strain. */
INLINE Confined confined(Grain at, const SurfaceDisplacement* b, EXCHANGE ContactTable* table) {
    const MeanStress stress = mean_stress(at, table);
    SYNCHRONISE();
    for (int v = 0; v < at.count; ++v) tabulate_work(at, stress, b[v], v, table);
    SYNCHRONISE();
    const lanes radius = at.now.radius, compliance = own_compliance(at);
    lanes force = R(0);
    Confined c = {R(0), R(0), R(0), R(0), R(0)};
#pragma unroll 1
    for (int k = 0; k < CONTACT_SLOTS(at); ++k) {
        const lanes own = table->elastic[k];
        const mask pressed = AS_MASK(own > R(0));
        force += own;
        c.hertz += own * own / WHERE(pressed, table->radius[k], R(1));
        c.work += table->x[k];
        c.size_work += table->y[k];
        c.deviator += own * table->z[k];
    }
    const lanes per_energy = compliance / (radius * radius * radius);
    const lanes per_force = stress_per_force(at);
    c.pressure = force * per_force;
    c.deviator *= per_force;
    c.hertz *= R(0.6) * hertz_share(at) * per_energy;
    c.work *= per_energy;
    c.size_work *= per_energy;
    return c;
}

/* Factors by which pressure reduces the displacements. */
typedef struct {
    lanes hertz, work; /* e, g */
    lanes cubic, size; /* z, z^(5/3) */
} Yielding;

INLINE lanes two_thirds(lanes x) {
    const lanes root = cbrt(x);
    return root * root;
}
INLINE Yielding yielding(Grain at, lanes pressure) {
    const lanes z = R(1) / (R(1) + OWN(at, confinement_size) * pressure);
    const Yielding y = {two_thirds(R(1) / (R(1) + OWN(at, confinement_hertz) * pressure)),
                        R(1) / (R(1) + OWN(at, confinement_coupling) * pressure), z, z * two_thirds(z)};
    return y;
}

/* Overlap over R by uniform compression: u0 P + u1 P^2 + u2 P^3 up to P/K = 0.3, linear beyond. */
typedef struct {
    own_constant u0, u1, u2;
} Bulk;
INLINE Bulk bulk_of(Grain at) {
    const Bulk bulk = {OWN(at, confinement_bulk[0]), OWN(at, confinement_bulk[1]),
                       OWN(at, confinement_bulk[2])};
    return bulk;
}
INLINE lanes last_power_pressure(Bulk u, lanes P) {
    return WHERE(AS_MASK((lanes)(u.u0) > R(0)), fmin(P, R(0.1) / u.u0), P);
}
INLINE lanes uniform_slope(Bulk u, lanes p) { return u.u0 + p * (R(2) * u.u1 + R(3) * u.u2 * p); }
INLINE lanes uniform_overlap(Bulk u, lanes P) {
    const lanes p = last_power_pressure(u, P);
    return p * (u.u0 + p * (u.u1 + p * u.u2)) + (P - p) * uniform_slope(u, p);
}
INLINE lanes uniform_work(Bulk u, lanes P) {
    const lanes p = last_power_pressure(u, P), more = P - p;
    return p * p * (R(0.5) * u.u0 + p * (u.u1 / R(3) + R(0.25) * u.u2 * p)) +
           more * (uniform_overlap(u, p) + R(0.5) * more * uniform_slope(u, p));
}

/* Integral of the displacements below over the forces [J]. */
INLINE lanes confined_work(Grain at, Confined grain) {
    const lanes radius = at.now.radius, P = grain.pressure;
    const Yielding y = yielding(at, P);
    const lanes cubic = OWN(at, confinement_volume) * P * P + OWN(at, confinement_shear) * grain.deviator;
    const lanes volume = R(4) * PI * (P * cubic * y.cubic * y.cubic - uniform_work(bulk_of(at), P));
    const lanes sum =
        (R(1) - y.hertz) * grain.hertz + y.work * grain.work + y.size * grain.size_work + volume;
    return sum * radius * radius * radius / own_compliance(at);
}

/* Values shared by all slots of a grain. */
typedef struct {
    Yielding yielding;
    lanes alike;   /* displacement that is equal at all slots [m] */
    lanes sheared; /* displacement by the deviator along a slot's direction [m] */
} Confinement;

INLINE Confinement confinement_of(Grain at, Confined grain) {
    const lanes P = grain.pressure, c = OWN(at, confinement_coupling), c_hertz = OWN(at, confinement_hertz),
                c_size = OWN(at, confinement_size);
    const Yielding y = yielding(at, P);
    const lanes by_pressure = R(2) / R(3) * c_hertz * y.hertz / (R(1) + c_hertz * P) * grain.hertz -
                              c * y.work * y.work * grain.work -
                              R(5) / R(3) * c_size * y.cubic * y.size * grain.size_work;
    const lanes volume = OWN(at, confinement_volume) * P * P,
                sheared = OWN(at, confinement_shear) * grain.deviator;
    const lanes cubic =
        y.cubic * y.cubic * (R(3) * volume + sheared - R(2) * c_size * P * y.cubic * (volume + sheared));
    const Confinement all = {
        y, at.now.radius * (by_pressure / (R(4) * PI) + cubic - uniform_overlap(bulk_of(at), P)),
        at.now.radius * R(2) * OWN(at, confinement_shear) * P * y.cubic * y.cubic};
    return all;
}

/* Surface displacement at slot v, from that at small strain [m]. Excludes the part of the contact's own
   displacement that is solved within the step (known_share in self_displacement.h). */
INLINE lanes confined_displacement(Grain at, Confinement all, SurfaceDisplacement small_strain, int v,
                                   EXCHANGE const ContactTable* table) {
    const Yielding y = all.yielding;
    const lanes radius = at.now.radius, force = table->elastic[SLOT(v)],
                contact_radius = table->radius[SLOT(v)];
    const lanes hertz = hertz_share(at) * force / WHERE(AS_MASK(contact_radius > R(0)), contact_radius, R(1));
    const lanes relative = contact_radius / radius, scaled = force * (own_compliance(at) / radius);
    const lanes own = whole_self_displacement(at, self_terms_here(at), relative);
    const lanes at_once = own * known_share(at, relative);
    return (R(1) - y.hertz) * hertz + scaled * (y.work * own - at_once) + y.work * small_strain.point +
           y.size * small_strain.size + all.sheared * table->z[SLOT(v)] + all.alike;
}
