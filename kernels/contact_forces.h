/* The force of each contact of a grain from its corrected overlap: Hertz, damping with constant
   restitution, friction, and the effects that the replica has beyond them. */

typedef struct {
    mask touching;
    lanes approach;   /* delta, corrected by both bulges; negative where there is a gap [m] */
    lanes overlap;    /* delta where touching, else zero [m] */
    lanes radius;     /* a = sqrt(R* delta), of the contact [m] */
    lanes elastic;    /* Hertz force, as stiffened: what displaces surfaces [N] */
    lanes bulge;      /* of this grain's surface there, all contacts together [m] */
    lanes arm;        /* from the centre to the contact point, or to the probed surface point [m] */
    lanes3 force;     /* on this grain [N] */
    lanes3 tangential;/* its friction part [N] */
    lanes3 couple;    /* rolling resistance on this grain, set where there is any [N m] */
    lanes energy;     /* stored beyond Hertz's 2/5 F delta by effects, set where there are any [J] */
} Contacts;

INLINE real sphere_mass(global const Replica* restrict replica, real radius) {
    return replica->density * (R(4) / R(3)) * PI * radius * radius * radius;
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

/* A grain's own side of its contacts. */
typedef struct { real radius, softness; real3 spin; } OwnSide;

/* What the elastic part of a contact leaves for the rest. */
typedef struct {
    Reduced pair;
    lanes stiffness;    /* 2 E* a [N/m] */
    lanes held;         /* elastic force less what has relaxed [N] */
    lanes bulge_there;  /* of the other surface [m] */
} Pressed;

/* Overlap and elastic force. `effects` are the replica's, or a plain 0 that leaves them out when this is compiled. */
INLINE Pressed press(global const Replica* restrict replica, const int effects, OwnSide own, Neighbours seen, lanes bulge,
                     lanes bulge_there, Memory* restrict memory, Contacts* restrict c) {
    Pressed p;
    const lanes gap = seen.distance - (own.radius + seen.radius);
    p.pair = reduced(replica, own.radius, seen.radius, seen.wall);
    lanes modulus = WHERE(seen.wall, replica->modulus_wall, replica->modulus_grain);
    if (effects & EFFECT_MODULUS_SCATTER)
        modulus = scattered_modulus(modulus, replica->grain_compliance, own.softness + seen.softness);
    lanes bulges = bulge + bulge_there;
    if (effects & EFFECT_BULGE_CONTACTS) bulges = counted_bulges(gap, bulges, replica->bulge_contacts);
    c->approach = bulges - gap;
    if (effects & EFFECT_PLASTICITY)
        c->approach = plastic_approach(c->approach, replica->plasticity, seen.occupied, &memory->deepest);
    c->touching = AS_MASK(c->approach > R(0)) & seen.occupied;
    c->overlap = WHERE(c->touching, c->approach, R(0));
    SelfCompliance self = {R(0), R(0)};
    if (replica->finite_contacts) {
        const Softer softer = {effects ? R(1) + own.softness : R(1), effects ? R(1) + seen.softness : (lanes)(R(1))};
        const SelfConsistent solved =
            self_consistent(replica, softer, c->overlap, p.pair.radius, modulus, own.radius, seen.radius, seen.wall);
        c->overlap = solved.overlap;
        self = solved.compliance;
        c->approach = WHERE(c->touching, c->overlap, c->approach);
    }

    /* Hertz: F = 4/3 E* a delta, stiffness S = 2 E* a. Without overlap every force is zero by itself. */
    c->radius = sqrt(p.pair.radius * c->overlap);
    p.stiffness = R(2) * modulus * c->radius;
    c->elastic = (R(2) / R(3)) * p.stiffness * c->overlap;
    c->bulge = bulge + self.here * c->elastic;
    p.bulge_there = bulge_there + self.there * c->elastic;
    if (effects & EFFECT_STIFFENING) c->elastic = stiffened(replica, c->elastic, c->overlap, p.pair.radius);
    p.held = c->elastic;
    if (effects & EFFECT_VISCOELASTICITY)
        p.held = relaxing_force(c->elastic, replica->viscoelasticity, replica->relaxing_share, &memory->relaxed);
    return p;
}

/* Stiffness of a tangential spring, 8 G* a. */
INLINE lanes shear_stiffness(global const Replica* restrict replica, const int effects, mask wall, lanes contact_radius,
                             lanes softness) {
    lanes modulus = WHERE(wall, replica->shear_wall, replica->shear_grain);
    if (effects & EFFECT_MODULUS_SCATTER) modulus = scattered_modulus(modulus, replica->shear_compliance, softness);
    return R(8) * modulus * contact_radius;
}

INLINE Contacts contact_forces(global const Replica* restrict replica, const int effects, OwnSide own, Neighbours seen,
                               lanes bulge, lanes bulge_there, real elapsed, Memory* restrict memory) {
    Contacts c;
    const Pressed pressed = press(replica, effects, own, seen, bulge, bulge_there, memory, &c);
    const Reduced pair = pressed.pair;
    const lanes damping = WHERE(seen.wall, replica->damping_wall, replica->damping_grain);
    const lanes separating = dot3(seen.velocity, seen.normal);
    const lanes push = pressed.held - damping * sqrt(pressed.stiffness * pair.mass) * separating;

    /* The contact point lies midway between the two displaced surfaces [paper]. */
    const lanes midway = R(0.5) * (seen.distance + (own.radius + c.bulge) - (seen.radius + pressed.bulge_there));
    const lanes at_wall = seen.distance;
    c.arm = WHERE(c.touching, WHERE(seen.wall, at_wall, midway), own.radius + c.bulge);
    const lanes arm_there = seen.distance - c.arm;
    const lanes3 turn = {c.arm * own.spin.x + arm_there * seen.spin.x, c.arm * own.spin.y + arm_there * seen.spin.y,
                         c.arm * own.spin.z + arm_there * seen.spin.z};
    const lanes3 n = seen.normal;
    const lanes3 sliding = {seen.velocity.x - separating * n.x - (turn.y * n.z - turn.z * n.y),
                            seen.velocity.y - separating * n.y - (turn.z * n.x - turn.x * n.z),
                            seen.velocity.z - separating * n.z - (turn.x * n.y - turn.y * n.x)};
    const lanes limit = WHERE(seen.wall, replica->friction_wall, replica->friction_grain) * fmax(push, (lanes)(R(0)));
    lanes shear = R(0);
    if (replica->mindlin) shear = shear_stiffness(replica, effects, seen.wall, c.radius, own.softness + seen.softness);
    c.tangential = friction(replica, effects, limit, sliding, n, shear, damping, pair.mass, elapsed, c.touching, &memory->spring);
    if (effects & EFFECT_ROLLING_RESISTANCE)
        c.couple = rolling_couple(replica, push, own.radius, seen.radius, seen.wall, pair.radius, own.spin, seen.spin);
    lanes normal = push;
    if (effects) c.energy = effect_energy(replica, c.elastic, pressed.held, c.overlap, pair.radius);
    if (effects & EFFECT_ADHESION) {
        const Attraction pull = attraction(replica, c.approach, pair.radius, pair.mass, seen.occupied);
        normal -= pull.force;
        c.energy += attraction_energy(pull, c.overlap, c.approach);
    }
    c.force = (lanes3){c.tangential.x - normal * n.x, c.tangential.y - normal * n.y, c.tangential.z - normal * n.z};
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

INLINE void add_couples(Contacts c, lanes3* restrict torque) {
    torque->x += c.couple.x; torque->y += c.couple.y; torque->z += c.couple.z;
}
