/* Lateral boundaries: walls of a box, the curved wall of a cylinder, or periodic sides. Positions in periodic
   directions are not wrapped; differences use the nearest image.

   CONTAINER_CELL is periodic along z as well, and deformed. Stored positions X are in the undeformed cell,
   and stored velocities v are relative to the cell's own motion: a grain is at F X, its velocity is F' X + v.
   The cell thus moves its grains without rounding errors, and images need no velocities of their own.
   F is upper triangular and linear in time during an interval. */

#define MAX_DRIFT R(8) /* largest coordinate in periods; larger ones lose precision */

/* Adding and then subtracting this number rounds to the nearest integer; rint() takes twice as long. */
#if MCDEM_DOUBLE
#define ROUNDING R(6755399441055744.0) /* 1.5 2^52 */
#else
#define ROUNDING R(12582912) /* 1.5 2^23 */
#endif

#define WHOLE_NUMBER(x) (((x) + ROUNDING) - ROUNDING)

/* Both sides of a pair get the same bits, with opposite signs. */
INLINE lanes nearest_image(lanes apart, real size) {
    const real inverse = R(1) / size;
    return apart - size * WHOLE_NUMBER(apart * inverse);
}

/* The nearest image between periodic sides. */
INLINE lanes3 nearest_between_sides(global const Replica* restrict replica, lanes3 apart) {
    return (lanes3){nearest_image(apart.x, replica->wall_position[1]),
                    nearest_image(apart.y, replica->wall_position[3]), apart.z};
}

/* The image in [0, size], up to rounding. */
INLINE real into_cell(real coordinate, real size) { return coordinate - size * floor(coordinate / size); }

/* F, or its rate. */
typedef struct {
    real xx, yy, zz, xy, xz, yz;
} Deformation;

INLINE Deformation deformation_rate(global const Replica* restrict replica) {
    global const real* rate = replica->deformation_rate;
    return (Deformation){rate[0], rate[1], rate[2], rate[3], rate[4], rate[5]};
}

/* F at the time `elapsed` in the interval [s]. */
INLINE Deformation deformation(global const Replica* restrict replica, real elapsed) {
    global const real* f = replica->deformation;
    const Deformation rate = deformation_rate(replica);
    return (Deformation){f[0] + elapsed * rate.xx, f[1] + elapsed * rate.yy, f[2] + elapsed * rate.zz,
                         f[3] + elapsed * rate.xy, f[4] + elapsed * rate.xz, f[5] + elapsed * rate.yz};
}

INLINE real3 deformed(Deformation f, real3 a) {
    return (real3)(f.xx * a.x + f.xy * a.y + f.xz * a.z, f.yy * a.y + f.yz * a.z, f.zz * a.z);
}

/* F^-1 a. */
INLINE lanes3 undeformed(Deformation f, lanes3 a) {
    const real3 inverse = R(1) / (real3)(f.xx, f.yy, f.zz); /* one vector division */
    const lanes z = a.z * inverse.z, y = (a.y - f.yz * z) * inverse.y;
    return (lanes3){(a.x - f.xy * y - f.xz * z) * inverse.x, y, z};
}

/* Difference of two stored positions, to the nearest image in the deformed cell. Axes are treated one by one,
   z first. The result is correct for distances below half of the cell's lengths, at any shear. */
#define NEAREST_IN_CELL(name, vector, scalar)                                                              \
    INLINE vector name(global const Replica* restrict replica, Deformation f, vector apart) {              \
        const real3 size =                                                                                 \
            (real3)(replica->wall_position[1], replica->wall_position[3], replica->wall_position[5]);      \
        const real3 inverse = R(1) / size, tilt = (real3)(f.yz, f.xy, f.xz) / (real3)(f.yy, f.xx, f.xx);   \
        const scalar z = apart.z - size.z * WHOLE_NUMBER(apart.z * inverse.z);                             \
        const scalar y = apart.y - size.y * WHOLE_NUMBER((apart.y + tilt.x * z) * inverse.y);              \
        const scalar x = apart.x - size.x * WHOLE_NUMBER((apart.x + tilt.y * y + tilt.z * z) * inverse.x); \
        return (vector){x, y, z};                                                                          \
    }
NEAREST_IN_CELL(nearest_in_cell, real3, real)
NEAREST_IN_CELL(nearest_lanes_in_cell, lanes3, lanes)

INLINE lanes3 deformed_lanes(Deformation f, lanes3 a) {
    return (lanes3){f.xx * a.x + f.xy * a.y + f.xz * a.z, f.yy * a.y + f.yz * a.z, f.zz * a.z};
}

INLINE lanes3 deformed_way(global const Replica* restrict replica, real elapsed, lanes3 way) {
    return replica->container == CONTAINER_CELL ? deformed_lanes(deformation(replica, elapsed), way) : way;
}

INLINE real cylinder_radius(global const Replica* restrict replica) {
    return R(0.5) * replica->wall_position[1];
}

/* Foot of the perpendicular on a cylinder's wall. */
INLINE lanes3 side_foot(global const Replica* restrict replica, lanes3 point) {
    const real radius = cylinder_radius(replica);
    const lanes x = point.x - radius, y = point.y - radius, distance = sqrt(x * x + y * y);
    const lanes gap = radius - distance;
    const mask off_axis = AS_MASK(distance > R(0));
    const lanes part = gap / WHERE(off_axis, distance, R(1));
    return (lanes3){point.x + WHERE(off_axis, x * part, gap), point.y + WHERE(off_axis, y * part, R(0)),
                    point.z};
}

/* Distance of points from side wall 0 to 3; infinite if the container has no such wall. */
INLINE lanes side_distance(global const Replica* restrict replica, int wall, lanes3 point) {
    if (replica->container >= CONTAINER_PERIODIC) return R(INFINITY);
    if (replica->container == CONTAINER_CYLINDER) {
        const lanes x = point.x - cylinder_radius(replica), y = point.y - cylinder_radius(replica);
        if (wall != 0) return R(INFINITY);
        return cylinder_radius(replica) - sqrt(x * x + y * y);
    }
    const lanes coordinate = wall < 2 ? point.x : point.y;
    const real place = replica->wall_position[wall];
    return wall % 2 ? place - coordinate : coordinate - place;
}

INLINE mask within_sides(global const Replica* restrict replica, lanes3 point) {
    global const real* wall = replica->wall_position;
    if (replica->container >= CONTAINER_PERIODIC)
        return AS_MASK(fmax(fabs(point.x / wall[1]), fabs(point.y / wall[3])) < MAX_DRIFT);
    if (replica->container == CONTAINER_CYLINDER) {
        const real radius = cylinder_radius(replica);
        const lanes x = point.x - radius, y = point.y - radius;
        return AS_MASK(sqrt(x * x + y * y) < radius);
    }
    return AS_MASK(point.x > wall[0]) & AS_MASK(point.x < wall[1]) & AS_MASK(point.y > wall[2]) &
           AS_MASK(point.y < wall[3]);
}

/* R* of a sphere inside a cylinder, 1/R* = sqrt(1/R (1/R - 1/R_c)): the geometric mean of the two principal
   relative curvatures (Johnson 1985, section 4.2). Forces agree with Hertz's elliptical contact within 0.2 %
   up to R = R_c/4 and within 1 % up to R_c/2. */
INLINE lanes curved_radius(global const Replica* restrict replica, lanes radius) {
    return radius / sqrt(R(1) - radius / cylinder_radius(replica));
}
