#include "sim/cell_control.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline sim {
namespace {

/// The strains of a move stop if a stress deviates from its target by more than this fraction.
constexpr double still = 0.02;
constexpr double min_strain = -10, max_shear = 5, strain_rounding = 1e-12;
/// A shear stress is controlled within the tolerance of at least this fraction of the mean stress.
constexpr double min_shear_scale = 0.1;

constexpr bool is_shear(std::size_t axis) { return axis >= 3; }
/// A positive shear needs a negative shear stress. Controllers expect that the stress grows with the strain.
constexpr double sign(std::size_t axis) { return is_shear(axis) ? -1 : 1; }

template <class Action>
void for_each_set(const SetStress& set, const Action& action) {
    for (std::size_t axis = 0; axis < set.size(); ++axis)
        if (!std::isnan(set[axis])) action(axis);
}

/// The stresses along x, y and z.
SetStress normal(SetStress set) {
    std::fill(set.begin() + 3, set.end(), not_given);
    return set;
}

double mean_stress(const CellControl::State& state) {
    return (state.stress(0) + state.stress(1) + state.stress(2)) / 3;
}

}  // namespace

double CellControl::State::stress(std::size_t axis) const {
    return sign(axis) * direction[axis].control.force;
}

CellControl::CellControl(const Replica& replica, const PackingScale& scale)
    : control_(ForceControl::of_cell(replica, scale)), min_load_(QuasiStatic(replica, scale).min_pressure()) {
    max_strain_.fill(max_shear);
    min_strain_.fill(-max_shear);
    const double lengths[]{replica.box.size_x, replica.box.size_y, replica.box.height};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        max_strain_[axis] = 1 - 2 * scale.reach / lengths[axis];
        min_strain_[axis] = min_strain;
    }
}

/// The stiffness against shear is that of the load on the packing. Shear stresses are the symmetric part of
/// the tensor.
ForceControl::Target CellControl::target(const State& state, const SetStress& set, std::size_t axis) const {
    ForceControl::Target target(sign(axis) * set[axis]);
    if (is_shear(axis)) {
        target.load = std::max({min_load_, mean_stress(state), std::abs(set[axis])});
        target.scale = std::max(std::abs(set[axis]), min_shear_scale * target.load);
    }
    return target;
}

/// Deviation from a prescribed stress, relative to it; that of a shear stress relative to the load.
double CellControl::distance(const State& state, const SetStress& set, std::size_t axis) const {
    const ForceControl::Target to = target(state, set, axis);
    return std::abs(state.direction[axis].control.force - to.set) / std::max(to.scale, to.load);
}

double CellControl::farthest_distance(const State& state, const SetStress& set) const {
    double most = 0;
    for_each_set(set, [&](std::size_t axis) { most = std::max(most, distance(state, set, axis)); });
    return most;
}

void CellControl::observe(State& state, const Mat3& stress, double duration) {
    const double now[]{stress(0, 0),
                       stress(1, 1),
                       stress(2, 2),
                       (stress(0, 1) + stress(1, 0)) / 2,
                       (stress(0, 2) + stress(2, 0)) / 2,
                       (stress(1, 2) + stress(2, 1)) / 2};
    for (std::size_t axis = 0; axis < state.direction.size(); ++axis)
        ForceControl::observe(state.direction[axis].control, sign(axis) * now[axis], duration);
}

void CellControl::begin_leg(State& state, const Strain& strain) {
    state.begin = strain;
    for (std::size_t axis = 0; axis < strain.size(); ++axis) {
        state.direction[axis].strain = strain[axis];
        state.direction[axis].begin = is_shear(axis) ? state.stress(axis) : std::max(0.0, state.stress(axis));
    }
}

void CellControl::rest(State& state) {
    state.drive = 0;
    for (Direction& direction : state.direction) ForceControl::rest(direction.control);
}

/// The strains start slowly, so that they hardly change the stresses before these are controlled. A packing
/// resists shear only under pressure, so shear stresses wait until the other stresses are reached.
void CellControl::steer(State& state, const SetStress& set, double duration, double max_rate,
                        bool drives) const {
    const double bears = std::max(0.0, 1 - farthest_distance(state, normal(set)) / still);
    for_each_set(set, [&](std::size_t axis) {
        control_.steer(state.direction[axis].control, target(state, set, axis), duration,
                       is_shear(axis) ? bears * max_rate : max_rate);
    });
    if (!drives) return;
    const double off = farthest_distance(state, set) / still;
    const double faster = state.drive + max_rate * std::min(1.0, duration / approach_time(state, set));
    state.drive = std::min(faster, max_rate * std::max(0.0, 1 - off));
}

Strain CellControl::rates(const State& state, const SetStress& set, double duration) const {
    Strain rates{};
    for_each_set(set, [&](std::size_t axis) {
        const double strain = state.direction[axis].strain;
        rates[axis] =
            std::clamp(-state.direction[axis].control.velocity, (min_strain_[axis] - strain) / duration,
                       std::max(0.0, max_strain_[axis] - strain) / duration);
    });
    return rates;
}

double CellControl::interval(const State& state, const SetStress& set) const {
    double shortest = HUGE_VAL;
    for_each_set(set, [&](std::size_t axis) {
        shortest =
            std::min(shortest, control_.interval(state.direction[axis].control, target(state, set, axis)));
    });
    return shortest;
}

double CellControl::drag(const State& state, const SetStress& set) const {
    double least = HUGE_VAL;
    for_each_set(set, [&](std::size_t axis) {
        least = std::min(least, control_.drag(state.direction[axis].control, target(state, set, axis)));
    });
    return state.drive > 0 ? 0 : least;
}

double CellControl::approach_time(const State& state, const SetStress& set) const {
    double longest = 0;
    for_each_set(set, [&](std::size_t axis) {
        longest = std::max(longest,
                           control_.approach_time(state.direction[axis].control, target(state, set, axis)));
    });
    return longest;
}

bool CellControl::reached(const State& state, const SetStress& set) const {
    bool all = true;
    for_each_set(set, [&](std::size_t axis) {
        all &= ForceControl::reached(state.direction[axis].control, target(state, set, axis));
    });
    return all;
}

double CellControl::done(const State& state, const SetStress& target) {
    double way = 0, left = 0;
    for_each_set(target, [&](std::size_t axis) {
        const Direction& direction = state.direction[axis];
        way += std::abs(target[axis] - direction.begin);
        left += std::abs(target[axis] - state.stress(axis));
    });
    return way > 0 ? 1 - left / way : 1;
}

double CellControl::change(const State& state, const SetStress& target) {
    double change = 0, all = 0;
    for_each_set(target, [&](std::size_t axis) {
        const double begin = std::abs(state.direction[axis].begin), end = std::abs(target[axis]);
        change += end - begin;
        all += is_shear(axis) ? std::max(begin, end) : end;
    });
    return all > 0 ? change / all : 0;
}

std::size_t CellControl::farthest(const State& state, const SetStress& set) const {
    std::size_t farthest = 0;
    double most = -1;
    for_each_set(set, [&](std::size_t axis) {
        const double here = distance(state, set, axis);
        if (here > most) most = here, farthest = axis;
    });
    return farthest;
}

bool CellControl::is_possible(const State& state) {
    bool possible = std::isfinite(state.drive);
    for (std::size_t k = 0; k < state.begin.size(); ++k)
        possible &= std::isfinite(state.begin[k]) && (k >= 3 || state.begin[k] < 1);
    for (std::size_t axis = 0; axis < state.direction.size(); ++axis)
        possible &= ForceControl::is_possible(state.direction[axis].control) &&
                    std::isfinite(state.direction[axis].strain) &&
                    (is_shear(axis) || state.direction[axis].strain < 1);
    return possible;
}

std::optional<std::size_t> CellControl::stuck(const State& state, const SetStress& set) const {
    std::optional<std::size_t> found;
    for_each_set(set, [&](std::size_t axis) {
        const Direction& direction = state.direction[axis];
        const ForceControl::Target to = target(state, set, axis);
        if (ForceControl::reached(direction.control, to)) return;
        const bool shorter = direction.control.force < to.set;
        if (shorter && direction.control.velocity < 0 &&
            direction.strain >= max_strain_[axis] - strain_rounding)
            found = axis;
        if (!shorter && direction.control.velocity > 0 &&
            direction.strain <= min_strain_[axis] + strain_rounding)
            found = axis;
    });
    return found;
}

}  // namespace mcdem::sim
