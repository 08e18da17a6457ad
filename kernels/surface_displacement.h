/* Surface displacements delta_kc: the outward displacement of a grain's surface at slot c by the force at
   contact k, summed over all k other than c. Computed for touching and for near neighbours c. Two models:
     half space   Brodu et al. 2015, Eq. 1, at the deformed contact points
     sphere       point force P(s)/s F/(E R), plus (2/5 a_k^2 + 2/3 a_c^2)/R^2 T(s)/s^3 F/(E R) by the finite
                  contact sizes, s = sin(theta/2); the host fits the polynomials P and T. */

/* Contacts of a grain, readable by all its slots. */
typedef struct {
    lanes x[SLOTS], y[SLOTS], z[SLOTS]; /* direction e; confinement.h reuses the memory */
    lanes arm[SLOTS];                   /* distance of the contact or probed point from the centre [m] */
    lanes elastic[SLOTS];               /* elastic force, zero without contact [N] */
    lanes radius[SLOTS];                /* contact radius [m] */
#if LANES == 1
    real padding[16]; /* the tables of a work-group start in different banks of local memory */
#endif
} ContactTable;

/* Displacements of two contacts of a grain by each other, per unit of force and prefactor: at the second by
   the first, and at the first by the second. */
typedef struct {
    lanes at_second, at_first;
} Mutual;

/* Brodu et al. 2015, Eq. 1, at the deformed contact points. With n = -e at both, all scalar products follow
   from cos(theta) = e_1 . e_2 and the two arms. */
INLINE Mutual half_space_displacement(own_constant normal, own_constant shear, bool sheared, lanes cosine,
                                      lanes arm_1, lanes arm_2) {
    const lanes squared = arm_1 * arm_1 + arm_2 * arm_2 - (R(2) * arm_2) * arm_1 * cosine;
    const lanes inverse = inverse_root(squared);
    const lanes along_1 = (arm_1 - arm_2 * cosine) * inverse; /* n_1 . u, u from the first to the second */
    const lanes along_2 = (arm_1 * cosine - arm_2) * inverse; /* n_2 . u */
    const lanes alike = along_1 * along_2 + normal * cosine;
    Mutual b = {alike, alike};
    if (sheared) {
        b.at_second -= shear * (cosine + along_2) / (R(1) + along_1);
        b.at_first -= shear * (cosine - along_1) / (R(1) - along_2);
    }
    b.at_second *= inverse;
    b.at_first *= inverse;
    return b;
}

#define SMALLEST_SINE R(0.15) /* the polynomials are valid from here: contacts 17 degrees apart */

/* The polynomials P and T of each lane. */
#if SPECIES > 1 && LANES > 1
typedef const lanes* Coefficients;
#else
typedef global const real* Coefficients;
#endif
typedef struct {
    Coefficients point, size;
} SphereTerms;

/* Even and odd powers are summed separately, which shortens the dependency chains. */
INLINE lanes point_polynomial(Coefficients p, lanes s) {
    const lanes q = s * s;
    const lanes even = p[0] + q * (p[2] + q * (p[4] + q * (p[6] + q * p[8])));
    const lanes odd = p[1] + q * (p[3] + q * (p[5] + q * p[7]));
    return even + s * odd;
}
INLINE lanes size_polynomial(Coefficients t, lanes s) {
    const lanes q = s * s;
    const lanes even = t[0] + q * (t[2] + q * (t[4] + q * t[6]));
    const lanes odd = t[1] + q * (t[3] + q * t[5]);
    return even + s * odd;
}

/* Outward displacement: by point forces, and the contribution of the finite contact sizes. */
typedef struct {
    lanes point, size;
} SurfaceDisplacement;

/* Displacement of an elastic sphere, in F/(E R), at the angle with the given cosine. The caller multiplies
   `size` by (2/5 a_1^2 + 2/3 a_2^2)/R^2, with the radii of the loading and of the displaced contact. */
INLINE SurfaceDisplacement sphere_displacement(SphereTerms terms, bool finite_contacts, lanes cosine) {
    const lanes squared = fmax(R(0.5) - R(0.5) * cosine, (lanes)(SMALLEST_SINE * SMALLEST_SINE));
    const lanes inverse = inverse_root(squared);
    const lanes s = squared * inverse;
    SurfaceDisplacement b = {point_polynomial(terms.point, s) * inverse, R(0)};
    if (finite_contacts) b.size = inverse * inverse * size_polynomial(terms.size, s) * inverse;
    return b;
}

INLINE void tabulate(Contacts c, lanes3 normal, int v, EXCHANGE ContactTable* table) {
    const int slot = SLOT(v);
    table->x[slot] = normal.x;
    table->y[slot] = normal.y;
    table->z[slot] = normal.z;
    table->arm[slot] = c.arm;
    table->elastic[slot] = c.elastic;
    table->radius[slot] = c.radius;
}

/* On a CPU each pair of slots once: both displacements of a pair cost little more than one. On a GPU all
   other slots with a force. */
#if LANES == 16
#define EACH_OTHER(other, slot, table) for (int other = 0; other < (slot); ++other)
#else
#define EACH_OTHER(other, slot, table)          \
    for (int other = 0; other < SLOTS; ++other) \
        if (other != (slot) && (table)->elastic[other] != R(0))
#endif

INLINE lanes cosine_between(EXCHANGE const ContactTable* table, int k, int c) {
    return table->x[k] * table->x[c] + table->y[k] * table->y[c] + table->z[k] * table->z[c];
}

/* `sheared`: 1 - 2 nu is not zero. The constant false makes the loop shorter. */
INLINE void half_space_sums(Grain at, EXCHANGE const ContactTable* table, const bool sheared,
                            SurfaceDisplacement* restrict b) {
    const own_constant normal = OWN(at, half_space_normal), shear = OWN(at, half_space_shear);
    const lanes scale = OWN(at, half_space_scale) * (R(1) + at.now.excess_compliance);
    for (int v = 0; v < at.count; ++v) {
        const int c = SLOT(v);
        lanes sum = R(0);
        EACH_OTHER(k, c, table) {
            const Mutual unit = half_space_displacement(normal, shear, sheared, cosine_between(table, k, c),
                                                        table->arm[k], table->arm[c]);
            sum += unit.at_second * table->elastic[k];
            if (LANES > 1) b[k].point += unit.at_first * table->elastic[c];
        }
        b[v] = (SurfaceDisplacement){sum, R(0)};
    }
    for (int v = 0; v < at.count; ++v) b[v].point *= scale;
}

INLINE void sphere_sums(Grain at, EXCHANGE const ContactTable* table, SurfaceDisplacement* restrict b) {
#if SPECIES > 1 && LANES > 1
    lanes point[POINT_TERMS], size[SIZE_TERMS];
    for (int i = 0; i < POINT_TERMS; ++i) point[i] = OWN(at, sphere_point[i]);
    for (int i = 0; i < SIZE_TERMS; ++i) size[i] = OWN(at, sphere_size[i]);
    const SphereTerms terms = {point, size};
#else
    const SphereTerms terms = {OWN_MATERIAL(at)->sphere_point, OWN_MATERIAL(at)->sphere_size};
#endif
    const bool finite_contacts = at.replica->finite_contacts;
    const lanes inverse_radius = R(1) / at.now.radius;
    for (int v = 0; v < at.count; ++v) {
        const int c = SLOT(v);
        const lanes radius = table->radius[c] * inverse_radius, squared = radius * radius;
        SurfaceDisplacement sum = {R(0), R(0)};
        EACH_OTHER(k, c, table) {
            const SurfaceDisplacement unit =
                sphere_displacement(terms, finite_contacts, cosine_between(table, k, c));
            const lanes radius_k = table->radius[k] * inverse_radius, squared_k = radius_k * radius_k;
            sum.point += unit.point * table->elastic[k];
            sum.size += (R(0.4) * squared_k + R(2) / R(3) * squared) * unit.size * table->elastic[k];
            if (LANES > 1) {
                b[k].point += unit.point * table->elastic[c];
                b[k].size += (R(0.4) * squared + R(2) / R(3) * squared_k) * unit.size * table->elastic[c];
            }
        }
        b[v] = sum;
    }
    const lanes scale = OWN(at, sphere_scale) * inverse_radius * (R(1) + at.now.excess_compliance);
    for (int v = 0; v < at.count; ++v) {
        b[v].point *= scale;
        b[v].size *= scale;
    }
}

/* Surface displacements at the slots of a work-item by the contacts of its grains. */
INLINE void surface_displacement(Grain at, EXCHANGE const ContactTable* table,
                                 SurfaceDisplacement* restrict b) {
    if (at.replica->surface == SURFACE_SPHERE)
        sphere_sums(at, table, b);
    else if (SPECIES > 1 || at.materials->half_space_shear != R(0))
        half_space_sums(at, table, true, b);
    else
        half_space_sums(at, table, false, b);
}
