#include "bench/step_cost.h"

namespace mcdem::bench {
namespace {

constexpr double slots = 16;
/// Slots that a CPU goes through: the most neighbours that one of 16 grains has.
constexpr double listed = 11;

// Flops. A square root, division, minimum or maximum counts as one operation; selections, comparisons and
// conversions do not count. The sums of each header, in the order of its lines:
constexpr double inverse_root = 6;  // estimate and a Newton step; elsewhere a root and a division
constexpr double gather_neighbours = 3 + 5 + 1 + inverse_root + 3 + 3;
constexpr double hertz = 2 + 2 + 2 + 2 + 2;  // gap, delta, a, S, F
constexpr double reduced = 12;               // R* and m*
constexpr double damping = 5 + 5;            // v_n, F_d
constexpr double own_displacement = 4;
constexpr double contact_point = 5 + 1;
constexpr double sliding = 9 + 18 + 2;  // both spins, v_t, limit
constexpr double saturated = 6 + inverse_root + 1 + 1 + 3;
constexpr double turn = 2 + 3 + 7 + 2 + 6;  // distance, spins, twist, half change, middle normal
constexpr double turned_spring =
    12 + 8 + 3 + 9 + 6;  // level, cosine and sine, cosine part, cross product, sine part
constexpr double kept_force = 6;
constexpr double mindlin = turn + turned_spring + kept_force + 2 + 3 + 3 + 7 + 6 + 12 + 2 + 6;
constexpr double force_and_torque = 6 + 18;
constexpr double checks = 2 + 1;
// Of a pair of slots, both displacements:
constexpr double half_space_pair =
    5 + 5 + inverse_root + 6 + 3 + 1 + 4;  // cosine, distance, its inverse, u . n, bracket, times F and sum
constexpr double sphere_pair =
    5 + 3 + inverse_root + 1 + 17 + 1 + 4;                  // cosine, s, root, s, polynomial, times F and sum
constexpr double finite_size_pair = 2 + 6 + 12 + 3 + 6;     // radius, spreads, polynomial, times F and sum
constexpr double self_term = 1 + 3 * (2 + 21 + 4 + 4 + 6);  // three Newton steps
constexpr double extrapolation = 1 + 5;
constexpr double integration = 85;  // per grain, 35 of them for the rotation

double surface_pair(ContactModel model) {
    switch (model) {
        case ContactModel::independent:
            return 0;
        case ContactModel::elastic_half_space:
        case ContactModel::mc_dem:
            return half_space_pair;
        case ContactModel::elastic_sphere:
        case ContactModel::hyperelastic_sphere:
            return sphere_pair + finite_size_pair;
        default:
            return sphere_pair;
    }
}

}  // namespace

StepCost step_cost(ContactModel model, FrictionLaw friction, Precision precision) {
    const double real = precision == Precision::double_precision ? 8 : 4;
    const bool bulging = model != ContactModel::independent;
    const bool springs = friction == FrictionLaw::mindlin;

    // Reals: position, velocity, spin and rotation are read and written (4 each), the listed position is
    // read. Per slot, the predicted displacement and those of two and four steps before are read, the next
    // prediction and this step's displacement are written; the three spring components and the contact radius
    // are read and written. Integers: partner, and partner slot if surfaces move. The values of neighbours
    // are read by the neighbours anyway and count as cached.
    const double reals = 2 * 4 * 4 + 4 + slots * ((bulging ? 5 : 0) + (springs ? 8 : 0));
    const double integers = slots * (bulging ? 2 : 1);

    const double friction_flops = springs ? mindlin : saturated;
    const bool sphere = model == ContactModel::elastic_sphere || model == ContactModel::hyperelastic_sphere;
    const double self = sphere ? self_term : 0;
    const double slot = gather_neighbours + hertz + reduced + damping + own_displacement + contact_point +
                        sliding + friction_flops + force_and_torque + checks + self +
                        (bulging ? extrapolation : 0);
    const double pairs = listed * (listed - 1) / 2;
    return {reals * real + integers * 4, listed * slot + pairs * surface_pair(model) + integration};
}

}  // namespace mcdem::bench
