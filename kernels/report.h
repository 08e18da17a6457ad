/* Report that the host reads at the end of each interval of steps, one for each portion of a replica's
   grains. Shared with the host; only scalars and arrays of scalars, widest first. */
typedef struct {
    real kinetic_energy;  /* [J] */
    real elastic_energy;  /* [J] */
    real moved_squared;   /* largest squared displacement since the neighbour list was built [m2] */
    real deepest_overlap; /* largest corrected overlap over overlap_scale() */
    real frequency;       /* estimate of the highest vibration frequency (measure.cl) [rad/s] */
    real wall_force[18];  /* on x_min x_max y_min y_max floor plate, x y z each [N] */
    int status;           /* STATUS_* bits of all grains */
    int failed_grain;     /* lowest index of a grain with a status bit, -1 if none */
} Report;
