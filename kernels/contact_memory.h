/* What a contact remembers from step to step, each side in its own slot. A grain's memory is one block of
   rows of SLOTS reals; a batch keeps the rows that some replica needs (Replica: memory_rows and where each
   begins). */

typedef struct {
    lanes3 spring; /* tangential, of Mindlin friction, as seen from this grain [m] */
    lanes deepest; /* overlap so far, of plasticity [m] */
    lanes relaxed; /* force that the contact has got used to, of viscoelasticity [N] */
} Memory;

INLINE global real* memory_of(global const Replica* restrict replica, global real* memory, size_t row) {
    return memory + row * replica->memory_rows;
}

/* `rows`: of this grain. */
INLINE Memory load_memory(global const Replica* restrict replica, const int effects,
                          global const real* restrict rows, int v) {
    Memory memory = {ZERO3, R(0), R(0)};
    if (replica->mindlin)
        memory.spring =
            (lanes3){LOAD_LANES(rows, v), LOAD_LANES(rows + SLOTS, v), LOAD_LANES(rows + 2 * SLOTS, v)};
    if (effects & EFFECT_PLASTICITY) memory.deepest = LOAD_LANES(rows + replica->deepest_row * SLOTS, v);
    if (effects & EFFECT_VISCOELASTICITY) memory.relaxed = LOAD_LANES(rows + replica->relaxed_row * SLOTS, v);
    return memory;
}

INLINE void store_memory(global const Replica* restrict replica, const int effects, Memory memory,
                         global real* restrict rows, int v) {
    if (replica->mindlin) {
        STORE_LANES(memory.spring.x, rows, v);
        STORE_LANES(memory.spring.y, rows + SLOTS, v);
        STORE_LANES(memory.spring.z, rows + 2 * SLOTS, v);
    }
    if (effects & EFFECT_PLASTICITY) STORE_LANES(memory.deepest, rows + replica->deepest_row * SLOTS, v);
    if (effects & EFFECT_VISCOELASTICITY) STORE_LANES(memory.relaxed, rows + replica->relaxed_row * SLOTS, v);
}
