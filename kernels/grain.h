/* Assignment of grains to work-items, and sums over the slots of a grain, for the CPU and the GPU layout.
   Kernels that process contacts begin with MEMORY_OF_WORK_ITEM, which declares `table` (the contact table of
   its grains) and `scratch` (for sums over slots). FIRST_GRAIN(block) is the first grain of the work-item. */
#define SLOT_SUMS 10           /* sums per step: force, torque, slots with a status, work */
#define SHARED_ROW (SLOTS + 1) /* odd, so that rows start in different banks of local memory */
#if LANES == 16
#define IS_LEADER true
#define STEP_ITEMS (BLOCK / LANES) /* work-group size */
#define FIRST_GRAIN(block) ((block).first + (int)get_local_id(0) * LANES)
#define MEMORY_OF_WORK_ITEM \
private                     \
    ContactTable own_table; \
private                     \
    real scratch[1];        \
    EXCHANGE ContactTable* table = &own_table;
#else
#define STEP_ITEMS (BLOCK * SLOTS)
#define IS_LEADER (get_local_id(0) % SLOTS == 0)
#define FIRST_GRAIN(block) ((block).first + (int)(get_local_id(0) / SLOTS))
#define MEMORY_OF_WORK_ITEM                                          \
    local ContactTable tables[BLOCK];                                \
    local real scratches[BLOCK][SLOT_SUMS * SHARED_ROW];             \
    EXCHANGE ContactTable* table = &tables[get_local_id(0) / SLOTS]; \
    EXCHANGE real* scratch = scratches[get_local_id(0) / SLOTS];
#endif

/* Sum and maximum over the slots of a grain. On a CPU a work-item has already combined all slots. On a GPU
   each slot stores its value with share(); after a barrier one work-item computes each sum. */
#if LANES == 16
#define share(value, q, scratch)
#define sum_slots(value, q, scratch) (value)
#define max_slots(value, q, scratch) (value)
#else
INLINE void share(lanes value, int q, EXCHANGE real* scratch) {
    scratch[q * SHARED_ROW + get_local_id(0) % SLOTS] = value;
}
#define OVER_SLOTS(name, combine)                                                                        \
    INLINE real name(lanes value, int q, EXCHANGE const real* scratch) {                                 \
        (void)value;                                                                                     \
        real all = scratch[q * SHARED_ROW];                                                              \
        _Pragma("unroll 8") /* whole loops of several sums would need too many registers */              \
            for (int slot = 1; slot < SLOTS; ++slot) all = combine(all, scratch[q * SHARED_ROW + slot]); \
        return all;                                                                                      \
    }
#define PLUS(a, b) ((a) + (b))
OVER_SLOTS(sum_slots, PLUS)
OVER_SLOTS(max_slots, fmax)
#endif

/* Power of contacts, as in Report [W]. */
typedef struct {
    lanes driven, damped, rubbed;
} Power;

/* Adds the power of a contact; a grain has half of that of a contact with another one. */
INLINE void add_power(Grain at, Neighbours neighbour, slots partner, Contacts c, Power* restrict sums) {
    const lanes part = WHERE(neighbour.wall, R(1), R(0.5));
    sums->damped += part * c.damped;
    sums->rubbed += part * c.rubbed;
    const mask plate = AS_MASK(partner == WALL_PARTNER(5));
    if (ANY(plate)) sums->driven += WHERE(plate, c.force.z * at.replica->plate_velocity, R(0));
    if (at.replica->container == CONTAINER_CELL)
        sums->driven += WHERE(neighbour.occupied, R(0.5) * dot3(c.force, cell_velocity(at, neighbour)), R(0));
}

/* Sums over the slots of a grain in a step. */
typedef struct {
    lanes3 force, torque;
    lanes trouble; /* counts for trouble_status() in advance.cl */
    Power power;
} GrainSums;

INLINE void share_sums(GrainSums slot, EXCHANGE real* scratch) {
    share(slot.force.x, 0, scratch);
    share(slot.force.y, 1, scratch);
    share(slot.force.z, 2, scratch);
    share(slot.torque.x, 3, scratch);
    share(slot.torque.y, 4, scratch);
    share(slot.torque.z, 5, scratch);
    share(slot.trouble, 6, scratch);
    share(slot.power.driven, 7, scratch);
    share(slot.power.damped, 8, scratch);
    share(slot.power.rubbed, 9, scratch);
}

/* The result is valid only in the grain's leader. */
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
                       s[6 * SHARED_ROW],
                       {s[7 * SHARED_ROW], s[8 * SHARED_ROW], s[9 * SHARED_ROW]}};
#endif
}

/* Loads the partners of a work-item and returns the number of slots to process. The slots of a grain are
   filled from the start. */
INLINE int load_partners(global const int* restrict field, size_t row, slots* restrict partner) {
    for (int v = 0; v < SLOTS_HERE; ++v) {
        partner[v] = load_number(field, row, v);
        if (LANES > 1 && !ANY(AS_MASK(partner[v] != NO_PARTNER))) return v;
    }
    return SLOTS_HERE;
}

/* The surface displacements of both sides at a slot, extrapolated to this step. The values of empty slots are
   undefined, so they are replaced by zero; NaN times a zero force is NaN. */
INLINE Displaced displaced(Grain at, Batch batch, Neighbours neighbour, int v) {
    Displaced b = {R(0), R(0)};
    if (at.replica->surface == SURFACE_RIGID) return b;
    b.here = WHERE(neighbour.occupied, load_slot(batch.displacement, at.row, v), R(0));
    b.there = gather(batch.displacement, load_number(batch.partner_slot, at.row, v));
    return b;
}

/* Sets status bits grain by grain; this is rare, so it need not be fast. */
INLINE void report_status(int first, slots bits, global int* restrict status) {
#if LANES == 16
    int each[LANES];
    vstore16(bits, 0, each);
    for (int lane = 0; lane < LANES; ++lane)
        if (each[lane]) status[first + lane] |= each[lane];
#else
    status[first] |= bits;
#endif
}

/* Displacement of the grains since the neighbour list was built. */
INLINE lanes3 way_since_listed(Grain at, global const Track* restrict track, slots grain, lanes3 position) {
    const lanes4 listed = gather4((global const real4*)track, grain * TRACK_VECTORS);
    const lanes3 way = subtract3(position, (lanes3){listed.x, listed.y, listed.z});
    return deformed_way(at.replica, at.elapsed, way);
}
