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
#define TRACK_VECTORS 2

/* One quantity of grains, lane by lane; `vector` counts the real4 of a Motion. */
INLINE lanes4 gather_motion(global const Motion* restrict motion, slots grain, int vector) {
    return gather4((global const real4*)motion + vector, grain * MOTION_VECTORS);
}

/* A Motion of each lane. */
typedef struct {
    lanes3 position;
    lanes radius;
    lanes3 velocity;
    lanes excess_compliance;
    lanes3 spin;
    lanes species;
} Moving;

INLINE Moving load_motion(global const Motion* restrict motion, slots grain) {
    const lanes4 position = gather_motion(motion, grain, 0), velocity = gather_motion(motion, grain, 1),
                 spin = gather_motion(motion, grain, 2);
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

/* What one work-item of a step works for: grains side by side in memory, all of one replica. */
typedef struct {
    global const Replica* replica;
    global const Material* materials; /* of all species of the replica */
    int first;                        /* grain, among all of the batch */
    size_t row;                       /* its first slot */
    int count;                        /* of slots that are gone through; on a GPU one, its own */
    real plate_z;                     /* where the plate is now [m] */
    real elapsed;                     /* of the interval [s] */
    Moving now;
} Grain;

/* Slots that a grain may have contacts in. */
#if LANES == 16
#define CONTACT_SLOTS(at) ((at).count)
#else
#define CONTACT_SLOTS(at) SLOTS
#endif

/* Without -DSPECIES all grains of a replica are of one material, known when this is compiled. */
#ifndef SPECIES
#define SPECIES 1
#endif

/* The batch as a step finds it. */
typedef struct {
    global const Motion* motion;
    global const int* partner;       /* a slot */
    global const int* partner_slot;  /* where the same contact stands in the neighbour's row */
    global const real* displacement; /* b of the surface at a slot, outward [m] */
    global real* memory;             /* contact_memory.h */
} Batch;
