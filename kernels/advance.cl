/* One time step of every grain: see the neighbours, contact forces, displace the surfaces, integrate. */

/* Where the contacts of this step push the surface at every slot, extrapolated to the next step:
     b(t + dt) = (10 b(t) - 5 b(t - 2 dt) + b(t - 4 dt)) / 6.
   Its phase error is 8/3 sin^5(omega dt), so that the delay neither pumps nor drains energy that matters, and
   it is stable wherever the plain delayed iteration is, for gains from -1 to 1 (ARCHITECTURE.md). `history` is a
   ring of the last four steps, each `slot_count` long; `turn` counts this replica's steps. */
INLINE void displace_surfaces(global const Replica* restrict replica, EXCHANGE const ContactTable* table, real radius,
                              real softer, size_t row, int turn, size_t slot_count, global real* restrict bulge_next,
                              global real* restrict history) {
    global real* two_before = history + ((turn + 2) & 3) * slot_count + row;
    global real* four_before = history + (turn & 3) * slot_count + row;
    for (int v = 0; v < VECTORS; ++v) {
        const lanes now = surface_displacement(replica, table, radius, softer, v);
        const lanes next = (R(10) / R(6)) * now - (R(5) / R(6)) * LOAD_LANES(two_before, v) +
                           (R(1) / R(6)) * LOAD_LANES(four_before, v);
        STORE_LANES(next, bulge_next + row, v);
        STORE_LANES(now, four_before, v);
    }
}

/* A replica that has made its steps keeps its state in both copies of every field. */
INLINE void keep_state(global const Replica* restrict replica, int grain, size_t row, real4 position, real4 velocity,
                       real4 spin, global const real* restrict bulge, global real4* restrict position_next,
                       global real4* restrict velocity_next, global real4* restrict spin_next,
                       global real* restrict bulge_next) {
    position_next[grain] = position;
    velocity_next[grain] = velocity;
    spin_next[grain] = spin;
    if (replica->surface == SURFACE_RIGID) return;
    for (int v = 0; v < VECTORS; ++v) STORE_LANES(LOAD_LANES(bulge + row, v), bulge_next + row, v);
}

/* What a row's contacts do to its grain, lane by lane. */
typedef struct {
    lanes3 force;
    lanes3 torque;
    mask too_deep, unprobed;
} Row;

/* The forces of a grain's row; tabulates them for the surfaces. `effects` are the replica's, or a plain 0. */
INLINE void row_forces(global const Replica* restrict replica, const int effects, bool waits, real plate_z, int grain, size_t row,
                       OwnSide own, global const real4* restrict position,
                       global const real4* restrict velocity, global const real4* restrict angular_velocity,
                       global const int* restrict partner, global const int* restrict mirror,
                       global const real* restrict bulge, global real* restrict spring_x, global real* restrict spring_y,
                       global real* restrict spring_z, global real* restrict deepest, global real* restrict relaxed,
                       EXCHANGE ContactTable* table, Row* restrict sums) {
    for (int v = 0; v < VECTORS; ++v) {
        const Neighbours seen = see_neighbours(replica, effects, plate_z, grain, LOAD_LANES(partner + row, v), position,
                                               velocity, angular_velocity);
        lanes here, there;
        load_bulges(replica, row, v, mirror, bulge, &here, &there);
        Memory memory = load_memory(replica, effects, row, v, spring_x, spring_y, spring_z, deepest, relaxed);
        const Contacts c = contact_forces(replica, effects, own, seen, here, there, replica->time_step, &memory);
        if (!waits) store_memory(replica, effects, row, v, memory, spring_x, spring_y, spring_z, deepest, relaxed);
        add_contacts(c, seen.normal, &sums->force, &sums->torque);
        if (effects & EFFECT_ROLLING_RESISTANCE) add_couples(c, &sums->torque);
        /* Asked this way round, a bulge that is not a number counts as too deep as well. */
        sums->too_deep |= ~AS_MASK(c.approach <= replica->overlap_limit * (own.radius + seen.radius)) & seen.occupied;
        sums->unprobed |= AS_MASK(here > replica->probe_gap) & ~c.touching & seen.occupied;
        tabulate(c, seen.normal, v, table);
    }
}

/* Slots in trouble, two kinds counted in one sum. */
#define DEEP_SLOTS 1024
INLINE int trouble_status(real counts) {
    const int count = (int)counts;
    return (count % DEEP_SLOTS ? STATUS_OVERLAP : 0) | (count / DEEP_SLOTS ? STATUS_UNPROBED : 0);
}

kernel void advance(const int s, const int slot_count, global const Replica* restrict replicas, global const int* restrict blocks,
                    global const int* restrict replica_of_block, global volatile int* restrict stop_at,
                    global const real4* restrict position, global const real4* restrict velocity,
                    global const real4* restrict angular_velocity, global real4* restrict position_next,
                    global real4* restrict velocity_next, global real4* restrict angular_velocity_next,
                    global const int* restrict partner, global const int* restrict mirror,
                    global const real* restrict bulge, global real* restrict bulge_next,
                    global real* restrict history, global real* restrict spring_x, global real* restrict spring_y, global real* restrict spring_z,
                    global real* restrict deepest, global real* restrict relaxed,
                    global const real4* restrict listed_position, global int* restrict status) {
    GRAIN_OF_WORK_ITEM
    global const Replica* restrict replica = replicas + replica_of_block[block];
    const real4 own = position[grain];
    const real4 own_velocity = velocity[grain];
    const real4 own_spin = angular_velocity[grain];
    const bool waits = s >= stop_at[replica_of_block[block]];
    if (waits) keep_state(replica, grain, row, own, own_velocity, own_spin, bulge, position_next, velocity_next,
                          angular_velocity_next, bulge_next);
    /* Where barriers follow, the work-items of a waiting replica go through them and write nothing. */
    if (waits && LANES == 16) return;

    fetch_next_bulges(replica, row, mirror, bulge);
    const real plate_z = plate_position(replica, s);
    const OwnSide side = {own.w, own_velocity.w, own_spin.xyz};
    Row sums = {{R(0), R(0), R(0)}, {R(0), R(0), R(0)}, 0, 0};
    /* Put in place twice: where there are no effects they cost nothing. */
    if (RARELY(replica->effects))
        row_forces(replica, replica->effects, waits, plate_z, grain, row, side, position, velocity, angular_velocity,
                   partner, mirror, bulge, spring_x, spring_y, spring_z, deepest, relaxed, table, &sums);
    else
        row_forces(replica, 0, waits, plate_z, grain, row, side, position, velocity, angular_velocity,
                   partner, mirror, bulge, spring_x, spring_y, spring_z, deepest, relaxed, table, &sums);
    SYNCHRONISE();
    if (replica->surface != SURFACE_RIGID && !waits)
        displace_surfaces(replica, table, own.w, R(1) + own_velocity.w, row, replica->steps_before + s, slot_count,
                          bulge_next, history);

    const lanes trouble = WHERE(sums.too_deep, R(1), R(0)) + WHERE(sums.unprobed, R(DEEP_SLOTS), R(0));
    const real4 total_force = sum_lanes(sums.force.x, sums.force.y, sums.force.z, trouble, scratch);
    const real4 total_torque = sum_lanes(sums.torque.x, sums.torque.y, sums.torque.z, (lanes)(R(0)), scratch);
    if (waits || !IS_LEADER || !(own.w > R(0))) return;

    const Motion after = integrate(replica, own, own_velocity, own_spin, total_force.xyz, total_torque.xyz);
    position_next[grain] = after.position;
    velocity_next[grain] = after.velocity;
    angular_velocity_next[grain] = after.angular_velocity;
    const int bits = trouble_status(total_force.w) | motion_status(replica, after, plate_z);
    const real3 moved = after.position.xyz - listed_position[grain].xyz;
    if (bits) status[grain] |= bits;
    if (bits || dot(moved, moved) > R(0.25) * replica->skin * replica->skin)
        atomic_min(stop_at + replica_of_block[block], s + 1);
}
