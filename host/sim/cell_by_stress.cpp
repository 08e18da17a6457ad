#include "sim/cell_by_stress.h"

#include <fmt/format.h>

#include <algorithm>

namespace mcdem::inline sim {
namespace {

SetStress end_stress(const RunningProgramme& programme) { return set_stress(programme.last_move()); }

/// Part of the change of stress in this move.
double stress_done(const RunningProgramme& programme) {
    const CellControl::State& cell = programme.state.cell;
    if (programme.stage().scan_at.empty()) return CellControl::done(cell, end_stress(programme));
    SetStress now;
    for (std::size_t axis = 0; axis < now.size(); ++axis) now[axis] = cell.stress(axis);
    const double begin = programme.quantity_begin();
    return (programme.quantity().mean(now) - begin) / (programme.quantity().target - begin);
}

/// Calls action(axis) for x, y, z and the shears with a prescribed stress: their strains are kept in the
/// state.
template <class Action>
void for_each_strain(const RunningProgramme& programme, const Action& action) {
    const SetStress set = end_stress(programme);
    for (std::size_t axis = 0; axis < set.size(); ++axis)
        if (axis < 3 || !std::isnan(set[axis])) action(axis);
}

}  // namespace

SetStress CellByStress::stress(const RunningProgramme& programme) const {
    SetStress set = end_stress(programme);
    if (programme.is_hold() || driven(programme) || !programme.protocol.stop_at_scans ||
        programme.waypoint_is_end())
        return set;
    for (std::size_t axis = 0; axis < set.size(); ++axis) {
        const double begin = programme.state.cell.direction[axis].begin;
        set[axis] = begin + programme.way_to_scan(programme.state.level + 1, set[axis] - begin);
    }
    return set;
}

Strain CellByStress::with_controlled(const RunningProgramme& programme, const Strain& strain) const {
    Strain all = strain;
    const SetStress set = end_stress(programme);
    for (std::size_t axis = 0; axis < set.size(); ++axis)
        if (!std::isnan(set[axis])) all[axis] = programme.state.cell.direction[axis].strain;
    return all;
}

/// The strains of the move change at the rate that the control has chosen for them.
ProgrammeMotion::Plan CellByStress::plan(const RunningProgramme& programme) const {
    const ProtocolState& now = programme.state;
    const SetStress set = stress(programme);
    double steps = controlled_steps(programme, control_.interval(now.cell, set)), part = 1;
    Plan plan;
    if (now.cell.drive > 0) {
        const double left = programme.waypoint() - now.plate_z;
        const WholeSteps needed =
            whole_steps(programme.protocol, left / (now.cell.drive * programme.time_step));
        if (needed.count <= steps) part = needed.part;
        plan.speed =
            needed.count <= steps ? left / (needed.count * part * programme.time_step) : now.cell.drive;
        steps = std::min(steps, needed.count);
    }
    StepInterval& interval = plan.interval;
    interval = in_part({static_cast<int>(steps), now.plate_z, 0, programme.drag(drag(programme))}, part);
    deform(programme, plan);
    const Strain rates = control_.rates(now.cell, set, interval.steps * part * programme.time_step);
    for (std::size_t axis = 0; axis < rates.size(); ++axis) interval.strain_rate[axis] += rates[axis];
    plan.fastest = std::abs(plan.speed);
    for_each_strain(programme, [&](std::size_t axis) {
        plan.fastest = std::max(plan.fastest, std::abs(interval.strain_rate[axis]));
    });
    return plan;
}

void CellByStress::follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                          double duration) const {
    ProtocolState& now = programme.state;
    for_each_strain(programme, [&](std::size_t axis) {
        now.cell.direction[axis].strain += plan.interval.strain_rate[axis] * duration;
    });
    CellByStrain::follow(programme, plan, result, duration);
    const SetStress set = stress(programme);
    now.reached_intervals = control_.reached(now.cell, set) ? now.reached_intervals + 1 : 0;
    control_.steer(
        now.cell, set, duration, slow_speed(programme),
        now.activity == Activity::move && driven(programme) && now.plate_z != programme.waypoint());
    if (const auto stuck = control_.stuck(now.cell, set))
        give_up(programme, *stuck,
                *stuck >= 3                             ? "a cell cannot be sheared further"
                : now.cell.direction[*stuck].strain < 0 ? "a cell cannot be stretched further"
                                                        : "grains would meet their own images");
}

/// With stops, the strains wait for the stresses: the directions with a prescribed stress stop with them, and
/// then continue separately.
bool CellByStress::arrived(RunningProgramme& programme) const {
    ProtocolState& now = programme.state;
    const bool stops = programme.protocol.stop_at_scans;
    if (driven(programme)) {
        const bool strained = CellByStrain::arrived(programme);
        if (strained && !stops) return true;
        if (strained && now.cell.drive > 0) {
            CellControl::rest(now.cell);
            now.reached_intervals = 0;
        }
        if (strained && now.reached_intervals >= enough_intervals) return true;
    } else {
        const bool passed = !stops && !programme.waypoint_is_end() &&
                            stress_done(programme) >= programme.way_to_scan(now.level + 1);
        if (passed || now.reached_intervals >= enough_intervals) return true;
    }
    expect_in_time(programme);
    return false;
}

bool CellByStress::reached(const RunningProgramme& programme) const {
    return control_.reached(programme.state.cell, stress(programme));
}

double CellByStress::drag(const RunningProgramme& programme) const {
    return control_.drag(programme.state.cell, stress(programme));
}

double CellByStress::progress(const RunningProgramme& programme) const {
    return driven(programme) ? CellByStrain::progress(programme) : programme.part_of_scans();
}

/// A hold continues with the stresses of the previous move.
void CellByStress::begin_leg(RunningProgramme& programme) const {
    begin_path(programme);
    if (programme.is_hold()) return;
    CellControl::rest(programme.state.cell);
    expect_listed_scans(programme);
    const double change = CellControl::change(programme.state.cell, end_stress(programme));
    if (std::abs(change) > min_change)
        programme.set_phase(change > 0);
    else if (driven(programme))
        programme.set_phase(programme.cell_move().loads());
}

void CellByStress::expect_in_time(RunningProgramme& programme) const {
    const ProtocolState& now = programme.state;
    const SetStress set = stress(programme);
    const QuasiStatic& limit = programme.quasi_static;
    const double slowest = limit.speed(max_speed(programme), 1, limit.min_pressure());
    const double way = std::max(1.0, programme.target() - now.leg_begin) / slowest;
    const double approach = control_.approach_time(now.cell, set);
    const long most =
        std::lround(patience * (way + programme.protocol.settle_time + approach) / programme.time_step);
    if (now.activity_step >= most)
        give_up(
            programme, control_.farthest(now.cell, set),
            fmt::format("after {:.3g} s it is still away from it", now.activity_step * programme.time_step));
}

void CellByStress::give_up(RunningProgramme& programme, std::size_t axis, const std::string& why) const {
    const bool shear = axis >= 3;
    const CellControl::State& cell = programme.state.cell;
    programme.give_up(fmt::format(
        "the {}stress {:.6g} Pa along {} cannot be reached: {} at a {} of {:.6g}, and the stress {:.6g} Pa "
        "(set stresses that the packing can bear, or take more grains)",
        shear ? "shear " : "", stress(programme)[axis], axis_names[axis], why, shear ? "shear" : "strain",
        cell.direction[axis].strain, cell.stress(axis)));
}

}  // namespace mcdem::sim
