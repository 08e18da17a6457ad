/* Which grains a work-item works for, and sums over the slots of a grain, on both kinds of device. Opens
   every kernel that goes through contacts; declares block, first, table and scratch. */
#define SLOT_SUMS 7            /* of a step: force, torque, slots in trouble */
#define SHARED_ROW (SLOTS + 1) /* odd, so that rows begin in different banks of local memory */
#if LANES == 16
#define IS_LEADER true
#define STEP_ITEMS (BLOCK / LANES) /* of a work-group */
#define GRAINS_OF_WORK_ITEM                                         \
    const int block = blocks[get_group_id(0)];                      \
    const int first = block * BLOCK + (int)get_local_id(0) * LANES; \
private                                                             \
    ContactTable own_table;                                         \
private                                                             \
    real scratch[1];                                                \
    EXCHANGE ContactTable* table = &own_table;
#else
#define STEP_ITEMS (BLOCK * SLOTS)
#define IS_LEADER (get_local_id(0) % SLOTS == 0)
#define GRAINS_OF_WORK_ITEM                                           \
    const int block = blocks[get_group_id(0)];                        \
    const int first = block * BLOCK + (int)(get_local_id(0) / SLOTS); \
    local ContactTable tables[BLOCK];                                 \
    local real scratches[BLOCK][SLOT_SUMS * SHARED_ROW];              \
    EXCHANGE ContactTable* table = &tables[get_local_id(0) / SLOTS];  \
    EXCHANGE real* scratch = scratches[get_local_id(0) / SLOTS];
#endif

/* Sums over the slots of a grain, and the largest. A CPU's work-item has them already. On a GPU slots share()
   their values, and after a barrier every sum is one work-item's. */
#if LANES == 16
#define share(value, q, scratch)
#define sum_slots(value, q, scratch) (value)
#define max_slots(value, q, scratch) (value)
#else
INLINE void share(lanes value, int q, EXCHANGE real* scratch) {
    scratch[q * SHARED_ROW + get_local_id(0) % SLOTS] = value;
}
#define OVER_SLOTS(name, combine)                                                                    \
    INLINE real name(lanes value, int q, EXCHANGE const real* scratch) {                             \
        (void)value;                                                                                 \
        real all = scratch[q * SHARED_ROW];                                                          \
        for (int slot = 1; slot < SLOTS; ++slot) all = combine(all, scratch[q * SHARED_ROW + slot]); \
        return all;                                                                                  \
    }
#define PLUS(a, b) ((a) + (b))
OVER_SLOTS(sum_slots, PLUS)
OVER_SLOTS(max_slots, fmax)
#endif

/* What the slots of a grain add up to in a step. */
typedef struct {
    lanes3 force, torque;
    lanes trouble;
} GrainSums;

INLINE void share_sums(GrainSums slot, EXCHANGE real* scratch) {
    share(slot.force.x, 0, scratch);
    share(slot.force.y, 1, scratch);
    share(slot.force.z, 2, scratch);
    share(slot.torque.x, 3, scratch);
    share(slot.torque.y, 4, scratch);
    share(slot.torque.z, 5, scratch);
    share(slot.trouble, 6, scratch);
}

/* For the grain's leader alone. */
INLINE GrainSums add_up(GrainSums slot, EXCHANGE real* scratch) {
#if LANES == 16
    (void)scratch;
    return slot;
#else
    (void)slot;
    const int q = get_local_id(0) % SLOTS;
    if (q < SLOT_SUMS) scratch[q * SHARED_ROW] = sum_slots(R(0), q, scratch);
    SYNCHRONISE();
    EXCHANGE const real* s = scratch;
    return (GrainSums){{s[0], s[SHARED_ROW], s[2 * SHARED_ROW]},
                       {s[3 * SHARED_ROW], s[4 * SHARED_ROW], s[5 * SHARED_ROW]},
                       s[6 * SHARED_ROW]};
#endif
}

/* The partners in the slots of a work-item; returns how many slots it goes through. Rows are filled from
   their beginning. */
INLINE int load_partners(global const int* restrict rows, slots* restrict partner) {
#if LANES == 16
    int count = 0;
    for (int v = 0; v < SLOTS; v += 4) {
        load_slots(rows + v, 4, partner + v);
        if (!ANY(AS_MASK(partner[v] != NO_PARTNER))) break;
        count = v + 4;
    }
    while (count > 0 && !ANY(AS_MASK(partner[count - 1] != NO_PARTNER))) --count;
    return count;
#else
    load_slots(rows, 1, partner);
    return 1;
#endif
}

/* The surface displacements of both sides of the contacts, predicted for this step. Those of the other side
   lie scattered over the rows of the neighbours: a CPU calls for all of them ahead of their use, a GPU's
   other work-items fill the wait. */
INLINE void load_displacements(Grain at, Batch batch, lanes* restrict here, slots* restrict there) {
    if (at.replica->surface == SURFACE_RIGID) return;
#if LANES == 16
    for (int lane = 0; lane < LANES; ++lane)
        for (int v = 0; v < at.count; ++v)
            PREFETCH(batch.displacement + batch.partner_slot[at.row + lane * SLOTS + v]);
#endif
    load_row(batch.displacement + at.row, SLOTS, at.count, here);
    load_slots(batch.partner_slot + at.row, at.count, there);
}
/* An empty slot may hold anything: zero, so that nothing comes of it times its force of zero. */
INLINE Displaced displaced(Grain at, Batch batch, Neighbours seen, const lanes* here, const slots* there,
                           int v) {
    Displaced b = {R(0), R(0)};
    if (at.replica->surface == SURFACE_RIGID) return b;
    b.here = WHERE(seen.occupied, here[v], R(0));
    b.there = gather(batch.displacement, there[v]);
    return b;
}

/* The way of the grains since their neighbours were listed, from where they were then to `position`. */
INLINE lanes3 way_since_listed(Grain at, global const Track* restrict track, slots grain, lanes3 position) {
    const lanes4 listed = gather4((global const real4*)track, grain * TRACK_VECTORS);
    const lanes3 way = subtract3(position, (lanes3){listed.x, listed.y, listed.z});
    return deformed_way(at.replica, at.elapsed, way);
}
