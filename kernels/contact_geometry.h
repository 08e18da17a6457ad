/* Where a grain meets each of its neighbours: direction, distance and gap, for grains and walls alike. */

/* A row's entry: a grain's index, EMPTY, or a wall. */
#define EMPTY (-1)
#define WALL_PARTNER(w) (-2 - (w))

/* What the slots of one grain see of the other side. A wall is a neighbour of radius zero at the foot of
   the perpendicular. */
typedef struct {
    mask occupied;
    mask wall;
    lanes3 normal;    /* e, from this grain's centre to the neighbour */
    lanes distance;   /* to the neighbour's centre, or to the wall [m] */
    lanes radius;     /* the neighbour's, zero for a wall [m] */
    lanes3 velocity;  /* the neighbour's less this grain's [m/s] */
    lanes3 spin;      /* the neighbour's angular velocity [1/s] */
    lanes softness;   /* E/E_j - 1 of the neighbour, zero for a wall */
} Neighbours;

/* Replaces the wall entries of a gathered row. Walls do not turn; the plate alone moves, along z. */
INLINE void insert_walls(global const Replica* restrict replica, const int effects, real plate_z, real4 own, slots partner,
                                lanes4* restrict position, lanes4* restrict velocity, lanes4* restrict spin) {
    const mask wall = AS_MASK(partner < EMPTY);
    lanes3 foot = {WHERE(wall, own.x, position->x), WHERE(wall, own.y, position->y), WHERE(wall, own.z, position->z)};
    /* Written out: a loop over axes would go through memory. */
    foot.x = WHERE(AS_MASK(partner == WALL_PARTNER(0)), replica->wall_position[0], foot.x);
    foot.x = WHERE(AS_MASK(partner == WALL_PARTNER(1)), replica->wall_position[1], foot.x);
    foot.y = WHERE(AS_MASK(partner == WALL_PARTNER(2)), replica->wall_position[2], foot.y);
    foot.y = WHERE(AS_MASK(partner == WALL_PARTNER(3)), replica->wall_position[3], foot.y);
    foot.z = WHERE(AS_MASK(partner == WALL_PARTNER(4)), replica->wall_position[4], foot.z);
    foot.z = WHERE(AS_MASK(partner == WALL_PARTNER(5)), plate_z, foot.z);
    if (effects & EFFECT_PLATE_TILT) {
        const mask plate = AS_MASK(partner == WALL_PARTNER(5));
        const real3 leaning = plate_foot(replica, plate_z, own);
        foot.x = WHERE(plate, leaning.x, foot.x);
        foot.y = WHERE(plate, leaning.y, foot.y);
        foot.z = WHERE(plate, leaning.z, foot.z);
    }
    position->x = foot.x;
    position->y = foot.y;
    position->z = foot.z;
    position->w = WHERE(wall, R(0), position->w);
    velocity->w = WHERE(wall, R(0), velocity->w);
    velocity->x = WHERE(wall, R(0), velocity->x);
    velocity->y = WHERE(wall, R(0), velocity->y);
    velocity->z = WHERE(wall, WHERE(AS_MASK(partner == WALL_PARTNER(5)), replica->plate_velocity, R(0)), velocity->z);
    spin->x = WHERE(wall, R(0), spin->x);
    spin->y = WHERE(wall, R(0), spin->y);
    spin->z = WHERE(wall, R(0), spin->z);
}

INLINE Neighbours see_neighbours(global const Replica* restrict replica, const int effects, real plate_z, int grain, slots partner,
                                 global const real4* restrict position,
                                 global const real4* restrict velocity,
                                 global const real4* restrict angular_velocity) {
    const real4 own = position[grain];
    const real4 own_velocity = velocity[grain];
    const slots index = select((slots)(grain), partner, partner >= 0);
    lanes4 there = gather4(position, index);
    lanes4 moving = gather4(velocity, index);
    lanes4 turning = gather4(angular_velocity, index);
    const mask wall = AS_MASK(partner < EMPTY);
    if (ANY(wall)) insert_walls(replica, effects, plate_z, own, partner, &there, &moving, &turning);

    Neighbours seen;
    seen.occupied = AS_MASK(partner != EMPTY);
    seen.wall = wall;
    const lanes3 apart = {there.x - own.x, there.y - own.y, there.z - own.z};
    /* An empty slot is given a distance of one, so that nothing is divided by zero. */
    const lanes squared = WHERE(seen.occupied, dot3(apart, apart), R(1));
    seen.distance = sqrt(squared);
    const lanes inverse = inverse_root(squared);
    seen.normal = (lanes3){apart.x * inverse, apart.y * inverse, apart.z * inverse};
    seen.radius = there.w;
    seen.velocity = (lanes3){moving.x - own_velocity.x, moving.y - own_velocity.y, moving.z - own_velocity.z};
    seen.spin = (lanes3){turning.x, turning.y, turning.z};
    seen.softness = moving.w;
    return seen;
}
