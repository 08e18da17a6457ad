/* One time step of every grain: see the neighbours, contact forces, displace the surfaces, integrate. */

/* What a row's contacts do to its grain, lane by lane. */
typedef struct {
    lanes3 force;
    lanes3 torque;
    mask too_deep, unprobed;
} RowSums;

/* See the neighbours, then the forces of their contacts; tabulates them for the surfaces. `effects` are the
   replica's, or a plain 0 that leaves them out when this is compiled. */
INLINE RowSums row_forces(Grain at, const int effects, Batch batch, EXCHANGE ContactTable* table) {
    global const Replica* restrict replica = at.replica;
    global real* memory_rows = memory_of(replica, batch.memory, at.row);
    RowSums sums = {ZERO3, ZERO3, 0, 0};
    for (int v = 0; v < VECTORS; ++v) {
        const Neighbours seen =
            see_neighbours(at, effects, batch.motion, LOAD_LANES(batch.partner + at.row, v));
        const Displaced b = load_displacements(at, batch, v);
        Memory memory = load_memory(replica, effects, memory_rows, v);
        const Contacts c = contact_forces(at, effects, seen, b, replica->time_step, &memory);
        store_memory(replica, effects, memory, memory_rows, v);
        add_contacts(c, seen.normal, &sums.force, &sums.torque);
        if (effects & EFFECT_ROLLING_RESISTANCE) sums.torque = add3(sums.torque, c.couple);
        /* Asked this way round, a displacement that is not a number counts as too deep as well. */
        sums.too_deep |= ~AS_MASK(c.approach <= replica->overlap_limit * (at.now.position.w + seen.radius)) &
                         seen.occupied;
        sums.unprobed |= AS_MASK(b.here > replica->probe_gap) & ~c.touching & seen.occupied;
        tabulate(c, seen.normal, v, table);
    }
    return sums;
}

/* Where the contacts of this step push the surface at every slot. */
INLINE void surface_displacements(Grain at, EXCHANGE ContactTable* table, lanes* restrict displacement) {
    SurfaceDisplacement b[VECTORS];
    for (int v = 0; v < VECTORS; ++v) {
        b[v] = surface_displacement(at, table, v);
        displacement[v] = b[v].point + b[v].size;
    }
    if (!at.replica->confinement) return;
    const Confined grain = confined(at, b, table);
    for (int v = 0; v < VECTORS; ++v) displacement[v] = confined_displacement(at, grain, b[v], v, table);
}

/* Where the contacts of this step push the surface at every slot, extrapolated to the next step:
     b(t + dt) = (10 b(t) - 5 b(t - 2 dt) + b(t - 4 dt)) / 6.
   Its phase error is 8/3 sin^5(omega dt), so that the delay neither pumps nor drains energy that matters, and
   it is stable wherever the plain delayed iteration is, for gains from -1 to 1 (ARCHITECTURE.md). `history`
   is a ring of the last four steps, each `slot_count` long; `step` counts this replica's steps. */
INLINE void displace_surfaces(Grain at, EXCHANGE ContactTable* table, int step, size_t slot_count,
                              global real* restrict displacement_next, global real* restrict history) {
    global real* two_before = history + ((step + 2) & 3) * slot_count + at.row;
    global real* four_before = history + (step & 3) * slot_count + at.row;
    lanes displacement[VECTORS];
    surface_displacements(at, table, displacement);
    for (int v = 0; v < VECTORS; ++v) {
        const lanes now = displacement[v];
        const lanes next = (R(10) / R(6)) * now - (R(5) / R(6)) * LOAD_LANES(two_before, v) +
                           (R(1) / R(6)) * LOAD_LANES(four_before, v);
        STORE_LANES(next, displacement_next + at.row, v);
        STORE_LANES(now, four_before, v);
    }
}

/* A replica that has made its steps keeps its state in both copies of every field, whichever is read at last.
 */
INLINE void keep_state(Grain at, Batch batch, global Motion* restrict motion_next,
                       global real* restrict displacement_next) {
    if (IS_LEADER) motion_next[at.index] = at.now;
    if (at.replica->surface == SURFACE_RIGID) return;
    for (int v = 0; v < VECTORS; ++v)
        STORE_LANES(LOAD_LANES(batch.displacement + at.row, v), displacement_next + at.row, v);
}

/* Slots in trouble, two kinds counted in one sum. */
#define DEEP_SLOTS 1024
INLINE int trouble_status(real counts) {
    const int count = (int)counts;
    return (count % DEEP_SLOTS ? STATUS_OVERLAP : 0) | (count / DEEP_SLOTS ? STATUS_UNPROBED : 0);
}

/* Stops the replica after this step where a grain is in trouble or has moved as far as the margin of its
   neighbour list allows. */
INLINE void expect_listed(Grain at, Motion after, int bits, real3 listed_position, int step,
                          global volatile int* stop_at) {
    const real3 moved = deformed_way(at.replica, at.elapsed, after.position.xyz - listed_position);
    if (bits || dot(moved, moved) > at.replica->max_move * at.replica->max_move)
        atomic_min(stop_at, step + 1);
}

WORK_GROUP(STEP_ITEMS)
kernel void advance(const int step, const int slot_count, global const Replica* restrict replicas,
                    global const Material* restrict materials, global const int* restrict blocks,
                    global const int* restrict replica_of_block, global volatile int* restrict stop_at,
                    global const Motion* restrict motion, global Motion* restrict motion_next,
                    global const int* restrict partner, global const int* restrict partner_slot,
                    global const real* restrict displacement, global real* restrict displacement_next,
                    global real* restrict history, global real* restrict memory, global Track* restrict track,
                    global int* restrict status) {
    GRAIN_OF_WORK_ITEM
    const int r = replica_of_block[block];
    global const Replica* restrict replica = replicas + r;
    const Batch batch = {motion, partner, partner_slot, displacement, memory};
    const Grain at = grain_at(replica, materials, r, index, step, motion[index]);
    /* One answer for a work-group, so that no barrier is missed: what lowers stop_at in this step sets step
     * + 1. */
    const int last = stop_at[r];
    if (step >= last) {
        if (step == last) keep_state(at, batch, motion_next, displacement_next);
        return;
    }

    prefetch_next_displacements(at, batch);
    /* Put in place twice: where there are no effects they cost nothing. */
    const RowSums sums = RARELY(replica->effects) ? row_forces(at, replica->effects, batch, table)
                                                  : row_forces(at, 0, batch, table);
    const lanes trouble = WHERE(sums.too_deep, R(1), R(0)) + WHERE(sums.unprobed, R(DEEP_SLOTS), R(0));
    share_sums(sums.force, sums.torque, trouble, scratch);
    SYNCHRONISE();
    if (replica->surface != SURFACE_RIGID)
        displace_surfaces(at, table, replica->steps_before + step, slot_count, displacement_next, history);

    const GrainSums total = add_up(sums.force, sums.torque, trouble, scratch);
    if (IS_LEADER && at.now.position.w > R(0)) {
        const Motion after = integrate(at, total.force.xyz, total.torque.xyz);
        motion_next[index] = after;
        const int bits = trouble_status(total.force.w) | motion_status(at, after);
        if (bits) status[index] |= bits;
        track[index].rotation =
            rotated(track[index].rotation, after.angular_velocity.xyz * replica->time_step);
        expect_listed(at, after, bits, track[index].listed_position.xyz, step, stop_at + r);
    }
    /* Without it PoCL lets padding grains into the block above, where work-groups that are done have left
     * before barriers. */
    SYNCHRONISE();
}
