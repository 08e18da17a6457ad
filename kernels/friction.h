/* Friction of a contact against sliding: two laws, or a share of each. */

/* What limits a contact's friction, beside how it slides. */
typedef struct {
    lanes limit;        /* mu F_n [N] */
    lanes stiffness;    /* of the spring, 8 G* a [N/m] */
    lanes damping;      /* 2 sqrt(5/6) beta */
    lanes reduced_mass; /* m* [kg] */
    mask touching;
} FrictionTerms;

/* Always saturated [paper]: mu F_n against the sliding. Below `sliding_velocity`, and where a step's
   friction could do more than stop the sliding, it fades to a viscous force so that it cannot chatter. */
INLINE lanes3 saturated_friction(global const Replica* restrict replica, FrictionTerms contact,
                                 lanes3 sliding) {
    const real slow = replica->sliding_velocity;
    const lanes inverse_speed = inverse_root(dot3(sliding, sliding) + slow * slow);
    const lanes max_viscosity = contact.reduced_mass * (R(0.1) / replica->time_step);
    return scale3(fmin(contact.limit * inverse_speed, max_viscosity), sliding);
}

/* Mindlin spring with damping, cut at the Coulomb limit; a slipping spring keeps the elongation that carries
   the limit. Updates `spring`. */
INLINE lanes3 mindlin_friction(FrictionTerms contact, lanes3 sliding, lanes3 normal, real elapsed,
                               lanes3* restrict spring) {
    const lanes damping = contact.damping * sqrt(contact.stiffness * contact.reduced_mass);
    lanes3 s = add_scaled3(*spring, elapsed, sliding);
    s = add_scaled3(s, -dot3(s, normal), normal);
    const lanes3 full = add_scaled3(scale3(damping, sliding), contact.stiffness, s);
    const lanes size = sqrt(dot3(full, full));
    const mask slipping = AS_MASK(size > contact.limit);
    const lanes cut = WHERE(slipping, contact.limit / size, R(1));
    const lanes3 force = scale3(cut, full);
    const lanes compliance = WHERE(contact.touching, R(1) / contact.stiffness, R(0));
    const lanes3 slipped = scale3(compliance, add_scaled3(force, -damping * cut, sliding));
    *spring = where3(contact.touching, where3(slipping, slipped, s), ZERO3);
    return force;
}

/* Saturated, with history, or as much of each as `mindlin_share` says. */
INLINE lanes3 friction(global const Replica* restrict replica, const int effects, FrictionTerms contact,
                       lanes3 sliding, lanes3 normal, real elapsed, lanes3* restrict spring) {
    lanes3 with_history = ZERO3;
    if (replica->mindlin) with_history = mindlin_friction(contact, sliding, normal, elapsed, spring);
    if (replica->mindlin && !(effects & EFFECT_FRICTION_HISTORY)) return with_history;
    const lanes3 saturated = saturated_friction(replica, contact, sliding);
    if (!replica->mindlin) return saturated;
    return add_scaled3(saturated, replica->mindlin_share, subtract3(with_history, saturated));
}
