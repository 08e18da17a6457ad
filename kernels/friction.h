/* Tangential force of a contact. Three laws: saturated friction (Brodu et al. 2015), and a Mindlin spring cut
   at the Coulomb limit, which keeps its force or its displacement while the normal load changes. The effect
   `friction_history` uses a weighted mean of saturated friction and a spring. */

/* Parameters of a contact's friction; for rolling resistance in brackets. */
typedef struct {
    lanes limit;        /* mu F_n [N] (mu_r R* F_n [N m]) */
    lanes stiffness;    /* of the spring, k_t = 8 G* a [N/m] (8 G* a R*^2 [N m]) */
    lanes damping;      /* 2 sqrt(5/6) beta */
    lanes reduced_mass; /* m* [kg] (reduced moment of inertia [kg m2]) */
    lanes kept;         /* fraction of the spring's force that is left after the change of the normal load */
    Turn turn;          /* of the pair in this step */
    mask touching;
} SpringTerms;

/* Saturated friction: mu F_n against the sliding velocity. It is viscous below `sliding_velocity`, and its
   viscosity is at most a tenth of m* over dt, so that a time step cannot reverse the sliding. */
INLINE lanes3 saturated_friction(global const Replica* restrict replica, SpringTerms contact,
                                 lanes3 sliding) {
    const real slow = replica->sliding_velocity;
    const lanes inverse_speed = inverse_root(dot3(sliding, sliding) + slow * slow);
    const lanes max_viscosity = contact.reduced_mass * (R(0.1) / replica->time_step);
    return scale3(fmin(contact.limit * inverse_speed, max_viscosity), sliding);
}

/* Energy stored in a spring, f^2 / (2 k) [J]: of the tangential spring with its force and k_t, of the rolling
   spring with its couple and 8 G* a R*^2. Zero without stiffness, that is without contact. */
INLINE lanes spring_energy(lanes3 force, lanes stiffness) {
    const mask stiff = AS_MASK(stiffness > R(0));
    return WHERE(stiff, R(0.5) * dot3(force, force) / WHERE(stiff, stiffness, R(1)), R(0));
}

/* The fraction of a spring's force that is left when the contact radius changes from `*before` to `now`. The
   stiffness is proportional to the contact radius. A spring that keeps its force is unchanged while the load
   increases, and decreases with its stiffness when the load decreases (Thornton, Cummins & Cleary 2013,
   Powder Technology 233; LAMMPS: mindlin_rescale/force): then no change of load adds to its energy
   f^2 / (2 k). A spring that keeps its displacement changes with its stiffness both ways.

   Updates `*before`: the contact radius that the stiffness follows. In float it decreases only when the
   contact radius is SLACK below it. Otherwise rounding errors of positions, about 1e-4 of an overlap in every
   step, would wear forces away: each decrease takes a part of them, and no increase gives it back. */
#if MCDEM_DOUBLE
#define SLACK R(0)
#else
#define SLACK R(0.00048828125)
#endif
INLINE lanes kept_force(global const Replica* restrict replica, lanes now, lanes* restrict before) {
    const lanes followed = clamp(*before, now, (R(1) + SLACK) * now);
    const lanes ratio = followed / fmax(*before, (lanes)(R(1e-30)));
    *before = followed;
    return replica->mindlin == MINDLIN_DISPLACEMENT ? ratio : fmin(ratio, (lanes)(R(1)));
}

/* Turns the force (or couple) of a spring, which is perpendicular to the normal before the step, with its
   pair: first by the smallest rotation that takes that normal to the present one, then about the present
   normal. Errors are of seventh order in both angles. */
INLINE lanes3 turned(lanes3 force, lanes3 normal, Turn turn) {
    const lanes3 level = add_scaled3(force, -dot3(force, normal), turn.middle);
    const lanes square = turn.twist * turn.twist;
    const lanes cosine = R(1) - square * (R(0.5) - square * (R(1) / R(24) - square * (R(1) / R(720))));
    const lanes sine = turn.twist * (R(1) - square * (R(1) / R(6) - square * (R(1) / R(120))));
    return add_scaled3(scale3(cosine, level), sine, cross3(normal, level));
}

/* Spring with damping, cut at the limit; for friction it is the Mindlin spring. `sliding` is perpendicular to
   the normal. A slipping spring keeps the limit's share of its force; damping is not stored. Updates the
   spring's force `*spring`. `power`: mean of a step, by the mean of the spring's forces before and after it
   [W]. */
INLINE lanes3 cut_spring(SpringTerms contact, lanes3 sliding, lanes3 normal, real elapsed,
                         lanes3* restrict spring, lanes* restrict power) {
    const lanes damping = contact.damping * sqrt(contact.stiffness * contact.reduced_mass);
    const lanes3 before = turned(*spring, normal, contact.turn);
    const lanes3 f = add_scaled3(scale3(contact.kept, before), contact.stiffness * elapsed, sliding);
    const lanes3 full = add_scaled3(f, damping, sliding);
    const lanes inverse_size = inverse_root(fmax(dot3(full, full), (lanes)(R(1e-37))));
    const lanes cut = fmin(contact.limit * inverse_size, (lanes)(R(1)));
    *spring = scale3(WHERE(contact.touching, cut, R(0)), f);
    *power = R(0.5) * dot3(add3(before, *spring), sliding) + cut * damping * dot3(sliding, sliding);
    return scale3(cut, full);
}

/* Saturated friction, Mindlin friction, or with EFFECT_FRICTION_HISTORY their mean weighted by
   `mindlin_share`. `power`: of this force, as in cut_spring [W]. */
INLINE lanes3 friction(global const Replica* restrict replica, const int effects, SpringTerms contact,
                       lanes3 sliding, lanes3 normal, real elapsed, lanes3* restrict spring,
                       lanes* restrict power) {
    lanes3 with_history = ZERO3;
    if (replica->mindlin) with_history = cut_spring(contact, sliding, normal, elapsed, spring, power);
    if (replica->mindlin && !(effects & EFFECT_FRICTION_HISTORY)) return with_history;
    const lanes3 saturated = saturated_friction(replica, contact, sliding);
    const lanes saturated_power = dot3(saturated, sliding);
    *power = replica->mindlin ? saturated_power + replica->mindlin_share * (*power - saturated_power)
                              : saturated_power;
    if (!replica->mindlin) return saturated;
    return add_scaled3(saturated, replica->mindlin_share, subtract3(with_history, saturated));
}
