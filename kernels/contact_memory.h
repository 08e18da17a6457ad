/* State of a contact that persists between steps; each side stores its own copy in its slot. The state of a
   grain is one block of rows of SLOTS reals, one row per quantity. Only rows that the replica needs are
   stored (Replica: memory_rows, deepest_row, relaxed_row). */
#define MAX_MEMORY_ROWS 5

typedef struct {
    lanes3 spring; /* elongation of the tangential spring (Mindlin friction), from this grain's side [m] */
    lanes deepest; /* largest overlap so far (plasticity) [m] */
    lanes relaxed; /* internal variable q (viscoelasticity) [N] */
} Memory;

/* Memory of all slots of a work-item: a private copy on a CPU, a pointer to global memory on a GPU. */
#if LANES == 16
typedef struct {
    lanes row[MAX_MEMORY_ROWS][SLOTS];
} Memories;
#define ROW_ENTRY(kept, kind, v) ((kept)->row[kind][v])
#else
typedef struct {
    global real* rows;
} Memories;
#define ROW_ENTRY(kept, kind, v) ((kept)->rows[(kind)*SLOTS + SLOT(v)])
#endif

INLINE void load_memories(Grain at, global real* restrict memory, Memories* restrict kept) {
    const int rows = at.replica->memory_rows;
#if LANES == 16
    for (int kind = 0; kind < rows; ++kind)
        load_row(memory + at.row * rows + kind * SLOTS, rows * SLOTS, at.count, kept->row[kind]);
#else
    kept->rows = memory + at.row * rows;
#endif
}

INLINE void store_memories(Grain at, const Memories* restrict kept, global real* restrict memory) {
#if LANES == 16
    const int rows = at.replica->memory_rows;
    for (int kind = 0; kind < rows; ++kind)
        store_row(kept->row[kind], at.count, memory + at.row * rows + kind * SLOTS, rows * SLOTS);
#else
    (void)at, (void)kept, (void)memory;
#endif
}

INLINE Memory recall(global const Replica* restrict replica, const int effects, const Memories* kept, int v) {
    Memory memory = {ZERO3, R(0), R(0)};
    if (replica->mindlin)
        memory.spring = (lanes3){ROW_ENTRY(kept, 0, v), ROW_ENTRY(kept, 1, v), ROW_ENTRY(kept, 2, v)};
    if (effects & EFFECT_PLASTICITY) memory.deepest = ROW_ENTRY(kept, replica->deepest_row, v);
    if (effects & EFFECT_VISCOELASTICITY) memory.relaxed = ROW_ENTRY(kept, replica->relaxed_row, v);
    return memory;
}

INLINE void remember(global const Replica* restrict replica, const int effects, Memory memory,
                     Memories* restrict kept, int v) {
    if (replica->mindlin) {
        ROW_ENTRY(kept, 0, v) = memory.spring.x;
        ROW_ENTRY(kept, 1, v) = memory.spring.y;
        ROW_ENTRY(kept, 2, v) = memory.spring.z;
    }
    if (effects & EFFECT_PLASTICITY) ROW_ENTRY(kept, replica->deepest_row, v) = memory.deepest;
    if (effects & EFFECT_VISCOELASTICITY) ROW_ENTRY(kept, replica->relaxed_row, v) = memory.relaxed;
}
