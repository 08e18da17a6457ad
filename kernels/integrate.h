/* Velocity Verlet in its leapfrog form: velocities stand half a step before the positions that carry the
   forces. Weight less buoyancy, drag, inertia of a sphere. */
INLINE Motion integrate(Grain at, real3 force, real3 torque) {
    global const Replica* restrict replica = at.replica;
    const Motion now = at.now;
    const real dt = replica->time_step, radius = now.position.w;
    const real species = SPECIES > 1 ? now.angular_velocity.w : R(0);
    const real mass = sphere_mass(at, radius);
    real3 acceleration = force / mass - replica->drag * now.velocity.xyz;
    acceleration.z -= at.material->weight_density / at.material->density;
    const real3 turning =
        torque / (R(0.4) * mass * radius * radius) - replica->spin_drag * now.angular_velocity.xyz;
    if (replica->container == CONTAINER_CELL) {
        /* What is left of Newton's law beyond the cell's own motion (Evans & Morriss 1984, SLLOD). */
        const Deformation f = deformation(replica, at.elapsed);
        acceleration -= deformed(deformation_rate(replica), undeformed(f, now.velocity.xyz));
        const real3 own = now.velocity.xyz + acceleration * dt;
        const real3 spin = now.angular_velocity.xyz + turning * dt;
        const Motion after = {(real4)(now.position.xyz + undeformed(f, own) * dt, radius),
                              (real4)(own, now.velocity.w), (real4)(spin, species)};
        return after;
    }
    const real3 v = now.velocity.xyz + acceleration * dt;
    const real3 w = now.angular_velocity.xyz + turning * dt;
    const Motion after = {(real4)(now.position.xyz + v * dt, radius), (real4)(v, now.velocity.w),
                          (real4)(w, species)};
    return after;
}

/* A rotation, and then one more by a small angle, `by` along the laboratory's axes. */
INLINE real4 rotated(real4 rotation, real3 by) {
    const real3 half_angle = R(0.5) * by, v = rotation.xyz;
    const real4 q =
        (real4)(v + rotation.w * half_angle + cross(half_angle, v), rotation.w - dot(half_angle, v));
    return q * (R(1.5) - R(0.5) * dot(q, q)); /* of length one: a step of Newton's method */
}

INLINE int motion_status(Grain at, Motion after) {
    global const Replica* restrict replica = at.replica;
    const real4 x = after.position, w = after.angular_velocity;
    if (!isfinite(x.x + x.y + x.z + w.x + w.y + w.z)) return STATUS_NOT_A_NUMBER;
    const bool between = replica->container == CONTAINER_CELL
                             ? fabs(x.z / replica->wall_position[5]) < MAX_DRIFT
                             : x.z > replica->wall_position[4] && x.z < plate_height(replica, at.plate_z, x);
    return within_sides(replica, x) && between ? 0 : STATUS_LOST;
}
