// The protocol of cells: moves to strains and stresses, and holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/protocol.h"

namespace mcdem::inline sim {
namespace {

using Stage = ProtocolState::Stage;

/// A move with a smaller relative change of stresses is treated as keeping them.
constexpr double min_change = 1e-3;

/// The strains, with the current ones of the directions with a prescribed stress.
Strain with_controlled(Strain strain, const SetStress& set, const CellControl::State& cell) {
    for (std::size_t axis = 0; axis < set.size(); ++axis)
        if (!std::isnan(set[axis])) strain[axis] = cell.direction[axis].strain;
    return strain;
}

}  // namespace

bool ProtocolRunner::by_stress() const {
    return state_.stage != Stage::relax && controlled(stage()) == Controlled::stress;
}

/// Whether a move of a cell changes strains, with or without stresses.
bool ProtocolRunner::driven() const {
    return cell_ && stage().kind == StageKind::move && target() > state_.leg_begin;
}

const mcdem::Stage& ProtocolRunner::last_move() const {
    int leg = state_.leg;
    const auto stage_of = [&] { return stages_.begin() + legs_[static_cast<std::size_t>(leg)].stage; };
    while (leg > 0 && stage_of()->kind == StageKind::hold) --leg;
    return *stage_of();
}

SetStress ProtocolRunner::end_stress() const { return set_stress(last_move()); }

/// With stops, the stresses of the next scan if only stresses change; otherwise the target.
SetStress ProtocolRunner::stress() const {
    SetStress set = end_stress();
    if (stage().kind == StageKind::hold || driven() || !protocol_.stop_at_scans || waypoint_is_end())
        return set;
    for (std::size_t axis = 0; axis < set.size(); ++axis) {
        const double begin = state_.cell.direction[axis].begin;
        set[axis] = begin + scan_part(state_.level + 1, set[axis] - begin);
    }
    return set;
}

/// The quantity of the scans at the start of the move.
double ProtocolRunner::quantity_begin() const {
    if (!quantity().of_stress) return quantity().mean(state_.cell.begin);
    SetStress begin;
    for (std::size_t axis = 0; axis < begin.size(); ++axis) begin[axis] = state_.cell.direction[axis].begin;
    return quantity().mean(begin);
}

/// Part of a move at which a scan of its list is taken, 0 to 1.
double ProtocolRunner::listed_part(int scan) const {
    const double at = stage().scan_at[static_cast<std::size_t>(scan - 1)], begin = quantity_begin();
    if (at == quantity().target) return 1;
    return std::clamp((at - begin) / (quantity().target - begin), 0.0, 1.0);
}

double ProtocolRunner::scan_part(int scan, double way) const {
    return stage().scan_at.empty() ? way * scan / scans_of(stage()) : way * listed_part(scan);
}

/// Where a move starts may be known only now.
void ProtocolRunner::expect_listed_scans() {
    const double begin = quantity_begin(), end = quantity().target;
    for (const double at : stage().scan_at) {
        const double rounding = quantity().of_stress ? min_change * std::abs(at) : 0;
        if (at >= std::min(begin, end) - rounding && at <= std::max(begin, end) + rounding) continue;
        hindrance_ = fmt::format(
            "stage {} of the programme: there is no scan at {} = {:.6g}: the move goes from {:.6g} to {:.6g} "
            "(leave it out of scan_at)",
            leg().stage + 1, quantity_name(stage(), quantity()), at, begin, end);
        return stop();
    }
}

Strain ProtocolRunner::strain() const {
    if (!cell_) return {};
    return with_controlled(move().strain(state_.plate_z), by_stress() ? end_stress() : no_stress,
                           state_.cell);
}

void ProtocolRunner::deform(StepInterval& interval) const {
    interval.strain = strain();
    interval.strain_rate = move().direction();
    for (double& rate : interval.strain_rate) rate *= interval.plate_velocity;
    if (by_stress()) {
        const Strain rates =
            cell_->rates(state_.cell, stress(), interval.steps * interval.step_part * time_step_);
        for (std::size_t axis = 0; axis < rates.size(); ++axis) interval.strain_rate[axis] += rates[axis];
    }
    interval.plate_velocity = 0;
}

/// Its strain rates are set in deform().
StepInterval ProtocolRunner::planned_by_stress() const {
    double steps =
        std::clamp(std::floor(cell_->interval(state_.cell, stress()) / time_step_), 2.0, max_steps);
    if (state_.stage != Stage::move)
        steps = std::clamp(static_cast<double>(max_stage_steps() - state_.stage_step), 1.0, steps);
    double rate = 0, part = 1;
    if (state_.cell.drive > 0) {
        const double left = waypoint() - state_.plate_z;
        const Steps needed = steps_of_way(left / (state_.cell.drive * time_step_));
        if (needed.count <= steps) part = needed.part;
        rate = needed.count <= steps ? left / (needed.count * part * time_step_) : state_.cell.drive;
        steps = std::min(steps, needed.count);
    }
    return in_part({static_cast<int>(steps), state_.plate_z, rate, drag()}, part);
}

void ProtocolRunner::follow_stress(double duration) {
    const SetStress set = stress();
    const bool reached = cell_->reached(state_.cell, set);
    state_.reached_intervals = reached ? state_.reached_intervals + 1 : 0;
    cell_->steer(state_.cell, set, duration, quasi_static_.speed(max_speed(), 1, state_.pressure),
                 state_.stage == Stage::move && driven() && state_.plate_z != waypoint());
    if (const auto stuck = cell_->stuck(state_.cell, set))
        give_up(*stuck, *stuck >= 3                                ? "a cell cannot be sheared further"
                        : state_.cell.direction[*stuck].strain < 0 ? "a cell cannot be stretched further"
                                                                   : "grains would meet their own images");
}

/// When the strains stop, the directions with a prescribed stress stop too, and then continue separately.
bool ProtocolRunner::stresses_are_back() {
    if (state_.cell.drive > 0) {
        CellControl::rest(state_.cell);
        state_.reached_intervals = 0;
    }
    give_up_late();
    return state_.reached_intervals >= enough_intervals;
}

void ProtocolRunner::give_up(std::size_t direction, const std::string& why) {
    const bool shear = direction >= 3;
    hindrance_ = fmt::format(
        "stage {} of the programme: the {}stress {:.6g} Pa along {} cannot be reached: {} at a {} of {:.6g}, "
        "and the stress {:.6g} Pa (set stresses that the packing can bear, or take more grains)",
        leg().stage + 1, shear ? "shear " : "", stress()[direction], axis_names[direction], why,
        shear ? "shear" : "strain", state_.cell.direction[direction].strain, state_.cell.stress(direction));
    stop();
}

long ProtocolRunner::max_steps_by_stress() const {
    const double slowest = quasi_static_.speed(max_speed(), 1, quasi_static_.min_pressure());
    const double way = std::max(1.0, target() - state_.leg_begin) / slowest;
    const double approach = cell_->approach_time(state_.cell, stress());
    return std::lround(patience * (way + protocol_.settle_time + approach) / time_step_);
}

void ProtocolRunner::end_leg_of_cell() {
    const double end = target();
    const Strain strain = with_controlled(move().to, by_stress() ? end_stress() : no_stress, state_.cell);
    state_.leg_begin = end;
    CellControl::begin_leg(state_.cell, strain);
}

/// A hold continues with the stresses of the previous move.
void ProtocolRunner::begin_leg_of_cell() {
    if (state_.leg == 0) CellControl::begin_leg(state_.cell, {});
    if (!by_stress() || stage().kind != StageKind::hold) CellControl::rest(state_.cell);
    if (stage().kind == StageKind::hold) return;
    if (!stage().scan_at.empty()) expect_listed_scans();
    const double change = by_stress() ? CellControl::change(state_.cell, end_stress()) : 0;
    if (std::abs(change) > min_change)
        set_phase(change > 0);
    else if (driven())
        set_phase(move().loads());
}

/// Part of the change of stress in this move.
double ProtocolRunner::stress_done() const {
    if (stage().scan_at.empty()) return CellControl::done(state_.cell, end_stress());
    SetStress now;
    for (std::size_t axis = 0; axis < now.size(); ++axis) now[axis] = state_.cell.stress(axis);
    const double begin = quantity_begin();
    return (quantity().mean(now) - begin) / (quantity().target - begin);
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::moved_by_stress() {
    const bool passed =
        !protocol_.stop_at_scans && !waypoint_is_end() && stress_done() >= scan_part(state_.level + 1, 1);
    if (passed || state_.reached_intervals >= enough_intervals) return waypoint_reached();
    give_up_late();
    return std::nullopt;
}

void ProtocolRunner::give_up_late() {
    if (!by_stress() || state_.stage_step < max_stage_steps()) return;
    give_up(cell_->farthest(state_.cell, stress()),
            fmt::format("after {:.3g} s it is still away from it", state_.stage_step * time_step_));
}

}  // namespace mcdem::sim
