/* What holds the grains at the sides: walls of a box, the curved wall of a cylinder, or nothing in a periodic
   cell. Positions in a periodic cell are not wrapped: a difference is taken to the nearest image. */

#define MAX_DRIFT R(8) /* cells, of a grain in a periodic one: positions must stay precise */

/* Added and taken away again it rounds to the nearest whole number; rint() costs twice the time. */
#if MCDEM_DOUBLE
#define ROUNDING R(6755399441055744.0) /* 1.5 2^52 */
#else
#define ROUNDING R(12582912) /* 1.5 2^23 */
#endif

#define WHOLE_NUMBER(x) (((x) + ROUNDING) - ROUNDING)

/* Both sides of a pair get the same bits, signs apart. */
INLINE lanes nearest_image(lanes apart, real size) {
    const real inverse = R(1) / size;
    return apart - size * WHOLE_NUMBER(apart * inverse);
}

/* The image in the cell itself, or next to it by rounding. */
INLINE real into_cell(real coordinate, real size) { return coordinate - size * floor(coordinate / size); }

INLINE real cylinder_radius(global const Replica* restrict replica) {
    return R(0.5) * replica->wall_position[1];
}

/* The horizontal vector from a cylinder's axis [m]. */
INLINE real2 from_axis(global const Replica* restrict replica, real4 point) {
    return point.xy - cylinder_radius(replica);
}

/* The foot of the perpendicular on a cylinder's wall. */
INLINE real3 side_foot(global const Replica* restrict replica, real4 point) {
    const real2 out = from_axis(replica, point);
    const real distance = sqrt(out.x * out.x + out.y * out.y);
    const real gap = cylinder_radius(replica) - distance;
    const real2 way = distance > R(0) ? out * (gap / distance) : (real2)(gap, R(0));
    return (real3)(point.x + way.x, point.y + way.y, point.z);
}

/* From a wall to a point inside; far where there is no such wall. The plate is another matter (plate.h). */
INLINE real side_distance(global const Replica* restrict replica, int wall, real4 point) {
    if (replica->container == CONTAINER_PERIODIC) return INFINITY;
    if (replica->container == CONTAINER_CYLINDER) {
        const real2 out = from_axis(replica, point);
        return wall == 0 ? cylinder_radius(replica) - sqrt(out.x * out.x + out.y * out.y) : R(INFINITY);
    }
    const real coordinate = wall < 2 ? point.x : point.y, place = replica->wall_position[wall];
    return wall % 2 ? place - coordinate : coordinate - place;
}

INLINE bool within_sides(global const Replica* restrict replica, real4 point) {
    if (replica->container == CONTAINER_PERIODIC) {
        const real x = point.x / replica->wall_position[1], y = point.y / replica->wall_position[3];
        return fmax(fabs(x), fabs(y)) < MAX_DRIFT;
    }
    if (replica->container == CONTAINER_CYLINDER) return side_distance(replica, 0, point) > R(0);
    return point.x > replica->wall_position[0] && point.x < replica->wall_position[1] &&
           point.y > replica->wall_position[2] && point.y < replica->wall_position[3];
}

/* R* of a sphere inside a cylinder, 1/R* = sqrt(1/R (1/R - 1/R_c)): the geometric mean of both directions
   (Johnson 1985, section 4.2). Forces by it are within 0.2 % of Hertz's elliptical contact up to R = R_c/4
   and within 1 % up to R_c/2. */
INLINE real curved_radius(global const Replica* restrict replica, real radius) {
    return radius / sqrt(R(1) - radius / cylinder_radius(replica));
}
