/* What the kernels know of the material of grains. Shared by host and device, as replica.h is. Replicas of
   one material have it in themselves; where some replica of the batch has several species, a field of its own
   holds MAX_SPECIES materials of each. */
#define MAX_SPECIES 8           /* a power of two */
#define WALL_COLUMN MAX_SPECIES /* their place in a row of pairs */
#define POINT_TERMS 9
#define SIZE_TERMS 7
#define SELF_TERMS 5

typedef struct {
    real density;                   /* inertial [kg/m3] */
    real relative_density;          /* over the first species' */
    real weight_density;            /* (density - fluid density) g [N/m3] */
    real modulus[MAX_SPECIES + 1];  /* E* with each species, then with walls [Pa] */
    real shear[MAX_SPECIES + 1];    /* G* [Pa] */
    real damping[MAX_SPECIES + 1];  /* 2 sqrt(5/6) beta */
    real friction[MAX_SPECIES + 1]; /* mu */
    real half_space_scale;          /* -gamma (1 + nu) / (2 pi E) [1/Pa] */
    real half_space_normal;         /* 3 - 4 nu */
    real half_space_shear;          /* 1 - 2 nu */
    real sphere_scale;              /* 1 / E [1/Pa] */
    real sphere_point[POINT_TERMS]; /* P: a point force moves the surface by P(s)/s, s = sin(theta/2) */
    real sphere_size[SIZE_TERMS];   /* T: contact radii add (2/5 a_k^2 + 2/3 a_c^2)/R^2 T(s)/s^3 */
    real sphere_self[SELF_TERMS];   /* S0 + S1 ln(a/R) + S2 a/R + ..: the loaded contact itself */
    real confinement_hertz;         /* finite strain of the grain as a whole (confinement.h) */
    real confinement_coupling;
    real confinement_volume;
    real confinement_bulk[3];
    real grain_compliance; /* (1 - nu^2) / E [1/Pa] */
    real shear_compliance; /* (2 - nu) / G [1/Pa] */
} Material;
