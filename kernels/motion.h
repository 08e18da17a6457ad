/* A grain as its neighbours see it. Side by side in memory, so that one line of it brings most of what a
 * contact needs. */
typedef struct {
    real4 position;         /* w: radius, zero for padding [m] */
    real4 velocity;         /* w: excess compliance, E/E_i - 1 [m/s] */
    real4 angular_velocity; /* w: species, from 0 [1/s] */
} Motion;
#define MOTION_VECTORS 3 /* the real4 of one grain */

/* What a step keeps of a grain that no neighbour looks at. */
typedef struct {
    real4 listed_position; /* where it was when its neighbours were listed [m] */
    real4 rotation;        /* since the start: a quaternion, its real part is w */
} Track;

/* One quantity of grains, lane by lane; `vector` counts the real4 of a Motion. */
INLINE lanes4 gather_motion(global const Motion* restrict motion, slots grain, int vector) {
    return gather4((global const real4*)motion + vector, grain * MOTION_VECTORS);
}

/* What one work-item of a step works for. */
typedef struct {
    global const Replica* replica;
    global const Material* materials; /* of all species of the replica */
    global const Material* material;  /* its own */
    int index;                        /* among all grains of the batch */
    size_t row;                       /* its first slot */
    real plate_z;                     /* where the plate is now [m] */
    real elapsed;                     /* of the interval [s] */
    Motion now;
} Grain;

/* Without -DSPECIES all grains of a replica are of one material, known when this is compiled. */
#ifndef SPECIES
#define SPECIES 1
#endif
#if SPECIES > 1
#define SPECIES_OF(motion) ((int)(motion).angular_velocity.w)
#else
#define SPECIES_OF(motion) 0
#endif

/* The batch as a step finds it. */
typedef struct {
    global const Motion* motion;
    global const int* partner;       /* a slot */
    global const int* partner_slot;  /* where the same contact stands in the neighbour's row */
    global const real* displacement; /* b of the surface at a slot, outward [m] */
    global real* memory;             /* contact_memory.h */
} Batch;
