/* Which grain a work-item works for, and sums over the slots of a grain, on both kinds of device. Opens
   every kernel that treats contacts side by side; declares block, index, table and scratch. */
#define SLOT_SUMS 7            /* of a step: force, torque, slots in trouble */
#define SHARED_ROW (SLOTS + 1) /* odd, so that rows begin in different banks of local memory */
#if LANES == 16
#define IS_LEADER true
#define STEP_ITEMS BLOCK /* of a work-group */
#define GRAIN_OF_WORK_ITEM                                  \
    const int block = blocks[get_group_id(0)];              \
    const int index = block * BLOCK + (int)get_local_id(0); \
private                                                     \
    ContactTable own_table;                                 \
private                                                     \
    real scratch[1];                                        \
    EXCHANGE ContactTable* table = &own_table;
#else
#define STEP_ITEMS (BLOCK * SLOTS)
#define IS_LEADER (get_local_id(0) % SLOTS == 0)
#define GRAIN_OF_WORK_ITEM                                            \
    const int block = blocks[get_group_id(0)];                        \
    const int index = block * BLOCK + (int)(get_local_id(0) / SLOTS); \
    local ContactTable tables[BLOCK];                                 \
    local real scratches[BLOCK][SLOT_SUMS * SHARED_ROW];              \
    EXCHANGE ContactTable* table = &tables[get_local_id(0) / SLOTS];  \
    EXCHANGE real* scratch = scratches[get_local_id(0) / SLOTS];
#endif

/* Sums over the slots of a grain, and the largest: fixed trees, one order on every device. On a GPU slots
   share() their values, and after a barrier every sum is one work-item's. */
#if LANES == 16
#define share(value, q, scratch)
INLINE real4 fold(lanes value) {
    const real8 eight = value.lo + value.hi;
    return eight.lo + eight.hi;
}
INLINE real4 sum_lanes(lanes a, lanes b, lanes c, lanes d) {
    const real4 p = fold(a), q = fold(b), r = fold(c), s = fold(d);
    return ((real4)(p.x, q.x, r.x, s.x) + (real4)(p.z, q.z, r.z, s.z)) +
           ((real4)(p.y, q.y, r.y, s.y) + (real4)(p.w, q.w, r.w, s.w));
}
INLINE real sum_slots(lanes value, int q, EXCHANGE const real* scratch) {
    (void)q, (void)scratch;
    const real4 four = fold(value);
    return (four.x + four.z) + (four.y + four.w);
}
INLINE real max_slots(lanes value, int q, EXCHANGE const real* scratch) {
    (void)q, (void)scratch;
    const real8 eight = fmax(value.lo, value.hi);
    const real4 four = fmax(eight.lo, eight.hi);
    return fmax(fmax(four.x, four.z), fmax(four.y, four.w));
}
#else
INLINE void share(lanes value, int q, EXCHANGE real* scratch) {
    scratch[q * SHARED_ROW + get_local_id(0) % SLOTS] = value;
}
#define TREE(name, combine)                                              \
    INLINE real name(lanes value, int q, EXCHANGE const real* scratch) { \
        (void)value;                                                     \
        EXCHANGE const real* row = scratch + q * SHARED_ROW;             \
        real part[16];                                                   \
        for (int lane = 0; lane < 16; ++lane) {                          \
            part[lane] = row[lane];                                      \
            for (int other = lane + 16; other < SLOTS; other += 16)      \
                part[lane] = combine(part[lane], row[other]);            \
        }                                                                \
        for (int half_way = 8; half_way > 0; half_way /= 2)              \
            for (int lane = 0; lane < half_way; ++lane)                  \
                part[lane] = combine(part[lane], part[lane + half_way]); \
        return part[0];                                                  \
    }
#define PLUS(a, b) ((a) + (b))
TREE(sum_slots, PLUS)
TREE(max_slots, fmax)
#endif

/* What the slots of a grain add up to in a step. */
typedef struct {
    real4 force; /* w: trouble */
    real4 torque;
} GrainSums;

INLINE void share_sums(lanes3 force, lanes3 torque, lanes trouble, EXCHANGE real* scratch) {
    share(force.x, 0, scratch);
    share(force.y, 1, scratch);
    share(force.z, 2, scratch);
    share(torque.x, 3, scratch);
    share(torque.y, 4, scratch);
    share(torque.z, 5, scratch);
    share(trouble, 6, scratch);
}

/* For the grain's leader alone. */
INLINE GrainSums add_up(lanes3 force, lanes3 torque, lanes trouble, EXCHANGE real* scratch) {
#if LANES == 16
    (void)scratch;
    return (GrainSums){sum_lanes(force.x, force.y, force.z, trouble),
                       sum_lanes(torque.x, torque.y, torque.z, (lanes)(R(0)))};
#else
    const int q = get_local_id(0) % SLOTS;
    if (q < SLOT_SUMS) scratch[q * SHARED_ROW] = sum_slots(R(0), q, scratch);
    SYNCHRONISE();
    EXCHANGE const real* s = scratch;
    return (GrainSums){(real4)(s[0], s[SHARED_ROW], s[2 * SHARED_ROW], s[6 * SHARED_ROW]),
                       (real4)(s[3 * SHARED_ROW], s[4 * SHARED_ROW], s[5 * SHARED_ROW], R(0))};
#endif
}

/* The surface displacements of both sides of a row's contacts, predicted for this step. */
INLINE Displaced load_displacements(Grain at, Batch batch, int v) {
    Displaced b = {R(0), R(0)};
    if (at.replica->surface == SURFACE_RIGID) return b;
    b.here = LOAD_LANES(batch.displacement + at.row, v);
    b.there = gather(batch.displacement, LOAD_LANES(batch.partner_slot + at.row, v));
    return b;
}

/* Calls for what load_displacements will gather for the next grain: its partner slots lie scattered over the
   rows of its neighbours, where no processor sees them coming. On a GPU other work-items fill the wait. */
INLINE void prefetch_next_displacements(Grain at, Batch batch) {
#if LANES == 16
    if (at.replica->surface == SURFACE_RIGID || (int)get_local_id(0) == BLOCK - 1) return;
    for (int slot = SLOTS; slot < 2 * SLOTS; ++slot)
        PREFETCH(batch.displacement + batch.partner_slot[at.row + slot]);
#else
    (void)at, (void)batch;
#endif
}
