/* Report that the host reads at the end of each interval of steps, one for each portion of a replica's
   grains. Shared with the host; only scalars and arrays of scalars, widest first. */
typedef struct {
    real kinetic_energy; /* [J] */
    real elastic_energy; /* without springs of friction [J] */
    real weight_work;    /* work of the weight since the neighbour list was built [J] */
    real spring_energy;  /* of tangential and rolling springs [J] */
    real work;           /* by the plate or by the motion of a cell, in this interval [J] */
    real damped;         /* work of normal damping, as all below in this interval; positive: dissipated [J] */
    real rubbed;         /* of tangential forces and rolling couples, springs included [J] */
    real dragged;        /* of drag [J] */
    real moved_squared;  /* largest squared displacement since the neighbour list was built [m2] */
    real deepest_overlap; /* largest corrected overlap over overlap_scale() */
    real step_rate;       /* inverse of the longest stable time step (stable_step.h) [1/s] */
    real wall_force[18];  /* on x_min x_max y_min y_max floor plate, x y z each [N] */
    int status;           /* STATUS_* bits of all grains */
    int failed_grain;     /* lowest index of a grain with a status bit, -1 if none */
} Report;
