/* State of a contact that persists between steps; each side stores its own copy in its slot. The state of a
   work-item's grains is one block of rows, one row per quantity, with one real per slot. Only rows that the
   replica needs are stored (Replica: memory_rows, radius_row, deepest_row, relaxed_row,
   rolling_row). */

typedef struct {
    lanes3 spring;  /* force of the tangential spring (Mindlin friction) on this grain [N] */
    lanes radius;   /* contact radius that the stiffness of the springs follows (kept_force) [m] */
    lanes deepest;  /* largest overlap so far (plasticity) [m] */
    lanes relaxed;  /* internal variable q (viscoelasticity) [N] */
    lanes3 rolling; /* couple of the rolling spring on this grain [N m] */
} Memory;

/* The rows of a work-item's grains: `load_row`, `store_row` and their vector forms access row `kind`. */
INLINE global real* memory_of(Grain at, global real* restrict memory) {
    return memory + (size_t)(at.first / LANES) * (LANES * SLOTS) * at.replica->memory_rows;
}

INLINE lanes load_row(global const real* kept, int kind, int v) {
    return load_slot(kept, kind * SLOTS * LANES, v);
}
INLINE void store_row(lanes value, global real* kept, int kind, int v) {
    store_slot(value, kept, kind * SLOTS * LANES, v);
}

INLINE lanes3 load_vector_rows(global const real* kept, int kind, int v) {
    return (lanes3){load_row(kept, kind, v), load_row(kept, kind + 1, v), load_row(kept, kind + 2, v)};
}
INLINE void store_vector_rows(lanes3 value, global real* kept, int kind, int v) {
    store_row(value.x, kept, kind, v);
    store_row(value.y, kept, kind + 1, v);
    store_row(value.z, kept, kind + 2, v);
}

/* Whether a contact has a spring, tangential or rolling. */
INLINE bool has_springs(global const Replica* restrict replica, const int effects) {
    return replica->mindlin || effects & EFFECT_ROLLING_RESISTANCE;
}

INLINE Memory recall(global const Replica* restrict replica, const int effects, global const real* kept,
                     int v) {
    Memory memory = {ZERO3, R(0), R(0), R(0), ZERO3};
    if (replica->mindlin) memory.spring = load_vector_rows(kept, 0, v);
    if (has_springs(replica, effects)) memory.radius = load_row(kept, replica->radius_row, v);
    if (effects & EFFECT_PLASTICITY) memory.deepest = load_row(kept, replica->deepest_row, v);
    if (effects & EFFECT_VISCOELASTICITY) memory.relaxed = load_row(kept, replica->relaxed_row, v);
    if (effects & EFFECT_ROLLING_RESISTANCE) memory.rolling = load_vector_rows(kept, replica->rolling_row, v);
    return memory;
}

INLINE void remember(global const Replica* restrict replica, const int effects, Memory memory,
                     global real* kept, int v) {
    if (replica->mindlin) store_vector_rows(memory.spring, kept, 0, v);
    if (has_springs(replica, effects)) store_row(memory.radius, kept, replica->radius_row, v);
    if (effects & EFFECT_PLASTICITY) store_row(memory.deepest, kept, replica->deepest_row, v);
    if (effects & EFFECT_VISCOELASTICITY) store_row(memory.relaxed, kept, replica->relaxed_row, v);
    if (effects & EFFECT_ROLLING_RESISTANCE) store_vector_rows(memory.rolling, kept, replica->rolling_row, v);
}
