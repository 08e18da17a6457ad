/* Which grain a work-item works for, and sums over the slots of a grain, on both kinds of device. Opens
   every kernel that treats contacts side by side; declares block, index, table and scratch. */
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
    local real scratches[BLOCK * SLOTS];                              \
    EXCHANGE ContactTable* table = &tables[get_local_id(0) / SLOTS];  \
    EXCHANGE real* scratch = &scratches[get_local_id(0) / SLOTS * SLOTS];
#endif

/* Sums over the slots of a grain, four at a time, and the largest: fixed trees, one order on every device. */
#if LANES == 16
INLINE real4 fold(lanes value) {
    const real8 eight = value.lo + value.hi;
    return eight.lo + eight.hi;
}
INLINE real4 sum_lanes(lanes a, lanes b, lanes c, lanes d, EXCHANGE real* scratch) {
    (void)scratch;
    const real4 p = fold(a), q = fold(b), r = fold(c), s = fold(d);
    return ((real4)(p.x, q.x, r.x, s.x) + (real4)(p.z, q.z, r.z, s.z)) +
           ((real4)(p.y, q.y, r.y, s.y) + (real4)(p.w, q.w, r.w, s.w));
}
INLINE real max_lanes(lanes value, EXCHANGE real* scratch) {
    (void)scratch;
    const real8 eight = fmax(value.lo, value.hi);
    const real4 four = fmax(eight.lo, eight.hi);
    return fmax(fmax(four.x, four.z), fmax(four.y, four.w));
}
#else
#define TREE(name, combine)                                                                        \
    INLINE real name(lanes value, EXCHANGE real* scratch) {                                        \
        const int lane = get_local_id(0) % SLOTS;                                                  \
        SYNCHRONISE();                                                                             \
        scratch[lane] = value;                                                                     \
        SYNCHRONISE();                                                                             \
        if (lane < 16)                                                                             \
            for (int other = lane + 16; other < SLOTS; other += 16)                                \
                scratch[lane] = combine(scratch[lane], scratch[other]);                            \
        for (int half_way = 8; half_way > 0; half_way /= 2) {                                      \
            SYNCHRONISE();                                                                         \
            if (lane < half_way) scratch[lane] = combine(scratch[lane], scratch[lane + half_way]); \
        }                                                                                          \
        SYNCHRONISE();                                                                             \
        return scratch[0];                                                                         \
    }
#define PLUS(a, b) ((a) + (b))
TREE(sum_one, PLUS)
TREE(max_lanes, fmax)
INLINE real4 sum_lanes(lanes a, lanes b, lanes c, lanes d, EXCHANGE real* scratch) {
    return (real4)(sum_one(a, scratch), sum_one(b, scratch), sum_one(c, scratch), sum_one(d, scratch));
}
#endif

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
