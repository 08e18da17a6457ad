/* What the host learns of a replica at the end of every interval of steps, a report for each portion of its
   grains. Shared by host and device; scalars and arrays of scalars only, widest first. */
#define PORTION_GRAINS 4096

typedef struct {
    int replica;
    int first; /* grain in the replica */
} Portion;

typedef struct {
    real kinetic_energy;  /* [J] */
    real elastic_energy;  /* [J] */
    real moved_squared;   /* farthest move of a grain since the neighbour list was made, squared [m2] */
    real deepest_overlap; /* corrected overlap over the sum of radii */
    real frequency;       /* upper estimate of the fastest mode's, stiffened by delayed corrections [rad/s] */
    real wall_force[18];  /* on x_min x_max y_min y_max floor plate, x y z each [N] */
    int status;           /* STATUS_* bits of all grains */
    int failed_grain;     /* lowest grain with a bit, -1 if none */
} Report;
