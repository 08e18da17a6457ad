#include "sim/energy_budget.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline sim {
namespace {

/// Energy that may seem to be created, over the largest stored energy. Where the stored energy is a potential
/// of the forces, rounding and the steps make up to 1e-4 (measured with one grain, rows, crystals and
/// packings of 514 grains in float). In the models of the half space it is an approximation: up to 0.04.
constexpr double exact_tolerance = 0.01, rough_tolerance = 0.3;
/// The step is shortened when this part of the tolerance is reached.
constexpr double first_sign = 0.4;
/// Coordinates of a packing in float are rounded to about 1e-6 of a radius, which is 1 % of the energy of
/// overlaps of 3e-4 of a radius: 1e-9 E R^3 a grain. E is that of the stiffest grains: their contacts round
/// most.
constexpr double least_energy = 1e-9;

double tolerance_of(const Replica& replica) {
    const ContactModel model = replica.contact.model;
    const Effects& e = replica.effects;
    // The forces of these contacts have no exact potential.
    if (e.viscoelasticity > 0 || e.plasticity > 0 || e.adhesion > 0 || e.cohesion > 0 ||
        e.bulge_contacts != 1)
        return HUGE_VAL;
    const bool half_space = model == ContactModel::elastic_half_space || model == ContactModel::mc_dem;
    return half_space || e.stiffening != 0 ? rough_tolerance : exact_tolerance;
}

}  // namespace

EnergyBudget::EnergyBudget(const Replica& replica, const PackingScale& scale)
    : tolerance_(tolerance_of(replica)),
      least_energy_(least_energy * static_cast<double>(scale.count) * plane_modulus(stiffest(replica)) *
                    std::pow(scale.diameter / 2, 3)) {}

void EnergyBudget::add(const IntervalResult& result) {
    State& s = state_;
    const double stored = result.kinetic_energy + result.elastic_energy;
    if (s.begun == 0) {
        s.begun = 1;
        s.stored_at_start = stored;
        s.springs_at_start = result.spring_energy;
    } else {
        s.terms.wall_work += result.work;
        s.terms.weight_work += result.weight_work;
        s.terms.damping_loss += result.damped;
        s.rubbed += result.rubbed;
        s.terms.drag_loss += result.dragged;
    }
    s.terms.friction_loss = s.rubbed - (result.spring_energy - s.springs_at_start);
    s.dissipated = s.terms.wall_work + s.terms.weight_work - (stored - s.stored_at_start);
    s.terms.energy_error = s.terms.damping_loss + s.terms.friction_loss + s.terms.drag_loss - s.dissipated;
    s.most_dissipated = std::max(s.most_dissipated, s.dissipated);
    s.most_stored = std::max({s.most_stored, stored, least_energy_});
}

double EnergyBudget::created() const {
    const State& s = state_;
    return s.most_stored > 0 ? (s.created + s.most_dissipated - s.dissipated) / s.most_stored : 0;
}

EnergyBudget::Verdict EnergyBudget::verdict() const {
    const State& s = state_;
    if (!(created() <= tolerance_)) return Verdict::too_much_created;
    const bool falls = s.most_dissipated - s.dissipated > first_sign * tolerance_ * s.most_stored;
    return falls ? Verdict::creates_energy : Verdict::sound;
}

void EnergyBudget::correct() {
    state_.created += state_.most_dissipated - state_.dissipated;
    state_.most_dissipated = state_.dissipated;
}

bool EnergyBudget::is_possible(const State& s) {
    return std::isfinite(s.dissipated) && s.most_dissipated >= s.dissipated && s.created >= 0 &&
           (s.begun == 0 || s.begun == 1);
}

}  // namespace mcdem::sim
