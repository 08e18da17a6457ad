/* Parts of a batch that work-groups process. Shared with the host. */
#define PORTION_GRAINS 4096

/* BLOCK grains of a replica, for a step; the last block of a replica is padded. */
typedef struct {
    int replica;
    int first; /* index of the first grain within the batch */
} Block;

/* Up to PORTION_GRAINS grains of a replica, for sums. */
typedef struct {
    int replica;
    int first; /* index of the first grain within the replica */
} Portion;
