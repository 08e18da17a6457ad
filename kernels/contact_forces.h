/* Contact forces of a grain, from overlaps corrected by the surface displacements of both sides:
     Hertz      F = 4/3 E* a delta, a = sqrt(R* delta)
     damping    2 sqrt(5/6) beta sqrt(S_n m*) v_n, S_n = 2 E* a: the restitution does not depend on the speed
     friction   friction.h
     effects    contact_effects.h, if the replica has any. */

typedef struct {
    mask touching;
    lanes approach;       /* delta, corrected by both displacements; negative for a gap [m] */
    lanes overlap;        /* delta if touching, else zero [m] */
    lanes radius;         /* contact radius a = sqrt(R* delta) [m] */
    lanes elastic;        /* Hertz force with stiffening and exponent; it displaces surfaces [N] */
    lanes displacement;   /* b of this grain's surface, by all its contacts [m] */
    lanes arm;            /* from the centre to the contact point, or to the probed surface point [m] */
    lanes3 force;         /* on this grain [N] */
    lanes3 tangential;    /* friction part of the force [N] */
    lanes3 couple;        /* rolling resistance on this grain; set only with that effect [N m] */
    lanes energy;         /* stored by effects, in excess of 2/5 F delta; set only with effects [J] */
    lanes spring_energy;  /* of the springs of friction and rolling resistance [J] */
    lanes damped, rubbed; /* power of normal damping, and of tangential forces and couples [W] */
} Contacts;

/* Results of the elastic part that damping, friction and effects need. */
typedef struct {
    Reduced pair;
    lanes stiffness;          /* 2 E* a [N/m] */
    lanes relaxed_force;      /* elastic force after relaxation [N] */
    lanes displacement_there; /* of the other surface [m] */
} Pressed;

/* b of both surfaces at a slot of each lane [m]. */
typedef struct {
    lanes here, there;
} Displaced;

/* Overlap and elastic force. `effects` is the replica's value, or the constant 0, for which the compiler
   removes the effects. */
INLINE Pressed press(Grain at, const int effects, Neighbours neighbour, Displaced b, Memory* restrict memory,
                     Contacts* restrict c) {
    global const Replica* restrict replica = at.replica;
    const lanes radius = at.now.radius, excess_compliance = at.now.excess_compliance;
    Pressed p;
    const lanes gap = neighbour.distance - (radius + neighbour.radius);
    p.pair = reduced(at, neighbour);
    if (replica->container == CONTAINER_CYLINDER) { /* only its curved wall is not horizontal */
        const mask curved = neighbour.wall & AS_MASK(fabs(neighbour.normal.z) < R(0.5));
        p.pair.radius = WHERE(curved, curved_radius(replica, radius), p.pair.radius);
    }
    lanes modulus = OF_PAIRS(at, modulus, neighbour);
    if (effects & EFFECT_MODULUS_SCATTER)
        modulus = scattered_modulus(at, neighbour, modulus, OWN(at, grain_compliance),
                                    of_neighbours(at, neighbour, PLACE_OF(grain_compliance)));
    lanes outward = b.here + b.there;
    if (effects & EFFECT_BULGE_CONTACTS)
        outward = counted_displacements(gap, outward, replica->bulge_contacts);
    c->approach = outward - gap;
    if (effects & EFFECT_PLASTICITY)
        c->approach =
            plastic_approach(c->approach, replica->plasticity, neighbour.occupied, &memory->deepest);
    c->touching = AS_MASK(c->approach > R(0)) & neighbour.occupied;
    c->overlap = WHERE(c->touching, c->approach, R(0));
    SelfCompliance self = {R(0), R(0), R(0)};
    if (replica->finite_contacts) {
        const ComplianceRatio ratio = {effects ? R(1) + excess_compliance : (lanes)(R(1)),
                                       effects ? R(1) + neighbour.excess_compliance : (lanes)(R(1))};
        const SelfConsistent solved =
            self_consistent(at, neighbour, ratio, c->overlap, p.pair.radius, modulus);
        c->overlap = solved.overlap;
        self = solved.compliance;
        c->approach = WHERE(c->touching, c->overlap, c->approach);
    }

    /* Hertz: F = 4/3 E* a delta, stiffness S = 2 E* a. Both are zero without overlap. */
    c->radius = sqrt(p.pair.radius * c->overlap);
    p.stiffness = R(2) * modulus * c->radius;
    c->elastic = (R(2) / R(3)) * p.stiffness * c->overlap;
    c->displacement = b.here;
    p.displacement_there = b.there;
    /* A branch, so that without self displacement friction does not wait for the elastic force. */
    if (replica->finite_contacts) {
        c->displacement += self.here * c->elastic;
        p.displacement_there += self.there * c->elastic;
    }
    if (effects & EFFECT_LAW_EXPONENT)
        c->elastic = with_exponent(replica->law_exponent, c->elastic, c->overlap, p.pair.radius);
    if (effects & EFFECT_STIFFENING) c->elastic = stiffened(replica, c->elastic, c->overlap, p.pair.radius);
    p.relaxed_force = c->elastic;
    if (effects & EFFECT_VISCOELASTICITY)
        p.relaxed_force =
            relaxing_force(c->elastic, replica->viscoelasticity, replica->relaxing_share, &memory->relaxed);
    return p;
}

/* Stiffness of a tangential spring, 8 G* a. */
INLINE lanes shear_stiffness(Grain at, const int effects, Neighbours neighbour, lanes contact_radius) {
    lanes modulus = OF_PAIRS(at, shear, neighbour);
    if (effects & EFFECT_MODULUS_SCATTER)
        modulus = scattered_modulus(at, neighbour, modulus, OWN(at, shear_compliance),
                                    of_neighbours(at, neighbour, PLACE_OF(shear_compliance)));
    return R(8) * modulus * contact_radius;
}

/* Adds to `terms` what its springs need. Updates the contact radius in `memory`. */
INLINE void set_springs(Grain at, const int effects, Neighbours neighbour, lanes contact_radius, real elapsed,
                        Memory* restrict memory, SpringTerms* restrict terms) {
    terms->kept = kept_force(at.replica, contact_radius, &memory->radius);
    terms->stiffness = shear_stiffness(at, effects, neighbour, memory->radius);
    terms->turn = turn_of(at, neighbour, elapsed);
}

/* Tangential velocity of the other surface relative to this one at the contact point, which is `arm` and
   `arm_there` from the two centres; that of the centres times `arc` (Turn). Both sides get the same bits,
   with opposite signs. */
INLINE lanes3 sliding_velocity(Grain at, Neighbours neighbour, lanes arm, lanes arm_there, lanes arc) {
    const lanes separating = dot3(neighbour.velocity, neighbour.normal);
    const lanes3 here = at.now.spin, there = neighbour.spin;
    const lanes3 turn = {add_alike(arm * here.x, arm_there * there.x),
                         add_alike(arm * here.y, arm_there * there.y),
                         add_alike(arm * here.z, arm_there * there.z)};
    const lanes3 across = add_scaled3(neighbour.velocity, -separating, neighbour.normal);
    return subtract3(scale3(arc, across), cross3(turn, neighbour.normal));
}

INLINE Contacts contact_forces(Grain at, const int effects, Neighbours neighbour, Displaced b, real elapsed,
                               Memory* restrict memory) {
    global const Replica* restrict replica = at.replica;
    const lanes radius = at.now.radius;
    Contacts c;
    const Pressed pressed = press(at, effects, neighbour, b, memory, &c);
    const Reduced pair = pressed.pair;
    const lanes damping = OF_PAIRS(at, damping, neighbour);
    const lanes separating = dot3(neighbour.velocity, neighbour.normal);
    const lanes damping_force = damping * sqrt(pressed.stiffness * pair.mass) * separating;
    const lanes normal_force = pressed.relaxed_force - damping_force;
    c.damped = damping_force * separating;

    /* The contact point is midway between the two displaced surfaces (Brodu et al. 2015). */
    const lanes outer = radius + c.displacement, outer_there = neighbour.radius + pressed.displacement_there;
    const lanes midway = R(0.5) * (neighbour.distance + outer - outer_there);
    const lanes arm_there = R(0.5) * (neighbour.distance + outer_there - outer);
    c.arm = WHERE(c.touching, WHERE(neighbour.wall, neighbour.distance, midway), outer);

    lanes pressing = normal_force, limiting = fmax(normal_force, (lanes)(R(0)));
    if (effects) c.energy = effect_energy(replica, c.elastic, pressed.relaxed_force, c.overlap, pair.radius);
    if (effects & EFFECT_ATTRACTION) {
        const Attraction pull = attraction(replica, c.approach, c.overlap, pair, neighbour.occupied);
        pressing -= pull.force;
        limiting = WHERE(c.touching, fabs(limiting - replica->net_force_friction * pull.force), R(0));
        c.energy += attraction_energy(pull, c.overlap, c.approach);
    }

    SpringTerms terms = {
        .limit = OF_PAIRS(at, friction, neighbour) * limiting,
        .damping = damping,
        .reduced_mass = pair.mass,
        .turn = {.arc = R(1)},
        .touching = c.touching,
    };
    if (has_springs(replica, effects)) set_springs(at, effects, neighbour, c.radius, elapsed, memory, &terms);
    const lanes3 sliding = sliding_velocity(at, neighbour, c.arm, arm_there, terms.turn.arc);
    c.tangential =
        friction(replica, effects, terms, sliding, neighbour.normal, elapsed, &memory->spring, &c.rubbed);
    c.spring_energy = R(0);
    if (replica->mindlin)
        c.spring_energy = replica->mindlin_share * spring_energy(memory->spring, terms.stiffness);
    if (effects & EFFECT_ROLLING_RESISTANCE) {
        terms.limit = fmax(normal_force, (lanes)(R(0)));
        lanes rolled;
        c.couple = rolling_couple(at, neighbour, pair.radius, terms, elapsed, &memory->rolling, &rolled);
        c.rubbed += rolled;
        c.spring_energy += spring_energy(memory->rolling, terms.stiffness * pair.radius * pair.radius);
    }
    c.force = add_scaled3(c.tangential, -pressing, neighbour.normal);
    return c;
}

/* Adds the forces of contacts and their torques r_i x F_t. */
INLINE void add_contacts(Contacts c, lanes3 normal, lanes3* restrict force, lanes3* restrict torque) {
    *force = add3(*force, c.force);
    *torque = add_scaled3(*torque, c.arm, cross3(normal, c.tangential));
}
