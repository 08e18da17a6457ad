/* The plate: a plane that moves along z and may be tilted. Its lower face is at
   z = plate_z + tilt_x (x - Lx/2) + tilt_y (y - Ly/2). */

INLINE real plate_position(global const Replica* restrict replica, int steps) {
    return replica->wall_position[5] + replica->plate_velocity * (replica->time_step * steps);
}

/* z of the face at the x and y of points. */
INLINE lanes plate_heights(global const Replica* restrict replica, real plate_z, lanes3 point) {
    if (!(replica->effects & EFFECT_PLATE_TILT)) return plate_z;
    return plate_z + replica->plate_tilt_x * (point.x - R(0.5) * replica->wall_position[1]) +
           replica->plate_tilt_y * (point.y - R(0.5) * replica->wall_position[3]);
}

/* The foot of the perpendicular from a point to the face. */
INLINE lanes3 plate_foot(global const Replica* restrict replica, real plate_z, lanes3 point) {
    const real x = replica->plate_tilt_x, y = replica->plate_tilt_y;
    const lanes rise = (plate_heights(replica, plate_z, point) - point.z) / (R(1) + x * x + y * y);
    return (lanes3){point.x - x * rise, point.y - y * rise, point.z + rise};
}

/* Distance of points below the face from the face. */
INLINE lanes plate_distance(global const Replica* restrict replica, real plate_z, lanes3 point) {
    const lanes below = plate_heights(replica, plate_z, point) - point.z;
    if (!(replica->effects & EFFECT_PLATE_TILT)) return below;
    const real x = replica->plate_tilt_x, y = replica->plate_tilt_y;
    return below / sqrt(R(1) + x * x + y * y);
}
