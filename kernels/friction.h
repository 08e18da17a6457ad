/* Tangential force of a contact. Two laws: saturated friction (Brodu et al. 2015), and a Mindlin spring cut
   at the Coulomb limit. The effect `friction_history` uses a weighted mean of both. */

/* Parameters of a contact's friction; for rolling resistance in brackets. */
typedef struct {
    lanes limit;        /* mu F_n [N] (mu_r R* F_n [N m]) */
    lanes stiffness;    /* of the spring, 8 G* a [N/m] (8 G* a R*^2 [N m]) */
    lanes damping;      /* 2 sqrt(5/6) beta */
    lanes reduced_mass; /* m* [kg] (reduced moment of inertia [kg m2]) */
    mask touching;
} SpringTerms;

/* Saturated friction: mu F_n against the sliding velocity. It is viscous below `sliding_velocity`, and its
   viscosity is at most a tenth of m* over dt, so that a time step cannot reverse the sliding. */
INLINE lanes3 saturated_friction(global const Replica* restrict replica, SpringTerms contact,
                                 lanes3 sliding) {
    const real slow = replica->sliding_velocity;
    const lanes inverse_speed = inverse_root(dot3(sliding, sliding) + slow * slow);
    const lanes max_viscosity = contact.reduced_mass * (R(0.1) / replica->time_step);
    return scale3(fmin(contact.limit * inverse_speed, max_viscosity), sliding);
}

/* Spring with damping, cut at the limit; for friction it is the Mindlin spring. A slipping spring keeps the
   elongation at which its force equals the limit. Updates `spring`. */
INLINE lanes3 cut_spring(SpringTerms contact, lanes3 sliding, lanes3 normal, real elapsed,
                         lanes3* restrict spring) {
    const lanes damping = contact.damping * sqrt(contact.stiffness * contact.reduced_mass);
    lanes3 s = add_scaled3(*spring, elapsed, sliding);
    s = add_scaled3(s, -dot3(s, normal), normal);
    const lanes3 full = add_scaled3(scale3(damping, sliding), contact.stiffness, s);
    const lanes inverse_size = inverse_root(fmax(dot3(full, full), (lanes)(R(1e-37))));
    const lanes cut = fmin(contact.limit * inverse_size, (lanes)(R(1)));
    *spring = scale3(WHERE(contact.touching, cut, R(0)), s);
    return scale3(cut, full);
}

/* Saturated friction, Mindlin friction, or with EFFECT_FRICTION_HISTORY their mean weighted by
   `mindlin_share`. */
INLINE lanes3 friction(global const Replica* restrict replica, const int effects, SpringTerms contact,
                       lanes3 sliding, lanes3 normal, real elapsed, lanes3* restrict spring) {
    lanes3 with_history = ZERO3;
    if (replica->mindlin) with_history = cut_spring(contact, sliding, normal, elapsed, spring);
    if (replica->mindlin && !(effects & EFFECT_FRICTION_HISTORY)) return with_history;
    const lanes3 saturated = saturated_friction(replica, contact, sliding);
    if (!replica->mindlin) return saturated;
    return add_scaled3(saturated, replica->mindlin_share, subtract3(with_history, saturated));
}
