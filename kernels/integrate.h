/* Time integration: velocity Verlet in leapfrog form, with velocities half a step before the positions.
   Forces are the contact forces, weight minus buoyancy, and drag; grains have the moment of inertia of a
   homogeneous sphere. In a deformed cell the equations of motion are SLLOD (Evans & Morriss 1984),
   X' = F^-1 v, m v' = force - m F' F^-1 v. */

/* F' F^-1 v of a grain in a cell [m/s2]. */
INLINE lanes3 flow_of_motion(Grain at) {
    const Deformation f = deformation(at.replica, at.elapsed);
    return deformed_lanes(deformation_rate(at.replica), undeformed(f, at.now.velocity));
}

INLINE Moving integrate(Grain at, lanes3 force, lanes3 torque) {
    global const Replica* restrict replica = at.replica;
    const Moving now = at.now;
    const real dt = replica->time_step;
    const lanes radius = now.radius, mass = sphere_mass(at, radius), inverse_mass = R(1) / mass;
    const lanes inverse_inertia = R(1) / (R(0.4) * mass * radius * radius);
    lanes3 acceleration = add_scaled3(scale3(inverse_mass, force), -replica->drag, now.velocity);
    acceleration.z -= OWN(at, weight_density) / OWN(at, density);
    const lanes3 turning = add_scaled3(scale3(inverse_inertia, torque), -replica->spin_drag, now.spin);
    Moving after = now;
    after.spin = add_scaled3(now.spin, dt, turning);
    if (replica->container == CONTAINER_CELL) {
        const Deformation f = deformation(replica, at.elapsed);
        after.velocity = add_scaled3(now.velocity, dt, subtract3(acceleration, flow_of_motion(at)));
        after.position = add_scaled3(now.position, dt, undeformed(f, after.velocity));
        return after;
    }
    after.velocity = add_scaled3(now.velocity, dt, acceleration);
    after.position = add_scaled3(now.position, dt, after.velocity);
    return after;
}

/* A rotation followed by a rotation by the small vector `by`, given in laboratory axes. */
INLINE lanes4 rotated(lanes4 rotation, lanes3 by) {
    const lanes3 half_angle = scale3(R(0.5), by), v = {rotation.x, rotation.y, rotation.z};
    const lanes3 q = add3(add_scaled3(v, rotation.w, half_angle), cross3(half_angle, v));
    const lanes w = rotation.w - dot3(half_angle, v);
    const lanes to_one = R(1.5) - R(0.5) * (dot3(q, q) + w * w); /* normalises: one Newton step */
    return (lanes4){q.x * to_one, q.y * to_one, q.z * to_one, w * to_one};
}

INLINE slots motion_status(Grain at, Moving after) {
    global const Replica* restrict replica = at.replica;
    const lanes3 x = after.position, w = after.spin;
    const mask finite = AS_MASK(fabs(x.x + x.y + x.z + w.x + w.y + w.z) < INFINITY);
    const mask between =
        replica->container == CONTAINER_CELL
            ? AS_MASK(fabs(x.z / replica->wall_position[5]) < MAX_DRIFT)
            : AS_MASK(x.z > replica->wall_position[4]) & AS_MASK(x.z < plate_heights(replica, at.plate_z, x));
    const mask inside = within_sides(replica, x) & between;
    return AS_SLOTS(WHERE(finite, WHERE(inside, R(0), R(STATUS_LOST)), R(STATUS_NOT_A_NUMBER)));
}
