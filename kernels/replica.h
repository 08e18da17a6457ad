/* Parameters of one replica, in SI units. Shared with the host; the including file defines `real`. Only
   scalars and arrays of scalars, widest first, so that host and device use the same layout. */

typedef struct {
    Material material;        /* of all grains, if no replica of the batch has several species (material.h) */
    real time_step;           /* dt [s] */
    real drag;                /* of velocities [1/s] */
    real spin_drag;           /* of angular velocities, while the packing settles [1/s] */
    real sliding_velocity;    /* regularises saturated friction [m/s] */
    real skin;                /* neighbour list margin [m] */
    real max_move;            /* displacement of a grain at which the neighbour list is rebuilt [m] */
    real probe_gap;           /* largest gap at which surface displacements are computed [m] */
    real overlap_limit;       /* largest corrected overlap over overlap_scale() */
    real cell_size[3];        /* of the cell list, along x y z [m] */
    real wall_position[6];    /* x_min x_max y_min y_max floor plate, at the interval's start [m] */
    real deformation[6];      /* of a cell, at the interval's start: xx yy zz xy xz yz (container.h) */
    real deformation_rate[6]; /* [1/s] */
    real plate_velocity;      /* along z [m/s] */
    real plate_tilt_x;        /* slope of the plate's face along x, about the middle of the box */
    real plate_tilt_y;        /* .. along y */
    real adhesion;            /* 2 pi w, pull-off force over R* [N/m] */
    real cohesion;            /* 2 pi k, attraction over R* and overlap [N/m2] */
    real net_force_friction;  /* fraction of the attraction that reduces the Coulomb limit */
    real viscoelasticity;     /* fraction a of the force that relaxes */
    real relaxing_share;      /* 1 - exp(-dt / T) */
    real stiffening;          /* c, relative change of the force per overlap over R*; negative: softening */
    real law_exponent;        /* m, change of the exponent of the force against the overlap */
    real plasticity;          /* fraction of the largest overlap that is permanent */
    real bulge_contacts;     /* fraction of the surface displacements that counts without geometric overlap */
    real mindlin_share;      /* weight of the Mindlin law in the friction force */
    real rolling_resistance; /* mu_r */
    int first_grain;         /* index in the padded arrays */
    int grain_count;
    int first_cell;
    int cells_x; /* of the cell list in memory */
    int cells_y;
    int cells_z;
    int span_x; /* cells along the box; if larger than cells_x, the cell list repeats */
    int span_y;
    int span_z;
    int steps_before;    /* steps before this interval, modulo 4: position in the ring of displacements */
    int surface;         /* SURFACE_* below */
    int finite_contacts; /* 1: size and self terms of the sphere are not zero */
    int confinement;     /* 1: confinement coupling of some species is not zero */
    int mindlin;         /* MINDLIN_* below: Mindlin friction, alone or in the weighted mean; 0: none */
    int memory_rows;     /* rows of contact memory (contact_memory.h); Mindlin springs take the first three */
    int radius_row;      /* row of the contact radius, with Mindlin friction or rolling resistance */
    int deepest_row;     /* row of plasticity */
    int relaxed_row;     /* row of viscoelasticity */
    int rolling_row;     /* first of the three rows of rolling resistance */
    int effects;         /* EFFECT_* bits: effects beyond the plain model */
    int container;       /* CONTAINER_* below */
    int slot_count;      /* of the batch, all grains with surface displacements; 1 if none */
    int batch_size;      /* replicas of the batch */
} Replica;

/* BOX: six walls. CYLINDER: floor, plate, and a curved wall (number 0) that touches x_min, x_max, y_min and
   y_max. PERIODIC: floor and plate; the side positions give the periods. CELL: no walls; the positions give
   the periods of the undeformed cell. */
#define CONTAINER_BOX 0
#define CONTAINER_CYLINDER 1
#define CONTAINER_PERIODIC 2
#define CONTAINER_CELL 3

#define MINDLIN_FORCE 1        /* the spring keeps its force while the normal load increases */
#define MINDLIN_DISPLACEMENT 2 /* .. its displacement */

#define SURFACE_RIGID 0      /* independent contacts */
#define SURFACE_HALF_SPACE 1 /* Brodu et al. 2015, Eq. 1, at the deformed contact points */
#define SURFACE_SPHERE 2     /* elastic sphere: polynomials in sin(theta / 2) */

#define EFFECT_MODULUS_SCATTER 1
#define EFFECT_BULGE_CONTACTS 2
#define EFFECT_PLASTICITY 4
#define EFFECT_STIFFENING 8
#define EFFECT_VISCOELASTICITY 16
#define EFFECT_ATTRACTION 32
#define EFFECT_FRICTION_HISTORY 64
#define EFFECT_ROLLING_RESISTANCE 128
#define EFFECT_PLATE_TILT 256
#define EFFECT_LAW_EXPONENT 512
