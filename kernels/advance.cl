/* Kernel `advance`: one time step of every grain, or all steps of an interval. In a step, for each grain it
     1. gathers positions and velocities of the neighbours (contact_geometry.h),
     2. computes contact forces from overlaps corrected by surface displacements (contact_forces.h),
     3. computes the surface displacements that these forces cause (surface_displacement.h, confinement.h),
     4. integrates the equations of motion (integrate.h). */

/* Two counts in one sum: slots with too large an overlap, plus DEEP_SLOTS times the number of slots whose
   displacement exceeds the probed gap. */
#define DEEP_SLOTS 1024
INLINE slots trouble_status(lanes counts) {
    const slots count = AS_SLOTS(counts), deep = count & (DEEP_SLOTS - 1);
    return BITS(deep != 0, STATUS_OVERLAP) | BITS(count != deep, STATUS_UNPROBED);
}

/* Fields of the batch that a step writes. */
typedef struct {
    global Motion* motion;
    global real* displacement;
    global real* history; /* ring buffer of the surface displacements of the last four steps */
    global Track* track;
    global int* status;
    global volatile int* stop_at;
} Written;

/* Surface displacements for the next step and those of earlier steps. */
typedef struct {
    global real* next;
    global const real* two_before;
    global real* four_before; /* replaced by those of this step */
} Displacements;

INLINE Displacements displacements_of(Grain at, int step, Written to) {
    const int turn = at.replica->steps_before + step;
    const size_t slot_count = at.replica->slot_count;
    return (Displacements){to.displacement, to.history + ((turn + 2) & 3) * slot_count,
                           to.history + (turn & 3) * slot_count};
}

#if LANES == 16
/* Requests the displacements and the neighbours of the next 16 grains. If the state of a replica, about 1 kB
   per grain, exceeds the caches of the processor, they would otherwise arrive late; in smaller replicas these
   instructions would only take time. PoCL's `prefetch` has no code. */
#define CACHED_GRAINS 32768
#ifdef __x86_64__
#define PREFETCH(address) __asm__ volatile("prefetcht0 (%0)" : : "r"(address))
#else
#define PREFETCH(address) prefetch((global const char*)(address), 1)
#endif
INLINE void prefetch_slot(global const real* values) {
    PREFETCH(values);
    if (sizeof(lanes) > 64) PREFETCH(values + LANES / 2); /* the second cache line */
}
INLINE void prefetch_next(Grain at, Batch batch, Displacements surfaces) {
    global const Replica* replica = at.replica;
    if (replica->grain_count <= CACHED_GRAINS) return;
    if (at.first + LANES >= replica->first_grain + replica->grain_count) return; /* the last grains */
    const size_t next = at.row + LANES * SLOTS;
    const bool moves = replica->surface != SURFACE_RIGID;
    /* The number of slots is that of this work-item, which is about the same. */
    for (int c = 0; c < (moves ? at.count : 0); ++c) {
        prefetch_slot(batch.displacement + SLOT_PLACE(next, c));
        prefetch_slot(surfaces.two_before + SLOT_PLACE(next, c));
        prefetch_slot(surfaces.four_before + SLOT_PLACE(next, c));
        prefetch_slot(surfaces.next + SLOT_PLACE(next, c));
    }
    for (int c = 0; c < at.count * LANES; ++c) {
        /* A Motion is in one cache line or in two. */
        global const char* motion = (global const char*)(batch.motion + max(batch.partner[next + c], 0));
        PREFETCH(motion);
        PREFETCH(motion + sizeof(Motion) - 1);
        if (moves) PREFETCH(batch.displacement + batch.partner_slot[next + c]);
    }
}
#else
#define prefetch_next(at, batch, surfaces)
#endif

/* Contact forces of a grain and their sums; writes the contacts to `table` for the surface displacements.
   `effects` is the replica's value, or the constant 0, for which the compiler removes the effects. */
INLINE GrainSums contact_sums(Grain at, const int effects, Batch batch, const slots* partner,
                              EXCHANGE ContactTable* table) {
    global const Replica* restrict replica = at.replica;
    global real* kept = memory_of(at, batch.memory);
    GrainSums sums = {ZERO3, ZERO3, R(0), {R(0), R(0), R(0)}};
    /* Two loops: a CPU computes several slots of the second one at the same time, as long as its reorder
       buffer holds more than one. */
    Neighbours neighbours[SLOTS_HERE];
    Displaced displacements[SLOTS_HERE];
    for (int v = 0; v < at.count; ++v) {
        neighbours[v] = gather_neighbours(at, effects, batch.motion, partner[v]);
        displacements[v] = displaced(at, batch, neighbours[v], v);
    }
    for (int v = 0; v < at.count; ++v) {
        const Neighbours neighbour = neighbours[v];
        const Displaced b = displacements[v];
        Memory memory = recall(replica, effects, kept, v);
        const Contacts c = contact_forces(at, effects, neighbour, b, replica->time_step, &memory);
        remember(replica, effects, memory, kept, v);
        add_contacts(c, neighbour.normal, &sums.force, &sums.torque);
        add_power(at, neighbour, partner[v], c, &sums.power);
        if (effects & EFFECT_ROLLING_RESISTANCE) sums.torque = add3(sums.torque, c.couple);
        const mask too_deep = is_too_deep(at, neighbour, c.approach) & neighbour.occupied;
        const mask unprobed = AS_MASK(b.here > replica->probe_gap) & NOT(c.touching) & neighbour.occupied;
        sums.trouble += WHERE(too_deep, R(1), R(0)) + WHERE(unprobed, R(DEEP_SLOTS), R(0));
        tabulate(c, neighbour.normal, v, table);
    }
    return sums;
}

/* Surface displacement at every slot by the contact forces of this step. */
INLINE void surface_displacements(Grain at, EXCHANGE ContactTable* table, lanes* restrict displacement) {
    SurfaceDisplacement b[SLOTS_HERE];
    surface_displacement(at, table, b);
    for (int v = 0; v < at.count; ++v) displacement[v] = b[v].point + b[v].size;
    if (!at.replica->confinement) return;
    const Confinement all = confinement_of(at, confined(at, b, table));
    for (int v = 0; v < at.count; ++v) displacement[v] = confined_displacement(at, all, b[v], v, table);
}

/* Surface displacements by the contact forces of this step, extrapolated to the next step:
     b(t + dt) = (10 b(t) - 5 b(t - 2 dt) + b(t - 4 dt)) / 6.
   The phase error 8/3 sin^5(omega dt) is small, so the delay adds or removes little energy. The iteration is
   stable for gains from -1 to 1, as without extrapolation (ARCHITECTURE.md). */
INLINE void displace_surfaces(Grain at, EXCHANGE ContactTable* table, Displacements surfaces) {
    lanes now[SLOTS_HERE];
    surface_displacements(at, table, now);
    for (int v = 0; v < at.count; ++v) {
        const lanes two = load_slot(surfaces.two_before, at.row, v),
                    four = load_slot(surfaces.four_before, at.row, v);
        store_slot((R(10) / R(6)) * now[v] - (R(5) / R(6)) * two + (R(1) / R(6)) * four, surfaces.next,
                   at.row, v);
        store_slot(now[v], surfaces.four_before, at.row, v);
    }
}

/* Copies the state of a stopped replica to the other buffer of each double-buffered field, so that both
   buffers contain its last state. */
INLINE void keep_state(Grain at, slots grain, Batch batch, Written to) {
    if (IS_LEADER) store_motion(at.now, to.motion, grain);
    if (at.replica->surface == SURFACE_RIGID) return;
    for (int v = 0; v < at.count; ++v)
        store_slot(load_slot(batch.displacement, at.row, v), to.displacement, at.row, v);
}

/* Adds the work of a step to that of the interval. Work by walls and damping is integrated by the trapezoidal
   rule: half of the first step is added here, the other half by `measure` at the end. Friction gives the work
   of a step (friction.h); drag acts on the mean velocities of the step, as the change of the kinetic energy
   requires. */
INLINE void add_work(Grain at, Moving after, Power power, bool first, global real4* works, slots place) {
    global const Replica* restrict replica = at.replica;
    const lanes mass = sphere_mass(at, at.now.radius),
                inertia = R(0.4) * mass * at.now.radius * at.now.radius;
    const lanes3 velocity = scale3(R(0.5), add3(at.now.velocity, after.velocity));
    const lanes3 spin = scale3(R(0.5), add3(at.now.spin, after.spin));
    const lanes dragged = replica->drag * mass * dot3(at.now.velocity, velocity) +
                          replica->spin_drag * inertia * dot3(at.now.spin, spin);
    if (replica->container == CONTAINER_CELL) power.driven -= mass * dot3(velocity, flow_of_motion(at));
    const real dt = replica->time_step, part = first ? R(0.5) * dt : dt;
    lanes4 work = {R(0), R(0), R(0), R(0)};
    if (!first) work = gather4(works, place);
    work.x += part * power.driven;
    work.y += part * power.damped;
    work.z += dt * power.rubbed;
    work.w += dt * dragged;
    scatter4(work, works, place);
}

/* Integrates and stores the new state. Stops the replica after this step if a grain has a status bit or has
   moved farther than `max_move` since the neighbour list was built. */
INLINE void finish_step(Grain at, slots grain, GrainSums total, int step, Written to) {
    global real4* tracks = (global real4*)to.track;
    const slots place = grain * TRACK_VECTORS;
    const mask is_grain = AS_MASK(at.now.radius > R(0));
    const Moving after = chosen_motion(is_grain, integrate(at, total.force, total.torque), at.now);
    store_motion(after, to.motion, grain);
    const lanes4 rotation = gather4(tracks + 1, place);
    scatter4(rotated(rotation, scale3(at.replica->time_step, after.spin)), tracks + 1, place);
    add_work(at, after, total.power, step == 0, tracks + 2, place);
    const lanes3 moved = way_since_listed(at, to.track, grain, after.position);
    const real limit = at.replica->max_move;
    const mask far = AS_MASK(dot3(moved, moved) > limit * limit) & is_grain;
    const slots bits = BITS(is_grain, trouble_status(total.trouble) | motion_status(at, after));
    const mask trouble = AS_MASK(bits != 0);
    if (ANY(trouble)) report_status(at.first, bits, to.status);
    if (ANY(trouble | far)) atomic_min(to.stop_at, step + 1);
}

/* One time step of the grains of a work-item. */
INLINE void advance_grains(Grain at, int step, Batch batch, Written to, EXCHANGE ContactTable* table,
                           EXCHANGE real* scratch) {
    global const Replica* restrict replica = at.replica;
    const slots grain = at.first + LANE_NUMBERS;
    /* All work-items of a group take the same branch, as barriers require: concurrent writes in this step set
       stop_at to step + 1 at the lowest. */
    const int last = *to.stop_at;
    if (step >= last) {
        if (step == last) keep_state(at, grain, batch, to);
        return;
    }
    slots partners[SLOTS_HERE];
    at.count = load_partners(batch.partner, at.row, partners);
    prefetch_next(at, batch, displacements_of(at, step, to));
    /* Inlined twice; the copy with the constant 0 contains no code for effects. */
    const GrainSums sums = RARELY(replica->effects)
                               ? contact_sums(at, replica->effects, batch, partners, table)
                               : contact_sums(at, 0, batch, partners, table);
    share_sums(sums, scratch);
    SYNCHRONISE();
    if (replica->surface != SURFACE_RIGID) displace_surfaces(at, table, displacements_of(at, step, to));

    const GrainSums total = add_up(sums, scratch);
    if (IS_LEADER) finish_step(at, grain, total, step, to);
    /* Required by PoCL: without this barrier, padding grains execute the block above when work-groups of
       stopped replicas have returned before the barriers. */
    SYNCHRONISE();
}

/* Of a double-buffered field: what a step reads and what it writes, `made` steps after the first one. */
#define NOW(made, field) ((made) % 2 ? field##_next : field)
#define NEXT(made, field) ((made) % 2 ? field : field##_next)

/* `replica_count` = 0: makes step `step` of the blocks `blocks`. Otherwise, only on CPUs and from step 0:
   makes all steps of the interval for that many replicas, whose first blocks are `blocks`. Each work-item
   repeatedly takes the next of these replicas. The state of a replica then stays in the caches of one core,
   and cores do not wait for each other after each step. */
WORK_GROUP(STEP_ITEMS)
kernel void advance(const int step, const int replica_count, global const Replica* restrict replicas,
                    global const Material* restrict materials, global const Block* restrict blocks,
                    global volatile int* restrict stop_at, global Motion* restrict motion,
                    global Motion* restrict motion_next, global const int* restrict partner,
                    global const int* restrict partner_slot, global real* restrict displacement,
                    global real* restrict displacement_next, global real* restrict history,
                    global real* restrict memory, global Track* restrict track, global int* restrict status) {
    MEMORY_OF_WORK_ITEM
#if LANES == 16
    const bool whole = replica_count > 0;
    global volatile int* taken = stop_at + replicas->batch_size;
    const int turns = whole ? replica_count : (int)get_num_groups(0);
    int turn = whole ? atomic_inc(taken) : (int)get_group_id(0);
    while (turn < turns) {
        const Block block = blocks[turn];
        const int r = block.replica, first = FIRST_GRAIN(block);
        global const Replica* restrict replica = replicas + r;
        const int end = whole ? replica->first_grain + replica->grain_count : first + LANES;
        for (int made = 0; made <= (whole ? stop_at[r] : 0); ++made) {
            const Batch batch = {NOW(made, motion), partner, partner_slot, NOW(made, displacement), memory};
            const Written to = {NEXT(made, motion), NEXT(made, displacement), history, track, status,
                                stop_at + r};
            for (int k = first; k < end; k += LANES) {
                const Grain at = grain_at(replica, materials, r, k, step + made,
                                          load_motion(batch.motion, k + LANE_NUMBERS));
                advance_grains(at, step + made, batch, to, table, scratch);
            }
        }
        turn = whole ? atomic_inc(taken) : turns;
    }
#else
    const Block block = blocks[get_group_id(0)];
    const int r = block.replica, first = FIRST_GRAIN(block);
    const Batch batch = {motion, partner, partner_slot, displacement, memory};
    const Written to = {motion_next, displacement_next, history, track, status, stop_at + r};
    const Grain at = grain_at(replicas + r, materials, r, first, step, load_motion(motion, first));
    advance_grains(at, step, batch, to, table, scratch);
#endif
}
