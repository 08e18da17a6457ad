/* Material constants of a species, derived on the host and shared with it. If all replicas of a batch have
   one material, it is stored in the Replica struct. If any has several species, a separate field stores
   MAX_SPECIES materials per replica. */
#define MAX_SPECIES 8           /* a power of two */
#define WALL_COLUMN MAX_SPECIES /* index of the walls in the arrays of pair constants */
#define POINT_TERMS 9
#define SIZE_TERMS 7
#define SELF_TERMS 5

typedef struct {
    real density;                   /* inertial [kg/m3] */
    real relative_density;          /* density over that of the first species */
    real weight_density;            /* (density - fluid density) g [N/m3] */
    real modulus[MAX_SPECIES + 1];  /* E* for contacts with each species and with walls [Pa] */
    real shear[MAX_SPECIES + 1];    /* G* [Pa] */
    real damping[MAX_SPECIES + 1];  /* 2 sqrt(5/6) beta */
    real friction[MAX_SPECIES + 1]; /* mu */
    real half_space_scale;          /* -gamma (1 + nu) / (2 pi E) [1/Pa] */
    real half_space_normal;         /* 3 - 4 nu */
    real half_space_shear;          /* 1 - 2 nu */
    real sphere_scale;              /* 1 / E [1/Pa] */
    real sphere_point[POINT_TERMS]; /* P: a point force displaces the surface by P(s)/s, s = sin(theta/2) */
    real sphere_size[SIZE_TERMS];   /* T: contact sizes add (2/5 a_k^2 + 2/3 a_c^2)/R^2 T(s)/s^3 */
    real sphere_self[SELF_TERMS];   /* S0 + S1 ln(a/R) + S2 a/R + ..: displacement of the loaded contact */
    real confinement_hertz;         /* c_h, finite strain (confinement.h) */
    real confinement_coupling;      /* c */
    real confinement_size;          /* c_z */
    real confinement_volume;        /* q */
    real confinement_shear;         /* t */
    real confinement_bulk[3];       /* u0, u1, u2 */
    real grain_compliance;          /* (1 - nu^2) / E [1/Pa] */
    real shear_compliance;          /* (2 - nu) / G [1/Pa] */
} Material;
