/* Finite strain of a grain (hyperelastic sphere). Its mean pressure P adds to the modulus, since a sphere
   that fills its cell yields as little as the cell's shape lets it, whatever its modulus.
     H   3/5 sum F h, h this grain's side of Hertz's overlap
     W   outward work of what contacts displace at themselves beyond Hertz and, as points, at one another
     Z   what their sizes add to it
     e = (1 + c_h P)^(-2/3), g = 1/(1 + c P), all in E R^3:
     (1 - e) H + g W + g^(5/3) Z + 4 pi (q P^3 g^2 - integral of u(P)).
   The derivative by a contact's force is its surface displacement, so that forces have a potential. u is
   uniform compression, which W is without. */

/* Of a grain, over E R^3. */
typedef struct {
    lanes pressure; /* sum F / (4 pi R^2 E) */
    lanes hertz, work, size_work;
} Confined;

/* 1/E_i of the grain [1/Pa]. */
INLINE lanes own_compliance(Grain at) { return OWN(at, sphere_scale) * (R(1) + at.now.excess_compliance); }

/* The grain's side of Hertz's overlap is that times F/a [m2/N]. */
INLINE lanes hertz_share(Grain at) {
    return R(0.75) * OWN(at, grain_compliance) * (R(1) + at.now.excess_compliance);
}

/* Of what contacts displace at themselves beyond Hertz [J]. */
INLINE lanes own_work(Grain at, lanes force, lanes contact_radius) {
    const lanes radius = at.now.radius;
    return force * force * self_work(at, contact_radius / radius) * (own_compliance(at) / radius);
}

/* Work of slot v, as points into x and by size into y: no direction is asked for any more. The part of
   points goes with the square of the forces, that of finite contacts with the power 8/3. */
INLINE void tabulate_work(Grain at, SurfaceDisplacement b, int v, EXCHANGE ContactTable* table) {
    const int slot = SLOT(v);
    const lanes force = table->elastic[slot], contact_radius = table->radius[slot];
    lanes work = R(0.5) * force * b.point;
    if (at.replica->confinement) work += own_work(at, force, contact_radius);
    table->x[slot] = work;
    table->y[slot] = R(0.375) * force * b.size;
}

/* `b`: what its contacts displace at its slots. */
INLINE Confined confined(Grain at, const SurfaceDisplacement* b, EXCHANGE ContactTable* table) {
    SYNCHRONISE();
    for (int v = 0; v < at.count; ++v) tabulate_work(at, b[v], v, table);
    SYNCHRONISE();
    const lanes radius = at.now.radius, compliance = own_compliance(at);
    lanes force = R(0);
    Confined c = {R(0), R(0), R(0), R(0)};
#pragma unroll 1 /* a GPU has registers for little more */
    for (int k = 0; k < CONTACT_SLOTS(at); ++k) {
        const lanes own = table->elastic[k];
        const mask pressed = AS_MASK(own > R(0));
        force += own;
        c.hertz += own * own / WHERE(pressed, table->radius[k], R(1));
        c.work += table->x[k];
        c.size_work += table->y[k];
    }
    const lanes per_energy = compliance / (radius * radius * radius);
    c.pressure = force * compliance / (R(4) * PI * radius * radius);
    c.hertz *= R(0.6) * hertz_share(at) * per_energy;
    c.work *= per_energy;
    c.size_work *= per_energy;
    return c;
}

/* What pressure leaves of the displacements. */
typedef struct {
    lanes hertz, work, size; /* e, g, g^(5/3) */
} Yielding;

INLINE lanes two_thirds(lanes x) {
    const lanes root = cbrt(x);
    return root * root;
}
INLINE Yielding yielding(Grain at, lanes pressure) {
    const lanes g = R(1) / (R(1) + OWN(at, confinement_coupling) * pressure);
    const Yielding y = {two_thirds(R(1) / (R(1) + OWN(at, confinement_hertz) * pressure)), g,
                        g * two_thirds(g)};
    return y;
}

/* Overlap over R by uniform compression: powers of P up to P/K = 0.3, straight beyond. */
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

/* The integral of the displacements below over the forces [J]. */
INLINE lanes confined_work(Grain at, Confined grain) {
    const lanes radius = at.now.radius, P = grain.pressure;
    const Yielding y = yielding(at, P);
    const lanes volume =
        R(4) * PI *
        (OWN(at, confinement_volume) * P * P * P * y.work * y.work - uniform_work(bulk_of(at), P));
    const lanes sum =
        (R(1) - y.hertz) * grain.hertz + y.work * grain.work + y.size * grain.size_work + volume;
    return sum * radius * radius * radius / own_compliance(at);
}

/* What is the same at every slot of a grain. */
typedef struct {
    Yielding yielding;
    lanes alike; /* displacement [m] */
} Confinement;

INLINE Confinement confinement_of(Grain at, Confined grain) {
    const lanes P = grain.pressure, c = OWN(at, confinement_coupling), c_hertz = OWN(at, confinement_hertz);
    const Yielding y = yielding(at, P);
    const lanes by_pressure = R(2) / R(3) * c_hertz * y.hertz / (R(1) + c_hertz * P) * grain.hertz -
                              c * y.work * (y.work * grain.work + R(5) / R(3) * y.size * grain.size_work);
    const lanes volume =
        OWN(at, confinement_volume) * P * P * y.work * y.work * (R(3) - R(2) * c * P * y.work);
    const Confinement all = {
        y, at.now.radius * (by_pressure / (R(4) * PI) + volume - uniform_overlap(bulk_of(at), P))};
    return all;
}

/* The displacement of the grain's surface at its slot v, from that of small strain [m]; without the part of
   a contact's own that is known at once. */
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
           y.size * small_strain.size + all.alike;
}
