#include "sim/running_programme.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/container.h"

namespace mcdem::inline sim {
namespace {

/// The integrator removes drag * time step of a velocity per step. When the plate stops, motion ends at once;
/// before the first stroke, grains still have to settle under gravity.
constexpr double max_drag = 0.5, max_relax_drag = 0.02;
/// Distance from the grains, over their diameter, above which the plate moves at its maximum speed.
constexpr double free_distance = 0.1;
/// Weight of an interval's pressure in the moving average, so that waves in the packing do not affect the
/// plate.
constexpr double pressure_share = 0.2;

}  // namespace

RunningProgramme::RunningProgramme(const Replica& replica, double time_step, const PackingScale& scale)
    : plate(replica.plate),
      protocol(replica.protocol),
      stages(stages_of(replica)),
      legs(legs_of(stages, plate)),
      is_cell(mcdem::is_cell(replica.box)),
      clearance(scale.weight > 0 ? free_distance * scale.diameter : HUGE_VAL),
      time_step(time_step),
      max_time_step(time_step),
      expected(expected_run(replica, scale, time_step)),
      quasi_static(replica, scale) {
    const auto lists = [](const Stage& stage) { return !stage.scan_at.empty(); };
    if (is_cell && std::ranges::any_of(stages, lists)) quantities = scan_quantities(stages, legs);
    state.plate_z = is_cell ? 0 : plate.start;
    state.pressure = quasi_static.min_pressure();
    state.free_above = scale.top + clearance;
}

const Leg* RunningProgramme::move_before(Controlled quantity) const {
    const bool moved = was_controlled(quantity) && stage_of(state.leg - 1).kind != StageKind::hold;
    return moved ? &legs[static_cast<std::size_t>(state.leg - 1)] : nullptr;
}

const Stage& RunningProgramme::last_move() const {
    int last = state.leg;
    while (last > 0 && stage_of(last).kind == StageKind::hold) --last;
    return stage_of(last);
}

double RunningProgramme::quantity_begin() const {
    if (!quantity().of_stress) return quantity().mean(state.cell.begin);
    SetStress begin;
    for (std::size_t axis = 0; axis < begin.size(); ++axis) begin[axis] = state.cell.direction[axis].begin;
    return quantity().mean(begin);
}

double RunningProgramme::way_to_scan(int number, double way) const {
    if (stage().scan_at.empty()) return way * number / scans_of(stage());
    const double at = stage().scan_at[static_cast<std::size_t>(number - 1)], begin = quantity_begin();
    if (at == quantity().target) return way;
    return way * std::clamp((at - begin) / (quantity().target - begin), 0.0, 1.0);
}

double RunningProgramme::level_value(int number) const {
    if (!is_cell || stage().scan_at.empty())
        return scan_level(stage(), number, state.leg_begin, target(), plate);
    const double part = way_to_scan(number), end = target();
    return part == 1 ? end : state.leg_begin + part * (end - state.leg_begin);
}

double RunningProgramme::waypoint() const {
    return state.level < scans_of(stage()) ? level_value(state.level + 1) : target();
}

bool RunningProgramme::waypoint_is_end() const {
    const int scans = scans_of(stage());
    if (state.level + 1 != scans) return state.level >= scans;
    if (stage().scan_at.empty()) return true;
    return is_cell ? way_to_scan(scans) == 1 : level_value(scans) == target();
}

bool RunningProgramme::holds() const {
    return protocol.hold > 0 && leg().target < state.leg_begin && waypoint_is_end();
}

long RunningProgramme::max_standing_steps() const {
    if (state.activity == Activity::relax) return std::lround(protocol.relax_time / time_step);
    if (state.activity == Activity::settle)
        return std::lround((pauses() ? standing_time() : protocol.settle_time) / time_step);
    const int next = state.level + 1;
    const double until = next > scans_of(stage()) ? stage().time : scan_time(stage(), next);
    return state.activity_step + std::lround((state.hold_begin + until - state.time) / time_step);
}

double RunningProgramme::drag(double wanted) const {
    const bool relaxes = state.activity == Activity::relax;
    if (pauses() || (relaxes && protocol.relax_time == 0)) return 0;
    return std::min({wanted, protocol.settle_drag, (relaxes ? max_relax_drag : max_drag) / max_time_step});
}

void RunningProgramme::begin(Activity activity) {
    state.activity = activity;
    state.activity_step = 0;
    state.settled_intervals = state.reached_intervals = 0;
    if (state.cell.drive > 0) CellControl::rest(state.cell);
}

void RunningProgramme::set_phase(bool load) {
    if (load && state.phase == Phase::unload) ++state.cycle;
    state.phase = load ? Phase::load : Phase::unload;
}

void RunningProgramme::add_pressure(double pressure) {
    state.pressure += pressure_share * (pressure - state.pressure);
}

void RunningProgramme::give_up(const std::string& why) {
    hindrance = fmt::format("stage {} of the programme: {}", leg().stage + 1, why);
    state.activity = Activity::finished;
}

}  // namespace mcdem::sim
