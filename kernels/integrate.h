/* Velocity Verlet in its leapfrog form: velocities stand half a step before the positions that carry the
   forces. Weight less buoyancy, drag, inertia of a sphere. */

typedef struct { real4 position, velocity, angular_velocity; } Motion;

INLINE Motion integrate(global const Replica* restrict replica, real4 position, real4 velocity,
                               real4 angular_velocity, real3 force, real3 torque) {
    const real dt = replica->time_step;
    const real mass = sphere_mass(replica, position.w);
    real3 acceleration = force / mass - replica->drag * velocity.xyz;
    acceleration.z -= replica->weight_density / replica->density;
    const real3 turning = torque / (R(0.4) * mass * position.w * position.w) - replica->spin_drag * angular_velocity.xyz;
    const real3 v = velocity.xyz + acceleration * dt;
    const real3 w = angular_velocity.xyz + turning * dt;
    const Motion after = {(real4)(position.xyz + v * dt, position.w), (real4)(v, velocity.w), (real4)(w, R(0))};
    return after;
}

INLINE int motion_status(global const Replica* restrict replica, Motion after, real plate_z) {
    const real4 x = after.position, w = after.angular_velocity;
    if (!isfinite(x.x + x.y + x.z + w.x + w.y + w.z)) return STATUS_NOT_A_NUMBER;
    const bool inside = x.x > replica->wall_position[0] && x.x < replica->wall_position[1] &&
                        x.y > replica->wall_position[2] && x.y < replica->wall_position[3] &&
                        x.z > replica->wall_position[4] && x.z < plate_height(replica, plate_z, x);
    return inside ? 0 : STATUS_LOST;
}
