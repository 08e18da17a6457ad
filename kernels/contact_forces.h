/* The force of each contact of a grain from its corrected overlap: Hertz, damping with constant
   restitution, and friction. */

typedef struct {
    mask touching;
    lanes approach;   /* delta, corrected by both bulges; negative where there is a gap [m] */
    lanes overlap;    /* delta where touching, else zero [m] */
    lanes radius;     /* a = sqrt(R* delta), of the contact [m] */
    lanes elastic;    /* Hertz force [N] */
    lanes bulge;      /* of this grain's surface there, all contacts together [m] */
    lanes arm;        /* from the centre to the contact point, or to the probed surface point [m] */
    lanes3 force;     /* on this grain [N] */
    lanes3 tangential;/* its friction part [N] */
} Contacts;

/* Tangential springs of Mindlin friction, one a slot, as seen from this grain [m]. */
typedef struct { global real* restrict x; global real* restrict y; global real* restrict z; } Springs;

INLINE real sphere_mass(global const Replica* restrict replica, real radius) {
    return replica->density * (R(4) / R(3)) * PI * radius * radius * radius;
}

/* Always saturated [paper]: mu F_n against the sliding. Below `sliding_velocity`, and where a step's
   friction could do more than stop the sliding, it fades to a viscous force so that it cannot chatter. */
INLINE lanes3 saturated_friction(lanes limit, lanes3 sliding, real sliding_velocity, lanes most_viscosity) {
    const lanes speed = sqrt(dot3(sliding, sliding) + sliding_velocity * sliding_velocity);
    const lanes viscosity = fmin(limit / speed, most_viscosity);
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

/* R* and m* of each pair from one division; both sides of a pair get the same bits. */
typedef struct { lanes radius, mass; } Reduced;

INLINE Reduced reduced(global const Replica* restrict replica, real radius, lanes radius_there, mask wall) {
    const lanes sum = radius + radius_there, product = radius * radius_there;
    const lanes cubes = radius * radius * radius + radius_there * radius_there * radius_there;
    const lanes part = product / (sum * cubes);
    const real density = replica->density * (R(4) / R(3)) * PI;
    Reduced r;
    r.radius = WHERE(wall, radius, part * cubes);
    r.mass = WHERE(wall, density * radius * radius * radius, density * (part * sum) * product * product);
    return r;
}

INLINE Contacts contact_forces(global const Replica* restrict replica, real radius, real3 spin, Neighbours seen,
                               lanes bulge, lanes bulge_there, real elapsed, lanes3* restrict spring) {
    Contacts c;
    const lanes gap = seen.distance - (radius + seen.radius);
    const Reduced pair = reduced(replica, radius, seen.radius, seen.wall);
    const lanes modulus = WHERE(seen.wall, replica->modulus_wall, replica->modulus_grain);
    c.approach = (bulge + bulge_there) - gap;
    c.touching = AS_MASK(c.approach > R(0)) & seen.occupied;
    c.overlap = WHERE(c.touching, c.approach, R(0));
    SelfCompliance self = {R(0), R(0)};
    if (replica->finite_contacts) {
        const SelfConsistent solved =
            self_consistent(replica, c.overlap, pair.radius, modulus, radius, seen.radius, seen.wall);
        c.overlap = solved.overlap;
        self = solved.compliance;
        c.approach = WHERE(c.touching, c.overlap, c.approach);
    }

    /* Hertz: F = 4/3 E* a delta, stiffness S = 2 E* a. Without overlap every force below is zero by itself. */
    c.radius = sqrt(pair.radius * c.overlap);
    const lanes stiffness = R(2) * modulus * c.radius;
    c.elastic = (R(2) / R(3)) * stiffness * c.overlap;
    bulge += self.here * c.elastic;
    bulge_there += self.there * c.elastic;
    c.bulge = bulge;

    const lanes damping = WHERE(seen.wall, replica->damping_wall, replica->damping_grain);
    const lanes separating = dot3(seen.velocity, seen.normal);
    const lanes push = c.elastic - damping * sqrt(stiffness * pair.mass) * separating;

    /* The contact point lies midway between the two displaced surfaces [paper]. */
    const lanes midway = R(0.5) * (seen.distance + (radius + bulge) - (seen.radius + bulge_there));
    const lanes at_wall = seen.distance;
    c.arm = WHERE(c.touching, WHERE(seen.wall, at_wall, midway), radius + bulge);
    const lanes arm_there = seen.distance - c.arm;
    const lanes3 turn = {c.arm * spin.x + arm_there * seen.spin.x, c.arm * spin.y + arm_there * seen.spin.y,
                         c.arm * spin.z + arm_there * seen.spin.z};
    const lanes3 n = seen.normal;
    const lanes3 sliding = {seen.velocity.x - separating * n.x - (turn.y * n.z - turn.z * n.y),
                            seen.velocity.y - separating * n.y - (turn.z * n.x - turn.x * n.z),
                            seen.velocity.z - separating * n.z - (turn.x * n.y - turn.y * n.x)};
    const lanes limit = WHERE(seen.wall, replica->friction_wall, replica->friction_grain) * fmax(push, (lanes)(R(0)));
    if (replica->mindlin) {
        const lanes shear = R(8) * WHERE(seen.wall, replica->shear_wall, replica->shear_grain) * c.radius;
        c.tangential = mindlin_friction(limit, sliding, n, shear, damping * sqrt(shear * pair.mass), elapsed,
                                        c.touching, spring);
    } else {
        c.tangential = saturated_friction(limit, sliding, replica->sliding_velocity,
                                          pair.mass * (R(0.1) / replica->time_step));
    }
    c.force = (lanes3){c.tangential.x - push * n.x, c.tangential.y - push * n.y, c.tangential.z - push * n.z};
    return c;
}

/* Adds a row's forces and torques r_i x F_t, lane by lane. */
INLINE void add_contacts(Contacts c, lanes3 n, lanes3* restrict force, lanes3* restrict torque) {
    const lanes3 t = c.tangential;
    force->x += c.force.x; force->y += c.force.y; force->z += c.force.z;
    torque->x += c.arm * (n.y * t.z - n.z * t.y);
    torque->y += c.arm * (n.z * t.x - n.x * t.z);
    torque->z += c.arm * (n.x * t.y - n.y * t.x);
}
