/* Friction of a contact against sliding: two laws, or a share of each. */

/* Always saturated [paper]: mu F_n against the sliding. Below `sliding_velocity`, and where a step's
   friction could do more than stop the sliding, it fades to a viscous force so that it cannot chatter. */
INLINE lanes3 saturated_friction(lanes limit, lanes3 sliding, real sliding_velocity, lanes most_viscosity) {
    const lanes slowness = inverse_root(dot3(sliding, sliding) + sliding_velocity * sliding_velocity);
    const lanes viscosity = fmin(limit * slowness, most_viscosity);
    return (lanes3){viscosity * sliding.x, viscosity * sliding.y, viscosity * sliding.z};
}

/* Mindlin spring of stiffness k = 8 G* a with damping, cut at the Coulomb limit; a slipping spring keeps
   the stretch that carries the limit. Updates `spring`. */
INLINE lanes3 mindlin_friction(lanes limit, lanes3 sliding, lanes3 normal, lanes stiffness, lanes damping,
                               real time_step, mask touching, lanes3* restrict spring) {
    lanes3 s = {spring->x + sliding.x * time_step, spring->y + sliding.y * time_step,
                spring->z + sliding.z * time_step};
    const lanes along = dot3(s, normal);
    s.x -= along * normal.x; s.y -= along * normal.y; s.z -= along * normal.z;
    lanes3 force = {stiffness * s.x + damping * sliding.x, stiffness * s.y + damping * sliding.y,
                    stiffness * s.z + damping * sliding.z};
    const lanes size = sqrt(dot3(force, force));
    const mask slipping = AS_MASK(size > limit);
    const lanes cut = WHERE(slipping, limit / size, R(1));
    force.x *= cut; force.y *= cut; force.z *= cut;
    const lanes compliance = WHERE(touching, R(1) / stiffness, R(0));
    s.x = WHERE(slipping, (force.x - damping * cut * sliding.x) * compliance, s.x);
    s.y = WHERE(slipping, (force.y - damping * cut * sliding.y) * compliance, s.y);
    s.z = WHERE(slipping, (force.z - damping * cut * sliding.z) * compliance, s.z);
    spring->x = WHERE(touching, s.x, R(0));
    spring->y = WHERE(touching, s.y, R(0));
    spring->z = WHERE(touching, s.z, R(0));
    return force;
}

/* a, and of b as much as `share` says. */
INLINE lanes3 blended(lanes3 a, lanes3 b, real share) {
    return (lanes3){a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

/* `shear` is the spring's stiffness 8 G* a. */
INLINE lanes3 friction(global const Replica* restrict replica, const int effects, lanes limit, lanes3 sliding, lanes3 normal,
                       lanes shear, lanes damping, lanes reduced_mass, real time_step, mask touching,
                       lanes3* restrict spring) {
    lanes3 with_history = {R(0), R(0), R(0)};
    if (replica->mindlin)
        with_history = mindlin_friction(limit, sliding, normal, shear, damping * sqrt(shear * reduced_mass), time_step, touching,
                                        spring);
    if (replica->mindlin && !(effects & EFFECT_FRICTION_HISTORY)) return with_history;
    const lanes3 saturated = saturated_friction(limit, sliding, replica->sliding_velocity,
                                                reduced_mass * (R(0.1) / replica->time_step));
    return replica->mindlin ? blended(saturated, with_history, replica->mindlin_share) : saturated;
}
