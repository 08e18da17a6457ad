/* What an entry of a grain's row stands for: a grain by its index, or one of these. Shared by host and
 * device. */
#define NO_PARTNER (-1)
#define WALL_PARTNER(w) (-2 - (w))
