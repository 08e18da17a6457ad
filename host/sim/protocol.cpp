#include "sim/protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/container.h"

namespace mcdem::inline sim {
namespace {

using Stage = ProtocolState::Stage;

/// Weight of an interval's pressure in the moving average, so that waves in the packing do not affect the
/// plate.
constexpr double pressure_share = 0.2;
/// The integrator removes drag * time step of a velocity per step. When the plate stops, motion ends at once;
/// before the first stroke, grains still have to settle under gravity.
constexpr double max_drag = 0.5, max_relax_drag = 0.02;
/// A plate that pauses has constant velocities in this number of intervals of the way between two scans.
constexpr double intervals_of_way = 64;
/// Distance from the grains, over their diameter, above which the plate moves at its maximum speed.
constexpr double free_distance = 0.1;
/// Within this distance of a level, relative to the plate's start or a strain of one, the plate has arrived.
constexpr double position_rounding = 1e-12;

double force_along_z(const IntervalResult& result, Wall wall) {
    return result.wall_force[static_cast<std::size_t>(wall)].z();
}
}  // namespace

ProtocolRunner::ProtocolRunner(const Replica& replica, double time_step, const PackingScale& scale)
    : plate_(replica.plate),
      protocol_(replica.protocol),
      stages_(stages_of(replica)),
      legs_(legs_of(stages_, plate_)),
      cell_(is_cell(replica.box) ? std::optional(CellControl(replica, scale)) : std::nullopt),
      clearance_(scale.weight > 0 ? free_distance * scale.diameter : HUGE_VAL),
      scale_(cell_ ? 1 : plate_.start),
      time_step_(time_step),
      max_time_step_(time_step),
      quasi_static_(replica, scale),
      force_control_(ForceControl::of_plate(replica, scale)) {
    const auto lists = [](const mcdem::Stage& stage) { return !stage.scan_at.empty(); };
    if (cell_ && std::ranges::any_of(stages_, lists)) quantities_ = scan_quantities(stages_, legs_);
    state_.plate_z = cell_ ? 0 : plate_.start;
    state_.pressure = quasi_static_.pressure(0, 0);
    state_.free_above = scale.top + clearance_;
}

bool ProtocolRunner::by_force() const {
    return state_.stage != Stage::relax && controlled(stage()) == Controlled::force;
}

/// With stops, the target of the next scan; otherwise that of the move.
double ProtocolRunner::set_force() const {
    if (stage().kind == StageKind::hold) return state_.leg_begin;
    return protocol_.stop_at_scans ? waypoint() : leg().target;
}

double ProtocolRunner::max_speed() const {
    if (cell_) return last_move().rate;
    return std::isnan(stage().speed) ? plate_.speed : stage().speed;
}

/// Levels of the scans of a move.
double ProtocolRunner::level_value(int level) const {
    if (!cell_ || stage().scan_at.empty())
        return scan_level(stage(), level, state_.leg_begin, target(), plate_);
    const double part = listed_part(level), end = target();
    return part == 1 ? end : state_.leg_begin + part * (end - state_.leg_begin);
}

/// Position of the next scan, or the end of the move.
double ProtocolRunner::waypoint() const {
    return state_.level < scans_of(stage()) ? level_value(state_.level + 1) : target();
}

bool ProtocolRunner::waypoint_is_end() const {
    const int scans = scans_of(stage());
    if (state_.level + 1 != scans) return state_.level >= scans;
    if (stage().scan_at.empty()) return true;
    return cell_ ? listed_part(scans) == 1 : level_value(scans) == target();
}

/// Time from the start of the hold to its next scan or its end [s].
double ProtocolRunner::hold_time() const {
    const int next = state_.level + 1;
    return next > scans_of(stage()) ? stage().time : scan_time(stage(), next);
}

long ProtocolRunner::max_stage_steps() const {
    if (state_.stage == Stage::relax) return std::lround(protocol_.relax_time / time_step_);
    if (state_.stage == Stage::settle)
        return std::lround((pauses() ? standing_time() : protocol_.settle_time) / time_step_);
    if (state_.stage == Stage::hold)
        return state_.stage_step + std::lround((state_.hold_begin + hold_time() - state_.time) / time_step_);
    if (cell_) return max_steps_by_stress();
    const double slowest = quasi_static_.speed(max_speed(), plate_.start, quasi_static_.min_pressure());
    const double way = (plate_.start - plate_.end) / slowest;
    return std::lround(
        patience * (way + protocol_.settle_time + force_control_.approach_time(state_.control, set_force())) /
        time_step_);
}

/// Whole steps for the way to the next scan, `way_in_steps` at full speed. Without a tolerance this speed is
/// prescribed, up to 0.1 %, so the steps are shorter; otherwise it is a maximum.
ProtocolRunner::Steps ProtocolRunner::steps_of_way(double way_in_steps) const {
    const double count = std::max(1.0, std::ceil(way_in_steps - 1e-9)), part = way_in_steps / count;
    return {count, protocol_.rate_tolerance == 0 && part > 0 && part < 0.999 ? part : 1};
}

/// The plate ends a move exactly at the scan position. On its way down it slows down before the grains.
StepInterval ProtocolRunner::planned() const {
    if (by_force()) return planned_by_force();
    if (by_stress()) return planned_by_stress();
    if (state_.stage != Stage::move) {
        const long left = std::max(1L, max_stage_steps() - state_.stage_step);
        return {static_cast<int>(std::min<double>(left, max_steps)), state_.plate_z, 0, drag()};
    }
    if (is_smooth()) return planned_smoothly();
    const double left = waypoint() - state_.plate_z;
    const double step = time_step_ * (is_free() ? max_speed() : slow_speed());
    const double most =
        is_free() && left < 0 ? std::ceil((state_.plate_z - state_.free_above) / step) : max_steps;
    const auto [steps, part] = steps_of_way(std::abs(left) / step);
    return in_part({static_cast<int>(std::min({steps, most, max_steps})), state_.plate_z,
                    left / (steps * part * time_step_)},
                   part);
}

/// The velocity is half a sine over each way, which takes as long as at constant speed.
StepInterval ProtocolRunner::planned_smoothly() const {
    const double from = state_.level == 0 ? state_.leg_begin : level_value(state_.level);
    const double way = waypoint() - from, speed = is_free() ? max_speed() : slow_speed();
    const double at_speed = std::abs(way) / (speed * time_step_), part = steps_of_way(at_speed).part;
    const double all_steps = at_speed / part, time_step = part * time_step_;
    const double passed = std::clamp((state_.plate_z - from) / way, 0.0, 1.0);
    const double time = std::acos(1 - 2 * passed) / std::numbers::pi;  // over that of the way
    const double left = std::max(1.0, std::ceil((1 - time) * all_steps - 1e-9));
    const double steps = std::min({left, std::ceil(all_steps / intervals_of_way), max_steps});
    const double next = (1 - std::cos(std::numbers::pi * (time + steps / all_steps))) / 2;
    const double to = steps < left ? from + next * way : waypoint();
    return in_part({static_cast<int>(steps), state_.plate_z, (to - state_.plate_z) / (steps * time_step)},
                   part);
}

/// The plate stays between plate.end and plate.start.
StepInterval ProtocolRunner::planned_by_force() const {
    double steps = std::clamp(std::floor(force_control_.interval(state_.control, set_force()) / time_step_),
                              2.0, max_steps);
    if (state_.stage != Stage::move)
        steps = std::clamp(static_cast<double>(max_stage_steps() - state_.stage_step), 1.0, steps);
    const double duration = steps * time_step_;
    const double velocity = std::clamp(state_.control.velocity, (plate_.end - state_.plate_z) / duration,
                                       (plate_.start - state_.plate_z) / duration);
    return {static_cast<int>(steps), state_.plate_z, velocity, drag()};
}

/// Whether the plate stands still as in an experiment, without any settling.
bool ProtocolRunner::pauses() const { return state_.stage == Stage::settle && standing_time() > 0; }

/// Whether the plate is held where the current move ends.
bool ProtocolRunner::holds() const {
    return protocol_.hold > 0 && leg().target < state_.leg_begin && waypoint_is_end();
}

double ProtocolRunner::standing_time() const { return holds() ? protocol_.hold : protocol_.pause; }

/// Speed of a plate that touches grains, or rate of a cell. A plate that pauses moves as that of an
/// experiment, which does not wait.
double ProtocolRunner::slow_speed() const {
    const double speed = quasi_static_.speed(max_speed(), rate_length(), state_.pressure);
    const bool waits = !cell_ && protocol_.pause == 0;
    return waits ? speed * quasi_static_.slowing(state_.kinetic_energy, speed) : speed;
}

/// Whether the plate starts and stops smoothly, because it pauses at the next scan.
bool ProtocolRunner::is_smooth() const {
    return protocol_.stop_at_scans && protocol_.pause > 0 && state_.level < scans_of(stage()) &&
           state_.plate_z != waypoint();
}

double ProtocolRunner::drag() const {
    const bool does_not_relax = state_.stage == Stage::relax && protocol_.relax_time == 0;
    if (pauses() || does_not_relax) return 0;
    const double wanted = by_force()    ? force_control_.drag(state_.control, set_force())
                          : by_stress() ? cell_->drag(state_.cell, stress())
                                        : HUGE_VAL;
    return std::min({wanted, protocol_.settle_drag,
                     (state_.stage == Stage::relax ? max_relax_drag : max_drag) / max_time_step_});
}

void ProtocolRunner::take_note(const IntervalResult& result) {
    StepInterval interval = planned();
    const double velocity = interval.plate_velocity, step = interval.step_part * time_step_;
    const double duration = step * result.steps;
    double fastest = std::abs(velocity);
    if (by_stress()) {
        deform(interval);
        const SetStress set = stress();
        for (std::size_t axis = 0; axis < set.size(); ++axis) {
            if (axis >= 3 && std::isnan(set[axis])) continue;
            state_.cell.direction[axis].strain += interval.strain_rate[axis] * duration;
            fastest = std::max(fastest, std::abs(interval.strain_rate[axis]));
        }
    }
    state_.step += result.steps;
    state_.stage_step += result.steps;
    state_.time += duration;
    const double plate = force_along_z(result, Wall::plate);
    if (state_.stage == Stage::move)
        state_.rate_error =
            is_free() && plate == 0 ? 0 : quasi_static_.rate_error(fastest, rate_length(), state_.pressure);
    state_.plate_z += velocity * step * result.steps;
    if (plate != 0) state_.free_above = state_.plate_z + clearance_;
    const double pressure = cell_ ? quasi_static_.pressure(result.stress)
                                  : quasi_static_.pressure(plate, force_along_z(result, Wall::floor));
    state_.pressure += pressure_share * (pressure - state_.pressure);
    state_.kinetic_energy = result.kinetic_energy;
    ForceControl::observe(state_.control, plate, duration);
    if (by_force()) follow_force(duration);
    if (cell_) CellControl::observe(state_.cell, result.stress, duration);
    if (by_stress()) follow_stress(duration);
}

void ProtocolRunner::follow_force(double duration) {
    const double set = set_force();
    const bool reached = ForceControl::reached(state_.control, set);
    state_.reached_intervals = reached ? state_.reached_intervals + 1 : 0;
    force_control_.steer(state_.control, set, duration,
                         quasi_static_.speed(max_speed(), state_.plate_z, state_.pressure));
    const double edge = position_rounding * plate_.start;
    const bool at_end = state_.plate_z <= plate_.end + edge && state_.control.force < set,
               at_start = state_.plate_z >= plate_.start - edge && state_.control.force > set;
    const bool stuck = (at_end && state_.control.velocity < 0) || (at_start && state_.control.velocity > 0);
    if (!reached && stuck)
        give_up(fmt::format("the plate is at {} = {}", at_end ? "plate.end" : "plate.start",
                            at_end ? plate_.end : plate_.start));
}

void ProtocolRunner::give_up(const std::string& why) {
    hindrance_ = fmt::format(
        "stage {} of the programme: the force {:.6g} N cannot be reached: {}, and the force {:.6g} N (set a "
        "force that the packing can bear there, or move plate.end or plate.start)",
        leg().stage + 1, set_force(), why, state_.control.force);
    stop();
}

/// Whether net forces are small. The drag is so strong that velocities are determined by the net forces.
bool ProtocolRunner::settled(const IntervalResult& result, double drag, bool plate_arrived) {
    const double unbalanced = quasi_static_.unbalanced_force(result.kinetic_energy, drag, state_.pressure);
    const bool still = plate_arrived && unbalanced <= protocol_.settle_unbalanced_force &&
                       (!by_force() || ForceControl::reached(state_.control, set_force())) &&
                       (!by_stress() || cell_->reached(state_.cell, stress()));
    state_.settled_intervals = still ? state_.settled_intervals + 1 : 0;
    return state_.settled_intervals >= enough_intervals;
}

void ProtocolRunner::begin(Stage stage) {
    state_.stage = stage;
    state_.stage_step = 0;
    state_.settled_intervals = state_.reached_intervals = 0;
    if (state_.cell.drive > 0) CellControl::rest(state_.cell);
}

void ProtocolRunner::begin_leg() {
    state_.level = 0;
    state_.hold_begin = state_.time;
    begin(stage().kind == StageKind::hold ? Stage::hold : Stage::move);
    if (cell_) return begin_leg_of_cell();
    const Leg* before = state_.leg > 0 ? &legs_[static_cast<std::size_t>(state_.leg - 1)] : nullptr;
    const mcdem::Stage* last = before ? &stages_[static_cast<std::size_t>(before->stage)] : nullptr;
    const bool alike = last && controlled(*last) == controlled(stage());
    if (alike && last->kind != StageKind::hold)
        state_.leg_begin = before->target;
    else if (!alike || !by_force())
        state_.leg_begin = by_force() ? state_.control.force : state_.plate_z;
    const bool goes_on = alike && by_force() && stage().kind == StageKind::hold;
    if (!goes_on) ForceControl::rest(state_.control);
    if (by_force() && stage().kind == StageKind::hold && !(state_.leg_begin > 0))
        return give_up("no grain presses on the plate");
    if (stage().kind == StageKind::hold || leg().target == state_.leg_begin) return;
    set_phase((leg().target > state_.leg_begin) == by_force());
}

void ProtocolRunner::set_phase(bool load) {
    if (load && state_.phase == Phase::unload) ++state_.cycle;
    state_.phase = load ? Phase::load : Phase::unload;
}

void ProtocolRunner::next_leg() {
    if (state_.leg + 1 == static_cast<int>(legs_.size())) return stop();
    if (cell_) end_leg_of_cell();
    ++state_.leg;
    begin_leg();
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::on_interval_done(const IntervalResult& result,
                                                                        bool plate_arrived) {
    if (finished()) return std::nullopt;
    const double drag_before = drag();
    take_note(result);
    if (finished()) return std::nullopt;
    if (state_.stage == Stage::move)
        return by_force() ? moved_by_force() : by_stress() && !driven() ? moved_by_stress() : moved();
    const bool still = settled(result, drag_before, plate_arrived);
    if (state_.stage == Stage::hold) return held(still);
    if ((!still || pauses()) && state_.stage_step < max_stage_steps()) return std::nullopt;
    if (state_.stage == Stage::settle) return arrive(still);
    begin_leg();
    if (!protocol_.scan_at_start) return std::nullopt;
    return tag(0, still);
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::moved() {
    if (std::abs(waypoint() - state_.plate_z) > position_rounding * scale_) {
        give_up_late();
        return std::nullopt;
    }
    state_.plate_z = waypoint();
    if (by_stress() && protocol_.stop_at_scans && !stresses_are_back()) return std::nullopt;
    return waypoint_reached();
}

/// Scans at forces are taken in passing or, with stops, at a target like the last one.
std::optional<ProtocolRunner::ScanTag> ProtocolRunner::moved_by_force() {
    const double beyond = state_.control.force - waypoint();
    const bool up = leg().target > state_.leg_begin;
    const bool passed = !protocol_.stop_at_scans && !waypoint_is_end() && (up ? beyond >= 0 : beyond <= 0);
    if (passed || state_.reached_intervals >= enough_intervals) return waypoint_reached();
    if (state_.stage_step >= max_stage_steps())
        give_up(fmt::format("after {:.3g} s the plate is at {:.6g}", state_.stage_step * time_step_,
                            state_.plate_z));
    return std::nullopt;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::waypoint_reached() {
    const bool stops = protocol_.stop_at_scans || holds();
    if (!stops || state_.level == scans_of(stage())) return arrive(false);
    begin(Stage::settle);
    return std::nullopt;
}

ProtocolRunner::ScanTag ProtocolRunner::tag(int cycle, bool settled) {
    return {state_.frame++, cycle, state_.phase, state_.plate_z, state_.time, state_.rate_error, settled};
}

/// Called when the plate is at a scan position or at the end of a move; then the next move starts.
std::optional<ProtocolRunner::ScanTag> ProtocolRunner::arrive(bool settled) {
    const bool end = waypoint_is_end();
    std::optional<ScanTag> scan;
    if (state_.level < scans_of(stage())) {
        scan = tag(state_.cycle, settled);
        ++state_.level;
    }
    begin(Stage::move);
    if (end) next_leg();
    return scan;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::held(bool settled) {
    if (state_.stage_step < max_stage_steps()) return std::nullopt;
    std::optional<ScanTag> scan;
    if (state_.level < scans_of(stage())) {
        scan = tag(state_.cycle, settled);
        ++state_.level;
    }
    if (state_.level == scans_of(stage()) && state_.stage_step >= max_stage_steps()) next_leg();
    return scan;
}

double ProtocolRunner::progress() const {
    if (finished()) return 1;
    double part = 0;
    const int scans = std::max(1, scans_of(stage()));
    if (state_.stage == Stage::hold)
        part = (state_.time - state_.hold_begin) / stage().time;
    else if (state_.stage != Stage::relax && (by_force() || (by_stress() && !driven())))
        part = static_cast<double>(state_.level) / scans;
    else if (state_.stage != Stage::relax && target() != state_.leg_begin)
        part = (state_.plate_z - state_.leg_begin) / (target() - state_.leg_begin);
    return (state_.leg + 0.95 * std::clamp(part, 0.0, 1.0)) / static_cast<double>(legs_.size());
}

bool ProtocolRunner::is_possible(const ProtocolState& state) const {
    const int stage = static_cast<int>(state.stage), phase = static_cast<int>(state.phase);
    if (state.leg < 0 || state.leg >= static_cast<int>(legs_.size())) return false;
    const int scans =
        scans_of(stages_[static_cast<std::size_t>(legs_[static_cast<std::size_t>(state.leg)].stage)]);
    return state.step >= 0 && state.stage_step >= 0 && stage >= 0 &&
           stage <= static_cast<int>(Stage::finished) && state.cycle >= 0 && (phase == 0 || phase == 1) &&
           state.level >= 0 && state.level <= scans && state.frame >= 0 && state.settled_intervals >= 0 &&
           state.reached_intervals >= 0 && ForceControl::is_possible(state.control) &&
           CellControl::is_possible(state.cell) && !std::isnan(state.free_above);
}

}  // namespace mcdem::sim
