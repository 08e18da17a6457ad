/* Displacement of a contact by its own force beyond Hertz (sphere models), S(nu, a/R) F/(E R) with
   S = S0 + S1 ln(a/R) + S2 a/R + S3 (a/R)^2 + S4 (a/R)^3. It is not delayed: self_consistent() solves for the
   overlap that is consistent with the force it causes. */

#define SMALLEST_RADIUS R(1e-3)
#define LARGEST_RADIUS R(0.64)
#define SATURATED_RADIUS R(0.4)

/* Coefficients S0 to S4 of one side's material, and scale = 1/E [1/Pa]. */
typedef struct {
    lanes s0, s1, s2, s3, s4, scale;
} SelfTerms;

INLINE SelfTerms self_terms_there(Grain at, Neighbours neighbour) {
    const SelfTerms terms = {of_neighbours(at, neighbour, PLACE_OF(sphere_self[0])),
                             of_neighbours(at, neighbour, PLACE_OF(sphere_self[1])),
                             of_neighbours(at, neighbour, PLACE_OF(sphere_self[2])),
                             of_neighbours(at, neighbour, PLACE_OF(sphere_self[3])),
                             of_neighbours(at, neighbour, PLACE_OF(sphere_self[4])),
                             of_neighbours(at, neighbour, PLACE_OF(sphere_scale))};
    return terms;
}
INLINE SelfTerms self_terms_here(Grain at) {
    const SelfTerms terms = {OWN(at, sphere_self[0]), OWN(at, sphere_self[1]), OWN(at, sphere_self[2]),
                             OWN(at, sphere_self[3]), OWN(at, sphere_self[4]), OWN(at, sphere_scale)};
    return terms;
}

/* S(a/R), in F/(E R); `relative` is a/R. */
INLINE lanes whole_self_displacement(Grain at, SelfTerms t, lanes relative) {
    const lanes x = clamp(relative, (lanes)(SMALLEST_RADIUS), (lanes)(LARGEST_RADIUS));
    const lanes value = t.s0 + x * (t.s2 + x * (t.s3 + x * t.s4));
    const bool has_log = SPECIES > 1 || at.materials->sphere_self[1] != R(0);
    return has_log ? value + t.s1 * log(x) : value;
}

/* Fraction of the self displacement that is solved within the step: all of it without confinement. With
   confinement the rest is delayed with the other surface displacements. The force is proportional to the cube
   of the contact radius, so the part solved within the step tends to a constant displacement. */
INLINE lanes known_share(Grain at, lanes relative) {
    if (!at.replica->confinement) return R(1);
    const lanes x = relative / SATURATED_RADIUS;
    return R(1) / (R(1) + x * x * x);
}
INLINE lanes self_displacement(Grain at, SelfTerms t, lanes relative) {
    return whole_self_displacement(at, t, relative) * known_share(at, relative);
}

/* Integral of the self displacement over the force, in F^2/(E R); the force is proportional to the cube of
   the contact radius. */
INLINE lanes self_work(Grain at, lanes relative) {
    const lanes x = clamp(relative, (lanes)(SMALLEST_RADIUS), (lanes)(LARGEST_RADIUS));
    const SelfTerms t = self_terms_here(at);
    const lanes value = R(0.5) * t.s0 + x * (R(3) / R(7) * t.s2 + x * (R(0.375) * t.s3 + x * (t.s4 / R(3))));
    const bool has_log = SPECIES > 1 || at.materials->sphere_self[1] != R(0);
    return has_log ? value + t.s1 * (R(0.5) * log(x) - R(1) / R(12)) : value;
}

/* Self displacement over force, on this side and on the other; and the derivative of their sum with respect
   to the force, at constant S [m/N]. */
typedef struct {
    lanes here, there, slope;
} SelfCompliance;

/* E/E_i of this grain, E/E_j of the neighbour. */
typedef struct {
    lanes here, there;
} ComplianceRatio;

/* The inverse radius of a wall is zero, and so is its compliance. */
INLINE SelfCompliance self_compliance(Grain at, SelfTerms here, SelfTerms there, ComplianceRatio ratio,
                                      lanes contact_radius, lanes inverse_radius, lanes inverse_there) {
    SelfCompliance c;
    const lanes x = contact_radius * inverse_radius, x_there = contact_radius * inverse_there;
    c.here = self_displacement(at, here, x) * (here.scale * inverse_radius * ratio.here);
    c.there = self_displacement(at, there, x_there) * (there.scale * inverse_there * ratio.there);
    c.slope = add_alike(c.here * known_share(at, x), c.there * known_share(at, x_there));
    return c;
}

/* The overlap that is consistent with the force it causes. */
typedef struct {
    lanes overlap;
    SelfCompliance compliance;
} SelfConsistent;

/* Solves overlap = given + compliance F(overlap), F = 4/3 E* sqrt(R* overlap) overlap, by Newton's method.
   The compliance depends weakly on the contact radius and is updated in each iteration. After three
   iterations the error is about 1e-6 of the overlap (compared with bisection in tests/kernels). */
INLINE SelfConsistent self_consistent(Grain at, Neighbours neighbour, ComplianceRatio ratio, lanes given,
                                      lanes reduced_radius, lanes modulus) {
    const lanes inverse_radius = R(1) / at.now.radius;
    const lanes inverse_there = WHERE(neighbour.wall, R(0), R(1) / neighbour.radius);
    const SelfTerms here = self_terms_here(at), there = self_terms_there(at, neighbour);
    SelfConsistent s;
    s.overlap = given;
    for (int step = 0; step < 3; ++step) {
        const lanes a = sqrt(reduced_radius * s.overlap);
        s.compliance = self_compliance(at, here, there, ratio, a, inverse_radius, inverse_there);
        const lanes stiffness = R(2) * modulus * a, slope = s.compliance.slope * stiffness;
        const lanes moved = add_alike(s.compliance.here, s.compliance.there) * stiffness;
        const lanes excess = given + (R(2) / R(3)) * moved * s.overlap - s.overlap;
        s.overlap += fmax(excess / fmax(R(1) - slope, (lanes)(R(0.25))), R(-0.5) * s.overlap);
    }
    return s;
}
