/* State of grains in memory and in registers: loading, storing, and the structs passed between the functions
   of a step. */

/* State of a grain that its neighbours read; stored contiguously, so that it takes few cache lines. */
typedef struct {
    real4 position;         /* w: radius, zero for padding [m] */
    real4 velocity;         /* w: excess compliance, E/E_i - 1 [m/s] */
    real4 angular_velocity; /* w: species, from 0 [1/s] */
} Motion;
#define MOTION_VECTORS 3 /* real4 per grain */

/* State of a grain that neighbours do not read. */
typedef struct {
    real4 listed_position; /* position when the neighbour list was built [m] */
    real4 rotation;        /* since the start; quaternion with real part w */
    real4 work;            /* in this interval, as in Report: work, damped, rubbed, dragged [J] */
} Track;
#define TRACK_VECTORS 3

/* The Motion of each lane's grain. */
typedef struct {
    lanes3 position;
    lanes radius;
    lanes3 velocity;
    lanes excess_compliance;
    lanes3 spin;
    lanes species;
} Moving;

INLINE Moving load_motion(global const Motion* restrict motion, slots grain) {
    global const real4* vectors = (global const real4*)motion;
    Places places;
    store_places(grain * MOTION_VECTORS, &places);
    const lanes4 position = gather4_at(vectors, &places), velocity = gather4_at(vectors + 1, &places),
                 spin = gather4_at(vectors + 2, &places);
    return (Moving){{position.x, position.y, position.z},
                    position.w,
                    {velocity.x, velocity.y, velocity.z},
                    velocity.w,
                    {spin.x, spin.y, spin.z},
                    spin.w};
}

INLINE void store_motion(Moving m, global Motion* restrict motion, slots grain) {
    global real4* vectors = (global real4*)motion;
    const slots place = grain * MOTION_VECTORS;
    scatter4((lanes4){m.position.x, m.position.y, m.position.z, m.radius}, vectors, place);
    scatter4((lanes4){m.velocity.x, m.velocity.y, m.velocity.z, m.excess_compliance}, vectors + 1, place);
    scatter4((lanes4){m.spin.x, m.spin.y, m.spin.z, m.species}, vectors + 2, place);
}

INLINE Moving chosen_motion(mask condition, Moving yes, Moving no) {
    Moving m = no;
    m.position = where3(condition, yes.position, no.position);
    m.velocity = where3(condition, yes.velocity, no.velocity);
    m.spin = where3(condition, yes.spin, no.spin);
    return m;
}

/* The LANES grains of a work-item: contiguous in memory, all of one replica. */
typedef struct {
    global const Replica* replica;
    global const Material* materials; /* of all species of the replica */
    int first;                        /* index of the first grain in the batch */
    size_t row;                       /* index of its first slot */
    int count;                        /* slots to process; on a GPU one, the work-item's own */
    real plate_z;                     /* current position of the plate [m] */
    real elapsed;                     /* time since the start of the interval [s] */
    Moving now;
} Grain;

/* Number of slots that may contain contacts. */
#if LANES == 16
#define CONTACT_SLOTS(at) ((at).count)
#else
#define CONTACT_SLOTS(at) SLOTS
#endif

/* Without -DSPECIES all grains of a replica have one material. */
#ifndef SPECIES
#define SPECIES 1
#endif

/* Fields of the batch that a step reads. */
typedef struct {
    global const Motion* motion;
    global const int* partner;       /* neighbour in each slot (partner.h) */
    global const int* partner_slot;  /* slot of the same contact in the neighbour's row */
    global const real* displacement; /* surface displacement b at each slot, outward [m] */
    global real* memory;             /* contact_memory.h */
} Batch;
