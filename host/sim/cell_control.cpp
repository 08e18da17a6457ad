#include "sim/cell_control.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline sim {
namespace {

/// The strains of a move stop if a stress deviates from its target by more than this fraction.
constexpr double still = 0.02;
constexpr double min_strain = -10, strain_rounding = 1e-12;

template <class Action>
void for_each_set(const SetStress& set, const Action& action) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!std::isnan(set[axis])) action(axis);
}

double distance(const CellControl::State& state, const SetStress& set, std::size_t axis) {
    return std::abs(state.direction[axis].control.force - set[axis]) / set[axis];
}

}  // namespace

CellControl::CellControl(const Replica& replica, const PackingScale& scale)
    : control_(ForceControl::of_cell(replica, scale)) {
    const double lengths[]{replica.box.size_x, replica.box.size_y, replica.box.height};
    for (std::size_t axis = 0; axis < 3; ++axis) max_strain_[axis] = 1 - 2 * scale.reach / lengths[axis];
}

void CellControl::observe(State& state, const Mat3& stress, double duration) {
    for (int axis = 0; axis < 3; ++axis)
        ForceControl::observe(state.direction[static_cast<std::size_t>(axis)].control, stress(axis, axis),
                              duration);
}

void CellControl::begin_leg(State& state, const Strain& strain) {
    state.begin = strain;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        state.direction[axis].strain = strain[axis];
        state.direction[axis].begin = std::max(0.0, state.direction[axis].control.force);
    }
}

void CellControl::rest(State& state) {
    state.drive = 0;
    for (Direction& direction : state.direction) ForceControl::rest(direction.control);
}

/// The strains start slowly, so that they hardly change the stresses before these are controlled.
void CellControl::steer(State& state, const SetStress& set, double duration, double max_rate,
                        bool drives) const {
    for_each_set(set, [&](std::size_t axis) {
        control_.steer(state.direction[axis].control, set[axis], duration, max_rate);
    });
    if (!drives) return;
    const double off = distance(state, set, farthest(state, set)) / still;
    const double faster = state.drive + max_rate * std::min(1.0, duration / approach_time(state, set));
    state.drive = std::min(faster, max_rate * std::max(0.0, 1 - off));
}

Strain CellControl::rates(const State& state, const SetStress& set, double duration) const {
    Strain rates{};
    for_each_set(set, [&](std::size_t axis) {
        const double strain = state.direction[axis].strain;
        rates[axis] = std::clamp(-state.direction[axis].control.velocity, (min_strain - strain) / duration,
                                 std::max(0.0, max_strain_[axis] - strain) / duration);
    });
    return rates;
}

double CellControl::interval(const State& state, const SetStress& set) const {
    double shortest = HUGE_VAL;
    for_each_set(set, [&](std::size_t axis) {
        shortest = std::min(shortest, control_.interval(state.direction[axis].control, set[axis]));
    });
    return shortest;
}

double CellControl::drag(const State& state, const SetStress& set) const {
    double least = HUGE_VAL;
    for_each_set(set, [&](std::size_t axis) {
        least = std::min(least, control_.drag(state.direction[axis].control, set[axis]));
    });
    return state.drive > 0 ? 0 : least;
}

double CellControl::approach_time(const State& state, const SetStress& set) const {
    double longest = 0;
    for_each_set(set, [&](std::size_t axis) {
        longest = std::max(longest, control_.approach_time(state.direction[axis].control, set[axis]));
    });
    return longest;
}

bool CellControl::reached(const State& state, const SetStress& set) {
    bool all = true;
    for_each_set(set, [&](std::size_t axis) {
        all &= ForceControl::reached(state.direction[axis].control, set[axis]);
    });
    return all;
}

double CellControl::done(const State& state, const SetStress& target) {
    double way = 0, left = 0;
    for_each_set(target, [&](std::size_t axis) {
        const Direction& direction = state.direction[axis];
        way += std::abs(target[axis] - direction.begin);
        left += std::abs(target[axis] - direction.control.force);
    });
    return way > 0 ? 1 - left / way : 1;
}

double CellControl::change(const State& state, const SetStress& target) {
    double change = 0, all = 0;
    for_each_set(target, [&](std::size_t axis) {
        change += target[axis] - state.direction[axis].begin;
        all += target[axis];
    });
    return change / all;
}

std::size_t CellControl::farthest(const State& state, const SetStress& set) {
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
    for (const Direction& direction : state.direction)
        possible &= std::isfinite(direction.strain) && direction.strain < 1;
    return possible;
}

std::optional<std::size_t> CellControl::stuck(const State& state, const SetStress& set) const {
    std::optional<std::size_t> found;
    for_each_set(set, [&](std::size_t axis) {
        const Direction& direction = state.direction[axis];
        if (ForceControl::reached(direction.control, set[axis])) return;
        const bool shorter = direction.control.force < set[axis];
        if (shorter && direction.control.velocity < 0 &&
            direction.strain >= max_strain_[axis] - strain_rounding)
            found = axis;
        if (!shorter && direction.control.velocity > 0 && direction.strain <= min_strain + strain_rounding)
            found = axis;
    });
    return found;
}

}  // namespace mcdem::sim
