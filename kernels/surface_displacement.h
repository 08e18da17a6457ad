/* delta_kc: how far the surface of a grain moves outward at (or towards) neighbour c because of the
   force at contact k. The sum over k other than c of one grain, at every slot: touching or only near. */

/* The contacts of one grain as every slot of it must see them. */
typedef struct {
    real x[SLOTS], y[SLOTS], z[SLOTS]; /* direction e; x and y then serve confinement */
    real arm[SLOTS];                   /* distance of the contact or probed point [m] */
    real elastic[SLOTS];               /* force, zero where there is no contact [N] */
    real radius[SLOTS];                /* of the contact [m] */
#if LANES == 1
    real padding[16]; /* grains side by side in a work-group begin in different banks of local memory */
#endif
} ContactTable;

/* Paper, Eq. 1, from contact k with unit force and unit prefactor, at the deformed contact points. With
   n = -e at both, all products follow from cos(theta) = e_k . e_c and the two arms. */
INLINE lanes half_space_displacement(global const Material* restrict material, lanes cosine, lanes arm,
                                     real arm_k) {
    const lanes squared = arm * arm + arm_k * arm_k - R(2) * arm * arm_k * cosine;
    const lanes inverse = inverse_root(squared);
    const lanes along_k = (arm_k - arm * cosine) * inverse; /* n_k . u */
    const lanes along_c = (arm_k * cosine - arm) * inverse; /* n_c . u */
    lanes bracket = along_k * along_c + material->half_space_normal * cosine;
    if (material->half_space_shear != R(0))
        bracket -= material->half_space_shear * (cosine + along_c) / (R(1) + along_k);
    return bracket * inverse;
}

#define SMALLEST_SINE R(0.15) /* the polynomials hold from here on: contacts 17 degrees apart */

/* The polynomials P and T, even and odd powers apart: four short chains side by side instead of two long. */
INLINE lanes point_polynomial(global const real* p, lanes s) {
    const lanes q = s * s;
    const lanes even = p[0] + q * (p[2] + q * (p[4] + q * (p[6] + q * p[8])));
    const lanes odd = p[1] + q * (p[3] + q * (p[5] + q * p[7]));
    return even + s * odd;
}
INLINE lanes size_polynomial(global const real* t, lanes s) {
    const lanes q = s * s;
    const lanes even = t[0] + q * (t[2] + q * (t[4] + q * t[6]));
    const lanes odd = t[1] + q * (t[3] + q * t[5]);
    return even + s * odd;
}

/* Outward, of contacts as points and what their finite size adds. */
typedef struct {
    lanes point, size;
} SurfaceDisplacement;

/* Displacement of an elastic sphere, in F/(E R), at the angle whose cosine is given; `spread` is
   (2/5 a_k^2 + 2/3 a_c^2)/R^2 of the two contact radii. */
INLINE SurfaceDisplacement sphere_displacement(Grain at, lanes cosine, lanes spread) {
    global const Material* restrict material = at.material;
    const lanes squared = fmax(R(0.5) - R(0.5) * cosine, (lanes)(SMALLEST_SINE * SMALLEST_SINE));
    const lanes inverse = inverse_root(squared);
    const lanes s = squared * inverse;
    SurfaceDisplacement b = {point_polynomial(material->sphere_point, s) * inverse, R(0)};
    if (at.replica->finite_contacts)
        b.size = spread * inverse * inverse * size_polynomial(material->sphere_size, s) * inverse;
    return b;
}

INLINE void tabulate(Contacts c, lanes3 normal, int v, EXCHANGE ContactTable* table) {
    STORE_LANES(normal.x, table->x, v);
    STORE_LANES(normal.y, table->y, v);
    STORE_LANES(normal.z, table->z, v);
    STORE_LANES(c.arm, table->arm, v);
    STORE_LANES(c.elastic, table->elastic, v);
    STORE_LANES(c.radius, table->radius, v);
}

/* The sum over the contacts k of the grain, for its slots v. */
INLINE lanes half_space_sum(Grain at, EXCHANGE const ContactTable* table, real compliance_ratio,
                            lanes3 direction, int v) {
    global const Material* restrict material = at.material;
    const lanes arm = LOAD_LANES(table->arm, v);
    lanes sum = R(0);
    for (int k = 0; k < SLOTS; ++k) {
        const real force = table->elastic[k];
        if (!(force > R(0))) continue;
        const lanes cosine =
            direction.x * table->x[k] + direction.y * table->y[k] + direction.z * table->z[k];
        const lanes term = half_space_displacement(material, cosine, arm, table->arm[k]) * force;
        sum += WHERE(AS_MASK(SLOT_NUMBERS(v) == k), R(0), term);
    }
    return sum * (material->half_space_scale * compliance_ratio);
}

INLINE SurfaceDisplacement sphere_sum(Grain at, EXCHANGE const ContactTable* table, real compliance_ratio,
                                      lanes3 direction, int v) {
    const real radius = at.now.position.w;
    const lanes relative = LOAD_LANES(table->radius, v) / radius;
    const lanes receiving = (R(2) / R(3)) * relative * relative;
    SurfaceDisplacement sum = {R(0), R(0)};
    for (int k = 0; k < SLOTS; ++k) {
        const real force = table->elastic[k];
        if (!(force > R(0))) continue;
        const lanes cosine =
            direction.x * table->x[k] + direction.y * table->y[k] + direction.z * table->z[k];
        const real source = table->radius[k] / radius;
        const SurfaceDisplacement b = sphere_displacement(at, cosine, receiving + R(0.4) * source * source);
        const mask itself = AS_MASK(SLOT_NUMBERS(v) == k);
        sum.point += WHERE(itself, R(0), b.point * force);
        sum.size += WHERE(itself, R(0), b.size * force);
    }
    const real scale = at.material->sphere_scale / radius * compliance_ratio;
    sum.point *= scale;
    sum.size *= scale;
    return sum;
}

/* By the contacts of the grain, at its slots v. */
INLINE SurfaceDisplacement surface_displacement(Grain at, EXCHANGE const ContactTable* table, int v) {
    const lanes3 direction = {LOAD_LANES(table->x, v), LOAD_LANES(table->y, v), LOAD_LANES(table->z, v)};
    const real compliance_ratio = R(1) + at.now.velocity.w;
    if (at.replica->surface == SURFACE_SPHERE) return sphere_sum(at, table, compliance_ratio, direction, v);
    const SurfaceDisplacement b = {half_space_sum(at, table, compliance_ratio, direction, v), R(0)};
    return b;
}
