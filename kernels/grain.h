/* Which grain a work-item works for, and sums over the slots of a grain, on both kinds of device. Opens
   every kernel that treats contacts side by side; declares block, grain, row, table and scratch. */
#if LANES == 16
#define IS_LEADER true
#define GRAIN_OF_WORK_ITEM                                   \
    const int block = blocks[get_group_id(0)];               \
    const int grain = block * BLOCK + (int)get_local_id(0);  \
    const size_t row = (size_t)grain * SLOTS;                \
    private ContactTable own_table;                          \
    private real scratch[1];                                 \
    EXCHANGE ContactTable* table = &own_table;
#else
#define IS_LEADER (get_local_id(0) % SLOTS == 0)
#define GRAIN_OF_WORK_ITEM                                          \
    const int block = blocks[get_group_id(0)];                      \
    const int grain = block * BLOCK + (int)(get_local_id(0) / SLOTS); \
    const size_t row = (size_t)grain * SLOTS;                       \
    local ContactTable tables[BLOCK];                               \
    local real scratches[BLOCK * SLOTS];                            \
    EXCHANGE ContactTable* table = &tables[get_local_id(0) / SLOTS]; \
    EXCHANGE real* scratch = &scratches[get_local_id(0) / SLOTS * SLOTS];
#endif

/* combine(..) over the slots of a grain in a fixed tree: one order on every device. */
#if LANES == 16
#define REDUCE_LANES(name, combine)                                       \
    static inline real name(lanes value, EXCHANGE real* scratch) {        \
        (void)scratch;                                                    \
        const real8 eight = combine(value.lo, value.hi);                  \
        const real4 four = combine(eight.lo, eight.hi);                   \
        const real2 two = combine(four.lo, four.hi);                      \
        return combine(two.x, two.y);                                     \
    }
#else
#define REDUCE_LANES(name, combine)                                                                     \
    static inline real name(lanes value, EXCHANGE real* scratch) {                                      \
        const int lane = get_local_id(0) % SLOTS;                                                       \
        SYNCHRONISE();                                                                                  \
        scratch[lane] = value;                                                                          \
        SYNCHRONISE();                                                                                  \
        if (lane < 16)                                                                                  \
            for (int other = lane + 16; other < SLOTS; other += 16)                                     \
                scratch[lane] = combine(scratch[lane], scratch[other]);                                 \
        for (int half_way = 8; half_way > 0; half_way /= 2) {                                           \
            SYNCHRONISE();                                                                              \
            if (lane < half_way) scratch[lane] = combine(scratch[lane], scratch[lane + half_way]);      \
        }                                                                                               \
        SYNCHRONISE();                                                                                  \
        return scratch[0];                                                                              \
    }
#endif
#define PLUS(a, b) ((a) + (b))
REDUCE_LANES(sum_lanes, PLUS)
REDUCE_LANES(max_lanes, fmax)

static inline real plate_position(global const Replica* restrict replica, int steps) {
    return replica->wall_position[5] + replica->plate_velocity * (replica->time_step * steps);
}

/* The surface displacements of both sides of a row's contacts, predicted for this step. */
static inline void load_bulges(global const Replica* restrict replica, size_t row, int v,
                               global const int* restrict mirror, global const real* restrict bulge,
                               lanes* here, lanes* there) {
    *here = R(0);
    *there = R(0);
    if (replica->surface == SURFACE_RIGID) return;
    const slots mirrors = LOAD_LANES(mirror + row, v);
    *here = LOAD_LANES(bulge + row, v);
    *there = WHERE(AS_MASK(mirrors >= 0), gather(bulge, max(mirrors, 0)), R(0));
}

static inline lanes3 load_springs(global const Replica* restrict replica, size_t row, int v,
                                  global const real* restrict x, global const real* restrict y,
                                  global const real* restrict z) {
    if (!replica->mindlin) return (lanes3){R(0), R(0), R(0)};
    return (lanes3){LOAD_LANES(x + row, v), LOAD_LANES(y + row, v), LOAD_LANES(z + row, v)};
}
