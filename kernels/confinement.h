/* Finite strain of a grain as a whole (hyperelastic sphere): its mean pressure P weakens what contacts do to
   one another, and its volume gives way less. With W the energy of all pairs of contacts at small strain, the
   pairs have g W - 4 pi q P^3 g^2, g = 1/(1 + c P), in E R^3; a contact's overlap is the derivative of the
   whole energy by its force, so that forces have a potential. */

/* Of one grain. */
typedef struct {
    real pressure; /* sum F / (4 pi R^2 E) */
    real pairs;    /* -W, the work of the pairs' displacements */
} Confined;

/* The part of points goes with the square of the forces, that of finite contacts with the power 8/3. */
INLINE void tabulate_work(SurfaceDisplacement b, int v, EXCHANGE ContactTable* table) {
    STORE_LANES(LOAD_LANES(table->elastic, v) * (R(0.5) * b.point + R(0.375) * b.size), table->work, v);
}

/* 1/E_i of the grain [1/Pa]. */
INLINE real own_compliance(Grain at) { return at.material->sphere_scale * (R(1) + at.now.velocity.w); }

INLINE Confined confined(Grain at, EXCHANGE const ContactTable* table) {
    const real radius = at.now.position.w, compliance = own_compliance(at);
    real force = R(0), work = R(0);
    for (int k = 0; k < SLOTS; ++k) {
        force += table->elastic[k];
        work += table->work[k];
    }
    const real per_area = compliance / (radius * radius);
    const Confined c = {force * per_area / (R(4) * PI), work * per_area / radius};
    return c;
}

/* The integral of the displacements below over the forces [J]. */
INLINE real confined_work(Grain at, Confined grain) {
    const real radius = at.now.position.w, compliance = own_compliance(at);
    const real P = grain.pressure, g = R(1) / (R(1) + at.material->confinement_coupling * P);
    const real volume = R(4) * PI * at.material->confinement_volume * P * P * P * g * g;
    return (g * grain.pairs + volume) * radius * radius * radius / compliance;
}

/* The displacement of the grain's surface at its slots v, from that of small strain [m]. */
INLINE lanes confined_displacement(Grain at, Confined grain, lanes small_strain) {
    const real radius = at.now.position.w;
    const real c = at.material->confinement_coupling, P = grain.pressure, g = R(1) / (R(1) + c * P);
    const real volume = at.material->confinement_volume * P * P * (R(3) - R(2) * c * P * g);
    return g * small_strain + radius * g * g * (volume - c * grain.pairs / (R(4) * PI));
}
