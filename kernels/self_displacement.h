/* What a contact of finite size moves its own point beyond Hertz (elastic sphere): the overlap that
   agrees with the force it causes. */

#define SMALLEST_RADIUS R(1e-3)
#define LARGEST_RADIUS R(0.64)

/* In F/(E R); `relative` is a/R. */
INLINE lanes self_displacement(global const Replica* restrict replica, lanes relative) {
    const lanes x = clamp(relative, (lanes)(SMALLEST_RADIUS), (lanes)(LARGEST_RADIUS));
    global const real* s = replica->sphere_self;
    const lanes value = s[0] + x * (s[2] + x * (s[3] + x * s[4]));
    return s[1] != R(0) ? value + s[1] * log(x) : value;
}

/* What a force moves the contact by on this side and on the other, per newton [m/N]. */
typedef struct { lanes here, there; } SelfCompliance;

INLINE SelfCompliance self_compliance(global const Replica* restrict replica, lanes contact_radius, real radius,
                                             lanes radius_there, mask wall) {
    const lanes inverse_there = WHERE(wall, R(0), R(1) / radius_there);
    SelfCompliance c;
    c.here = self_displacement(replica, contact_radius / radius) * (replica->sphere_scale / radius);
    c.there = WHERE(wall, R(0), self_displacement(replica, contact_radius * inverse_there) *
                                    (replica->sphere_scale * inverse_there));
    return c;
}

/* Solves overlap = given + compliance F(overlap), F = 4/3 E* sqrt(R* overlap) overlap, by Newton's method; the
   compliance goes with the latest contact radius. Three steps leave at most 1e-6 of the overlap (measured
   against bisection). */
INLINE lanes self_consistent_overlap(global const Replica* restrict replica, lanes given, lanes reduced_radius,
                                            lanes modulus, real radius, lanes radius_there, mask wall) {
    lanes overlap = given;
    for (int step = 0; step < 3; ++step) {
        const lanes a = sqrt(reduced_radius * overlap);
        const SelfCompliance c = self_compliance(replica, a, radius, radius_there, wall);
        const lanes slope = (c.here + c.there) * R(2) * modulus * a;
        const lanes excess = given + (R(2) / R(3)) * slope * overlap - overlap;
        overlap += fmax(excess / fmax(R(1) - slope, (lanes)(R(0.25))), -R(0.5) * overlap);
    }
    return overlap;
}
