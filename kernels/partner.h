/* Values of a slot in a grain's row: the index of a grain, NO_PARTNER, or a wall. Shared with the host. */
#define NO_PARTNER (-1)
#define WALL_PARTNER(w) (-2 - (w))
