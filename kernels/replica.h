/* What the kernels know of one replica. Shared by host and device; `real` is the
   includer's. Scalars and arrays of scalars only, widest first. Units in brackets, SI. */

typedef struct {
    Material material;        /* of all grains; where some replica of the batch has several, see material.h */
    real time_step;           /* dt [s] */
    real drag;                /* of velocities [1/s] */
    real spin_drag;           /* of angular velocities, while the packing settles [1/s] */
    real sliding_velocity;    /* regularises saturated friction [m/s] */
    real skin;                /* neighbour list margin [m] */
    real max_move;            /* of a grain, before the list is made anew [m] */
    real probe_gap;           /* gap up to which surfaces are probed [m] */
    real overlap_limit;       /* over the sum of radii */
    real cell_size[3];        /* of the grid, along x y z [m] */
    real wall_position[6];    /* x_min x_max y_min y_max floor plate, at the interval's start [m] */
    real deformation[6];      /* of a cell, at the interval's start: xx yy zz xy xz yz (container.h) */
    real deformation_rate[6]; /* [1/s] */
    real plate_velocity;      /* along z [m/s] */
    real plate_tilt_x;        /* slope of the plate's face along x, about the middle of the box */
    real plate_tilt_y;        /* .. along y */
    real adhesion;            /* 2 pi w, pull-off force over R* [N/m] */
    real viscoelasticity;     /* part of the force that relaxes */
    real relaxing_share;      /* 1 - exp(-dt / T): of what is left to relax, in a step */
    real stiffening;          /* c, per overlap over R*; below zero it softens */
    real plasticity;          /* part of the deepest overlap that stays */
    real bulge_contacts;      /* part of the surface displacements that counts without geometric overlap */
    real mindlin_share;       /* of the friction force, the rest is saturated */
    real rolling_resistance;  /* mu_r */
    int first_grain;          /* of the padded arrays */
    int grain_count;
    int first_cell;
    int cells_x; /* of the grid in memory */
    int cells_y;
    int cells_z;
    int span_x; /* along the box; where more than cells_x, the grid repeats */
    int span_y;
    int span_z;
    int steps_before;    /* this interval, modulo 4: turns the ring of surface displacements */
    int surface;         /* SURFACE_* below */
    int finite_contacts; /* 1: the spheres' size and self terms are not zero */
    int confinement;     /* 1: coupling of some species is not zero */
    int mindlin;         /* 1: friction with history, all or a share */
    int memory_rows;     /* of a grain's contacts (contact_memory.h); springs take the first three */
    int deepest_row;     /* among them, of plasticity */
    int relaxed_row;     /* .. of viscoelasticity */
    int effects;         /* EFFECT_* bits: what goes beyond the plain model */
    int container;       /* CONTAINER_* below */
} Replica;

/* A cylinder touches x_min, x_max, y_min and y_max; its wall is number 0. A periodic cell has their
 * distances, and neither has other walls than floor and plate besides. A cell has no walls, and their
 * distances at start. */
#define CONTAINER_BOX 0
#define CONTAINER_CYLINDER 1
#define CONTAINER_PERIODIC 2
#define CONTAINER_CELL 3

#define SURFACE_RIGID 0      /* independent contacts */
#define SURFACE_HALF_SPACE 1 /* paper, Eq. 1, at the deformed contact points */
#define SURFACE_SPHERE 2     /* displacement of a sphere, a polynomial in sin(theta / 2) */

#define EFFECT_MODULUS_SCATTER 1
#define EFFECT_BULGE_CONTACTS 2
#define EFFECT_PLASTICITY 4
#define EFFECT_STIFFENING 8
#define EFFECT_VISCOELASTICITY 16
#define EFFECT_ADHESION 32
#define EFFECT_FRICTION_HISTORY 64
#define EFFECT_ROLLING_RESISTANCE 128
#define EFFECT_PLATE_TILT 256
