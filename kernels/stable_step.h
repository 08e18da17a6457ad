/* The longest stable time step of a grain, in whose translation contacts and delayed surface displacements
   act together.
     Along the direction d in which the contacts are stiffest, with neighbours that move the opposite way, the
   grain has the stiffness K = sum w (k_n q^2 + k_t (1 - q^2)), q = n . d, and the damping constant C, summed
   alike. The forces w k_n q of this motion displace the surface at its contacts by b; these displacements
   change the stiffness by the gain lambda = sum w k_n q b / K, which has a sign. w is 2 for contacts between
   grains, because both sides move and both surfaces are displaced, and 1 for walls: x'K x of all grains is at
   most the sum of these terms, so no mode of the packing is faster.
     A vibration exp(i w t/dt) at the stability limit fulfils the equation of motion of the leapfrog scheme
   with displacements extrapolated by A(w) = R(w) - i S(w) (advance.cl):
     omega dt = 2 sin(w/2) sqrt(1 - lambda R),   omega^2 = K/m
     lambda S / (cos(w/2) (1 - lambda R)^(3/2)) = C/(m omega)
   The left side of the second equation is the energy that the delay adds, the right side what damping
   removes. The step may be as long as the largest omega dt of the phases at which damping removes more.
   With a negative gain, w = pi is unstable from omega dt = 2 sqrt(1 + lambda) on. */

/* Constants of a phase w: 2 sin(w/2), R(w), S(w)/cos(w/2); 0.09 to 1.11 in factors of the eighth root of two.
   R = (10 cos w - 5 cos 3w + cos 5w)/6, S = 8/3 sin^5 w. */
#define PHASES 30
typedef struct {
    real step, real_part, delay;
} Phase;
constant Phase phases[PHASES] = {
    {R(0.08997), R(1.00685), R(1.5656e-05)}, /* 0.090 */
    {R(0.09811), R(1.00817), R(2.4119e-05)}, /* 0.098 */
    {R(0.10698), R(1.00975), R(3.7149e-05)}, /* 0.107 */
    {R(0.11665), R(1.01164), R(5.7203e-05)}, /* 0.117 */
    {R(0.12719), R(1.01391), R(8.8058e-05)}, /* 0.127 */
    {R(0.13869), R(1.01663), R(1.3551e-04)}, /* 0.139 */
    {R(0.15122), R(1.01990), R(2.0844e-04)}, /* 0.151 */
    {R(0.16487), R(1.02383), R(3.2048e-04)}, /* 0.165 */
    {R(0.17976), R(1.02858), R(4.9244e-04)}, /* 0.180 */
    {R(0.19598), R(1.03432), R(7.5615e-04)}, /* 0.196 */
    {R(0.21365), R(1.04128), R(1.1601e-03)}, /* 0.214 */
    {R(0.23290), R(1.04971), R(1.7782e-03)}, /* 0.233 */
    {R(0.25387), R(1.05998), R(2.7223e-03)}, /* 0.255 */
    {R(0.27671), R(1.07248), R(4.1618e-03)}, /* 0.278 */
    {R(0.30157), R(1.08775), R(6.3521e-03)}, /* 0.303 */
    {R(0.32862), R(1.10640), R(9.6760e-03)}, /* 0.330 */
    {R(0.35806), R(1.12919), R(1.4704e-02)}, /* 0.360 */
    {R(0.39007), R(1.15701), R(2.2283e-02)}, /* 0.393 */
    {R(0.42485), R(1.19088), R(3.3655e-02)}, /* 0.428 */
    {R(0.46263), R(1.23191), R(5.0628e-02)}, /* 0.467 */
    {R(0.50364), R(1.28117), R(7.5797e-02)}, /* 0.509 */
    {R(0.54809), R(1.33955), R(1.1283e-01)}, /* 0.555 */
    {R(0.59624), R(1.40740), R(1.6681e-01)}, /* 0.605 */
    {R(0.64832), R(1.48398), R(2.4461e-01)}, /* 0.660 */
    {R(0.70455), R(1.56663), R(3.5517e-01)}, /* 0.720 */
    {R(0.76515), R(1.64964), R(5.0963e-01)}, /* 0.785 */
    {R(0.83031), R(1.72276), R(7.2088e-01)}, /* 0.856 */
    {R(0.90017), R(1.76963), R(1.0022e+00)}, /* 0.934 */
    {R(0.97481), R(1.76660), R(1.3645e+00)}, /* 1.018 */
    {R(1.05422), R(1.68298), R(1.8109e+00)}, /* 1.110 */
};

/* Undamped contacts would need infinitely short steps. With this damping ratio, times two, vibrations grow by
   a factor e in 32,000 periods. */
#define LEAST_DAMPING R(1e-5)

/* Largest omega dt for a gain and a damping C/(m omega). */
INLINE lanes stable_phase(lanes gain, lanes damping) {
    const lanes removed = fmax(damping, (lanes)(LEAST_DAMPING));
    mask stable = AS_MASK(gain < R(1));
    lanes longest = R(0);
#pragma unroll 1 /* unrolled loops would need too many registers on GPUs */
    for (int i = 0; i < PHASES; ++i) {
        const lanes left = fmax(R(1) - gain * phases[i].real_part, (lanes)(R(0)));
        const lanes root = sqrt(left);
        stable = stable & AS_MASK(gain * phases[i].delay <= removed * left * root);
        longest = WHERE(stable, fmax(longest, phases[i].step * root), longest);
    }
    return fmin(longest, R(1.9) * sqrt(fmax(R(1) + gain, (lanes)(R(0)))));
}

/* Symmetric tensor. */
typedef struct {
    lanes xx, yy, zz, yz, xz, xy;
} Tensor;

/* alike times unity plus along times n n. */
INLINE Tensor axial_tensor(lanes alike, lanes along, lanes3 n) {
    return (Tensor){alike + along * n.x * n.x, alike + along * n.y * n.y, alike + along * n.z * n.z,
                    along * n.y * n.z,         along * n.x * n.z,         along * n.x * n.y};
}
INLINE Tensor add_tensors(Tensor a, Tensor b) {
    return (Tensor){a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.yz + b.yz, a.xz + b.xz, a.xy + b.xy};
}
INLINE Tensor scaled_tensor(lanes f, Tensor a) {
    return (Tensor){f * a.xx, f * a.yy, f * a.zz, f * a.yz, f * a.xz, f * a.xy};
}
INLINE Tensor squared_tensor(Tensor a) {
    return (Tensor){a.xx * a.xx + a.xy * a.xy + a.xz * a.xz, a.xy * a.xy + a.yy * a.yy + a.yz * a.yz,
                    a.xz * a.xz + a.yz * a.yz + a.zz * a.zz, a.xy * a.xz + a.yy * a.yz + a.yz * a.zz,
                    a.xx * a.xz + a.xy * a.yz + a.xz * a.zz, a.xx * a.xy + a.xy * a.yy + a.xz * a.yz};
}
INLINE lanes3 times_vector(Tensor a, lanes3 v) {
    return (lanes3){a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
                    a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

/* Unit vector of the largest eigenvalue, by repeated squaring; along z if the tensor is zero. */
INLINE lanes3 main_axis(Tensor a) {
    Tensor power = a;
    for (int i = 0; i < 4; ++i) {
        const lanes trace = power.xx + power.yy + power.zz;
        power = squared_tensor(scaled_tensor(R(1) / WHERE(AS_MASK(trace > R(0)), trace, R(1)), power));
    }
    const mask x = AS_MASK(power.xx > power.zz) & AS_MASK(power.xx >= power.yy);
    const mask y = AS_MASK(power.yy > power.zz) & NOT(x);
    const lanes3 start = {WHERE(x, R(1), R(0)), WHERE(y, R(1), R(0)), WHERE(x | y, R(0), R(1))};
    lanes3 axis = times_vector(power, start);
    const lanes squared = dot3(axis, axis);
    axis = where3(AS_MASK(squared > R(0)), axis, start);
    return scale3(inverse_root(dot3(axis, axis)), axis);
}

/* A touching contact for small motions, times w; zero without contact. */
typedef struct {
    lanes normal, shear;          /* k_n and k_t [N/m] */
    lanes damping, shear_damping; /* [kg/s] */
} ContactStiffness;

/* k_n is the derivative of the force with respect to the approach without the contact's own displacement,
   which increases with the force and is solved within the step. */
INLINE ContactStiffness contact_stiffness(Grain at, Neighbours neighbour, Displaced b, Contacts c) {
    global const Replica* restrict replica = at.replica;
    const lanes weight = WHERE(c.touching, WHERE(neighbour.wall, R(1), R(2)), R(0));
    const lanes overlap = WHERE(c.touching, c.overlap, R(1));
    const lanes without_own = b.here + b.there - (neighbour.distance - (at.now.radius + neighbour.radius));
    const lanes slope = R(1.5) * c.elastic / overlap, mass = reduced(at, neighbour).mass;
    const lanes damping = weight * OF_PAIRS(at, damping, neighbour);
    ContactStiffness s = {weight * slope, R(0), damping * sqrt(slope * mass), R(0)};
    if (replica->finite_contacts)
        s.normal *= overlap / fmax(R(1.5) * without_own - R(0.5) * overlap, R(0.25) * overlap);
    if (replica->effects & EFFECT_PLASTICITY) s.normal /= R(1) - replica->plasticity;
    if (replica->mindlin) {
        const lanes shear = shear_stiffness(at, replica->effects, neighbour, c.radius);
        s.shear = weight * shear;
        s.shear_damping = damping * sqrt(shear * mass);
    }
    return s;
}

/* Displacement at small strain to that at finite strain, for a pressure that does not change. */
INLINE Yielding yielding_of(Grain at, EXCHANGE const ContactTable* table) {
    lanes force = R(0);
#pragma unroll 1
    for (int k = 0; k < CONTACT_SLOTS(at); ++k) force += table->elastic[k];
    return yielding(at, force * stress_per_force(at));
}
/* Delayed displacement by a contact's own force F beyond Hertz, over F/(E R). */
INLINE lanes delayed_self(Grain at, Yielding y, lanes relative) {
    return whole_self_displacement(at, self_terms_here(at), relative) * (y.work - known_share(at, relative));
}
/* Derivative of a contact's delayed own displacement with respect to its force, which is proportional to the
   cube of the contact radius a: that of F f(a/R) is f + (a/R) f'/3. */
INLINE lanes own_response(Grain at, Yielding y, lanes contact_radius) {
    const lanes relative = contact_radius / at.now.radius;
    const lanes self = delayed_self(at, y, relative), larger = delayed_self(at, y, R(1.03) * relative);
    return R(2) / R(3) * (R(1) - y.hertz) * hertz_share(at) / contact_radius +
           own_compliance(at) / at.now.radius * (self + (larger - self) / R(0.09));
}

/* Sums along the axis over the slots of this work-item: K and C of normal and of tangential forces, and
   sum w k_n q b. */
typedef struct {
    lanes stiffness, shear, damping, shear_damping, displaced;
} AxialSums;

/* The forces in the table are replaced by those of a unit motion along the axis, and restored. */
INLINE AxialSums axial_sums(Grain at, const ContactStiffness* slot, lanes3 axis,
                            EXCHANGE ContactTable* table) {
    AxialSums sums = {R(0), R(0), R(0), R(0), R(0)};
    lanes forces[SLOTS_HERE];
    Yielding y = {R(1), R(1), R(1), R(1)};
    if (at.replica->confinement) y = yielding_of(at, table);
    if (at.replica->surface == SURFACE_RIGID) return sums;
    SYNCHRONISE();
    for (int v = 0; v < at.count; ++v) {
        const int k = SLOT(v);
        const lanes q = table->x[k] * axis.x + table->y[k] * axis.y + table->z[k] * axis.z;
        forces[v] = table->elastic[k];
        table->elastic[k] = slot[v].normal * q;
        sums.stiffness += slot[v].normal * q * q;
        sums.shear += slot[v].shear * (R(1) - q * q);
        sums.damping += slot[v].damping * q * q;
        sums.shear_damping += slot[v].shear_damping * (R(1) - q * q);
    }
    SYNCHRONISE();
    SurfaceDisplacement b[SLOTS_HERE];
    surface_displacement(at, table, b);
    for (int v = 0; v < at.count; ++v) {
        const lanes force = table->elastic[SLOT(v)];
        lanes response = y.work * b[v].point + y.size * b[v].size;
        if (at.replica->confinement)
            response +=
                own_response(at, y, fmax(table->radius[SLOT(v)], SMALLEST_RADIUS * at.now.radius)) * force;
        sums.displaced += force * response;
    }
    SYNCHRONISE();
    for (int v = 0; v < at.count; ++v) table->elastic[SLOT(v)] = forces[v];
    return sums;
}

/* Inverse of the longest stable time step for these K and C [1/s]; zero without contacts. */
INLINE lanes rate_of(lanes mass, lanes stiffness, lanes damping, lanes displaced) {
    const mask touches = AS_MASK(stiffness > R(0));
    const lanes divisor = WHERE(touches, stiffness, R(1)), frequency = sqrt(divisor / mass);
    const lanes longest = stable_phase(displaced / divisor, damping / (mass * frequency));
    return WHERE(touches, frequency / fmax(longest, (lanes)(phases[0].step)), R(0));
}

/* The same for contacts that slide, and for contacts that stick: then the frequency is higher, but surface
   displacements contribute less to the stiffness. */
INLINE lanes step_rate(lanes mass, AxialSums s) {
    return fmax(rate_of(mass, s.stiffness, s.damping, s.displaced),
                rate_of(mass, s.stiffness + s.shear, s.damping + s.shear_damping, s.displaced));
}
