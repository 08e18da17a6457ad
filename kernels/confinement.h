/* Finite strain of a grain (hyperelastic sphere). Its mean pressure P adds to the modulus, since a sphere
   that fills its cell yields as little as the cell's shape lets it, whatever its modulus.
     H   3/5 sum F h, h this grain's side of Hertz's overlap
     W   outward work of what contacts displace at themselves beyond Hertz and, as points, at one another
     Z   what their sizes add to it
     e = (1 + c_h P)^(-2/3), g = 1/(1 + c P), all in E R^3:
     (1 - e) H + g W + g^(5/3) Z + 4 pi (q P^3 g^2 - integral of u(P)).
   The derivative by a contact's force is its surface displacement, so that forces have a potential. u is
   uniform compression, which W is without. */

/* Of one grain, over E R^3. */
typedef struct {
    real pressure; /* sum F / (4 pi R^2 E) */
    real hertz, work, size_work;
} Confined;

/* 1/E_i of the grain [1/Pa]. */
INLINE real own_compliance(Grain at) { return at.material->sphere_scale * (R(1) + at.now.velocity.w); }

/* The grain's side of Hertz's overlap is that times F/a [m2/N]. */
INLINE real hertz_share(Grain at) {
    return R(0.75) * at.material->grain_compliance * (R(1) + at.now.velocity.w);
}

/* Of what contacts displace at themselves beyond Hertz [J]. */
INLINE lanes own_work(Grain at, lanes force, lanes contact_radius) {
    const real radius = at.now.position.w;
    return force * force * self_work(at.material, contact_radius / radius) * (own_compliance(at) / radius);
}

/* Work of slots v, as points into x and by size into y: no direction is asked for any more. The part of
   points goes with the square of the forces, that of finite contacts with the power 8/3. */
INLINE void tabulate_work(Grain at, SurfaceDisplacement b, int v, EXCHANGE ContactTable* table) {
    const lanes force = LOAD_LANES(table->elastic, v), contact_radius = LOAD_LANES(table->radius, v);
    lanes work = R(0.5) * force * b.point;
    if (at.replica->confinement) work += own_work(at, force, contact_radius);
    STORE_LANES(work, table->x, v);
    STORE_LANES(R(0.375) * force * b.size, table->y, v);
}

/* `b`: what its contacts displace at all slots, VECTORS of them. */
INLINE Confined confined(Grain at, const SurfaceDisplacement* b, EXCHANGE ContactTable* table) {
    SYNCHRONISE();
    for (int v = 0; v < VECTORS; ++v) tabulate_work(at, b[v], v, table);
    SYNCHRONISE();
    const real radius = at.now.position.w, compliance = own_compliance(at);
    real force = R(0);
    Confined c = {R(0), R(0), R(0), R(0)};
    for (int k = 0; k < SLOTS; ++k) {
        const real own = table->elastic[k];
        force += own;
        if (own > R(0)) c.hertz += own * own / table->radius[k];
        c.work += table->x[k];
        c.size_work += table->y[k];
    }
    const real per_energy = compliance / (radius * radius * radius);
    c.pressure = force * compliance / (R(4) * PI * radius * radius);
    c.hertz *= R(0.6) * hertz_share(at) * per_energy;
    c.work *= per_energy;
    c.size_work *= per_energy;
    return c;
}

/* What pressure leaves of the displacements. */
typedef struct {
    real hertz, work, size; /* e, g, g^(5/3) */
} Yielding;

INLINE real two_thirds(real x) {
    const real root = cbrt(x);
    return root * root;
}
INLINE Yielding yielding(global const Material* restrict material, real pressure) {
    const real g = R(1) / (R(1) + material->confinement_coupling * pressure);
    const Yielding y = {two_thirds(R(1) / (R(1) + material->confinement_hertz * pressure)), g,
                        g * two_thirds(g)};
    return y;
}

/* Overlap over R by uniform compression: powers of P up to P/K = 0.3, straight beyond. */
INLINE real last_power_pressure(global const real* u, real P) {
    return u[0] > R(0) ? fmin(P, R(0.1) / u[0]) : P;
}
INLINE real uniform_slope(global const real* u, real p) { return u[0] + p * (R(2) * u[1] + R(3) * u[2] * p); }
INLINE real uniform_overlap(global const real* u, real P) {
    const real p = last_power_pressure(u, P);
    return p * (u[0] + p * (u[1] + p * u[2])) + (P - p) * uniform_slope(u, p);
}
INLINE real uniform_work(global const real* u, real P) {
    const real p = last_power_pressure(u, P), more = P - p;
    return p * p * (R(0.5) * u[0] + p * (u[1] / R(3) + R(0.25) * u[2] * p)) +
           more * (uniform_overlap(u, p) + R(0.5) * more * uniform_slope(u, p));
}

/* The integral of the displacements below over the forces [J]. */
INLINE real confined_work(Grain at, Confined grain) {
    global const Material* restrict material = at.material;
    global const real* u = material->confinement_bulk;
    const real radius = at.now.position.w, P = grain.pressure;
    const Yielding y = yielding(material, P);
    const real volume =
        R(4) * PI * (material->confinement_volume * P * P * P * y.work * y.work - uniform_work(u, P));
    const real sum = (R(1) - y.hertz) * grain.hertz + y.work * grain.work + y.size * grain.size_work + volume;
    return sum * radius * radius * radius / own_compliance(at);
}

/* The displacement of the grain's surface at its slots v, from that of small strain [m]; without the part of
   a contact's own that is known at once. */
INLINE lanes confined_displacement(Grain at, Confined grain, SurfaceDisplacement small_strain, int v,
                                   EXCHANGE const ContactTable* table) {
    global const Material* restrict material = at.material;
    global const real* u = material->confinement_bulk;
    const real radius = at.now.position.w, P = grain.pressure, c = material->confinement_coupling;
    const real c_hertz = material->confinement_hertz;
    const Yielding y = yielding(material, P);
    const real by_pressure = R(2) / R(3) * c_hertz * y.hertz / (R(1) + c_hertz * P) * grain.hertz -
                             c * y.work * (y.work * grain.work + R(5) / R(3) * y.size * grain.size_work);
    const real volume =
        material->confinement_volume * P * P * y.work * y.work * (R(3) - R(2) * c * P * y.work);
    const real alike = radius * (by_pressure / (R(4) * PI) + volume - uniform_overlap(u, P));
    const lanes force = LOAD_LANES(table->elastic, v), contact_radius = LOAD_LANES(table->radius, v);
    const lanes hertz = WHERE(contact_radius > R(0), hertz_share(at) * force / contact_radius, R(0));
    const lanes relative = contact_radius / radius, scaled = force * (own_compliance(at) / radius);
    const lanes own = whole_self_displacement(at, self_terms_here(at), relative);
    const lanes at_once = own * known_share(at, relative);
    return (R(1) - y.hertz) * hertz + scaled * (y.work * own - at_once) + y.work * small_strain.point +
           y.size * small_strain.size + alike;
}
