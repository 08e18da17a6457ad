/* What a contact remembers from step to step, each side in its own slot; only what its replica needs is kept. */

typedef struct {
    lanes3 spring;  /* tangential, of Mindlin friction, as seen from this grain [m] */
    lanes deepest;  /* overlap so far, of plasticity [m] */
    lanes relaxed;  /* force that the contact has got used to, of viscoelasticity [N] */
} Memory;

INLINE Memory load_memory(global const Replica* restrict replica, const int effects, size_t row, int v, global const real* restrict x,
                          global const real* restrict y, global const real* restrict z,
                          global const real* restrict deepest, global const real* restrict relaxed) {
    Memory memory = {{R(0), R(0), R(0)}, R(0), R(0)};
    if (replica->mindlin) memory.spring = (lanes3){LOAD_LANES(x + row, v), LOAD_LANES(y + row, v), LOAD_LANES(z + row, v)};
    if (effects & EFFECT_PLASTICITY) memory.deepest = LOAD_LANES(deepest + row, v);
    if (effects & EFFECT_VISCOELASTICITY) memory.relaxed = LOAD_LANES(relaxed + row, v);
    return memory;
}

INLINE void store_memory(global const Replica* restrict replica, const int effects, size_t row, int v, Memory memory, global real* restrict x,
                         global real* restrict y, global real* restrict z, global real* restrict deepest,
                         global real* restrict relaxed) {
    if (replica->mindlin) {
        STORE_LANES(memory.spring.x, x + row, v);
        STORE_LANES(memory.spring.y, y + row, v);
        STORE_LANES(memory.spring.z, z + row, v);
    }
    if (effects & EFFECT_PLASTICITY) STORE_LANES(memory.deepest, deepest + row, v);
    if (effects & EFFECT_VISCOELASTICITY) STORE_LANES(memory.relaxed, relaxed + row, v);
}
