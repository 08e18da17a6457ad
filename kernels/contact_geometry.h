/* Geometry of a grain and its neighbours: direction, distance, relative velocity. A wall is treated as a
   neighbour of radius zero at the foot of the perpendicular, so one formula covers grains and walls. */

/* The neighbour in one slot of each lane. */
typedef struct {
    mask occupied;
    mask wall;
    lanes3 normal;           /* e, from this grain's centre to the neighbour */
    lanes distance;          /* to the neighbour's centre, or to the wall [m] */
    lanes radius;            /* of the neighbour, zero for a wall [m] */
    lanes3 velocity;         /* of the neighbour relative to this grain [m/s] */
    lanes3 spin;             /* angular velocity of the neighbour [1/s] */
    lanes excess_compliance; /* E/E_j - 1 of the neighbour, zero for a wall */
    slots species;           /* of the neighbour, WALL_COLUMN for a wall; set only if SPECIES > 1 */
} Neighbours;

/* For walls among the partners the foot of the perpendicular; for grains `there`, unchanged. */
INLINE lanes3 wall_feet(Grain at, const int effects, slots partner, lanes3 there) {
    global const Replica* restrict replica = at.replica;
    lanes3 foot = where3(AS_MASK(partner < NO_PARTNER), at.now.position, there);
    if (replica->container == CONTAINER_CYLINDER) {
        const lanes3 side = side_foot(replica, at.now.position);
        foot = where3(AS_MASK(partner == WALL_PARTNER(0)), side, foot);
    } else {
        foot.x = WHERE(AS_MASK(partner == WALL_PARTNER(0)), replica->wall_position[0], foot.x);
    }
    /* No loop over axes: it would index vectors in memory. */
    foot.x = WHERE(AS_MASK(partner == WALL_PARTNER(1)), replica->wall_position[1], foot.x);
    foot.y = WHERE(AS_MASK(partner == WALL_PARTNER(2)), replica->wall_position[2], foot.y);
    foot.y = WHERE(AS_MASK(partner == WALL_PARTNER(3)), replica->wall_position[3], foot.y);
    foot.z = WHERE(AS_MASK(partner == WALL_PARTNER(4)), replica->wall_position[4], foot.z);
    foot.z = WHERE(AS_MASK(partner == WALL_PARTNER(5)), at.plate_z, foot.z);
    if (effects & EFFECT_PLATE_TILT) {
        const lanes3 on_plate = plate_foot(replica, at.plate_z, at.now.position);
        foot = where3(AS_MASK(partner == WALL_PARTNER(5)), on_plate, foot);
    }
    return foot;
}

/* How the pair of a contact has turned in the last step, for the springs in the contact. */
typedef struct {
    lanes3 middle; /* normal minus half its change: along the bisector of the normals before and after */
    lanes twist;   /* about the normal [rad] */
    lanes arc;     /* arc of the centres' relative motion over its tangential part */
} Turn;

/* The turn in the time `elapsed` that ends now.
   The normal turns with the relative velocity of the centres. With the tangent s of its angle,
   tan(angle/2) = s/2 (1 - s^2/4 + s^4/8 - ..). The arc is 1 + s^2/6 times the step's tangential part; the
   grains' own turns are arcs, too, so a pair that turns as one body does not slide.
   That of a plane wall does not turn. That of a cylinder's wall turns with the motion about the axis.
   The twist is that of the mean spin (omega_i + omega_j) / 2; a wall's spin is zero. A spring is the vector
   between two points that touched when it began, one on each body, and the end on a body turns with that
   body. How far each of them is from the line of centres is not stored, so each side counts half: exact if
   both turn alike or if equal spheres are sheared, and between the limits of a grain that has slid along a
   wall (its end is on its axis and does not turn) and one that has rolled (it does). */
INLINE Turn turn_of(Grain at, Neighbours neighbour, real elapsed) {
    const lanes separating = dot3(neighbour.velocity, neighbour.normal);
    lanes3 across = add_scaled3(neighbour.velocity, -separating, neighbour.normal);
    lanes distance = neighbour.distance - elapsed * separating;
    mask turns = NOT(neighbour.wall);
    if (at.replica->container == CONTAINER_CYLINDER) { /* only its curved wall is not horizontal */
        const mask curved = neighbour.wall & AS_MASK(fabs(neighbour.normal.z) < R(0.5));
        across.z = WHERE(curved, R(0), across.z);
        distance -= WHERE(curved, cylinder_radius(at.replica), R(0));
        turns |= curved & AS_MASK(fabs(distance) > R(0));
    }
    const lanes3 spins = add3(neighbour.spin, at.now.spin);
    const lanes half_slope = WHERE(turns, R(0.5) * elapsed / WHERE(turns, distance, R(1)), R(0));
    const lanes square = half_slope * half_slope * dot3(across, across); /* s^2/4 */
    const lanes bisecting = half_slope * (R(1) - square * (R(1) - R(2) * square));
    return (Turn){add_scaled3(neighbour.normal, -bisecting, across),
                  R(0.5) * elapsed * dot3(spins, neighbour.normal), R(1) + square * (R(2) / R(3))};
}

/* Length that overlaps are compared with: R^2/R* with the smaller radius R, so that their ratio is (a/R)^2
   with Hertz's contact radius a. It is the sum of the radii of equal grains, and R on a wall. The same bits
   from both sides. */
INLINE lanes smaller_radius(Grain at, Neighbours neighbour) {
    return WHERE(neighbour.wall, at.now.radius, fmin(at.now.radius, neighbour.radius));
}
INLINE lanes overlap_scale(Grain at, Neighbours neighbour) {
    const lanes larger = fmax(at.now.radius, neighbour.radius);
    return (at.now.radius + neighbour.radius) * (smaller_radius(at, neighbour) / larger);
}

/* Whether an overlap exceeds the replica's limit times overlap_scale(), or is NaN; without a division. */
INLINE mask is_too_deep(Grain at, Neighbours neighbour, lanes overlap) {
    const lanes larger = fmax(at.now.radius, neighbour.radius);
    const lanes scale = (at.now.radius + neighbour.radius) * smaller_radius(at, neighbour);
    return NOT(AS_MASK(overlap * larger <= at.replica->overlap_limit * scale));
}

INLINE Neighbours gather_neighbours(Grain at, const int effects, global const Motion* restrict motion,
                                    slots partner) {
    const mask wall = AS_MASK(partner < NO_PARTNER);
    const slots index = select(at.first + LANE_NUMBERS, partner, partner >= 0);
    const Moving other = load_motion(motion, index);
    lanes3 there = other.position, moving = other.velocity;
    Neighbours neighbour;
    neighbour.occupied = AS_MASK(partner != NO_PARTNER);
    neighbour.wall = wall;
    neighbour.radius = other.radius;
    neighbour.excess_compliance = other.excess_compliance;
    neighbour.spin = other.spin;
    if (ANY(wall)) { /* walls do not rotate; only the plate moves, along z */
        there = wall_feet(at, effects, partner, there);
        moving = where3(wall, ZERO3, moving);
        moving.z = WHERE(AS_MASK(partner == WALL_PARTNER(5)), at.replica->plate_velocity, moving.z);
        neighbour.spin = where3(wall, ZERO3, neighbour.spin);
        neighbour.radius = WHERE(wall, R(0), neighbour.radius);
        neighbour.excess_compliance = WHERE(wall, R(0), neighbour.excess_compliance);
    }
#if SPECIES > 1
    neighbour.species = AS_SLOTS(WHERE(wall, R(WALL_COLUMN), other.species));
#endif
    lanes3 apart = subtract3(there, at.now.position);
    if (at.replica->container == CONTAINER_PERIODIC) apart = nearest_between_sides(at.replica, apart);
    neighbour.velocity = subtract3(moving, at.now.velocity);
    if (at.replica->container == CONTAINER_CELL) {
        const Deformation f = deformation(at.replica, at.elapsed);
        const lanes3 listed = nearest_lanes_in_cell(at.replica, f, apart);
        apart = deformed_lanes(f, listed);
        neighbour.velocity = add3(neighbour.velocity, deformed_lanes(deformation_rate(at.replica), listed));
    }
    /* Distance 1 in empty slots avoids a division by zero. */
    const lanes squared = WHERE(neighbour.occupied, dot3(apart, apart), R(1));
    neighbour.distance = sqrt(squared);
    neighbour.normal = scale3(inverse_root(squared), apart);
    return neighbour;
}

/* Velocity of a neighbour relative to this grain by the motion of a cell [m/s]. */
INLINE lanes3 cell_velocity(Grain at, Neighbours neighbour) {
    const lanes3 apart = scale3(neighbour.distance, neighbour.normal);
    return deformed_lanes(deformation_rate(at.replica),
                          undeformed(deformation(at.replica, at.elapsed), apart));
}
