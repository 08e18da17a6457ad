#include "sim/protocol.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline sim {
namespace {

using Stage = ProtocolState::Stage;

/// Intervals in a row below the limit: a packing that passes through rest at the turning point of an
/// oscillation is not taken for one at rest.
constexpr int enough_settled_intervals = 2;
/// Part of an interval's pressure that is taken over, so that waves in the packing do not shake the plate.
constexpr double pressure_share = 0.2;
/// The integrator takes away drag * time step of a velocity in a step. Where the plate halts, motion ends at
/// once; before the first stroke grains still have some way to fall.
constexpr double max_drag = 0.5, max_relax_drag = 0.02;
/// Closer than this to a level, over the plate's start, the plate has arrived.
constexpr double rounding = 1e-12;

double force_along_z(const IntervalResult& result, Wall wall) {
    return result.wall_force[static_cast<std::size_t>(wall)].z();
}

}  // namespace

ProtocolRunner::ProtocolRunner(const Replica& replica, double time_step, const PackingScale& scale)
    : plate_(replica.plate),
      protocol_(replica.protocol),
      time_step_(time_step),
      quasi_static_(replica, scale) {
    state_.plate_z = plate_.start;
    state_.pressure = quasi_static_.pressure(0, 0);
}

double ProtocolRunner::stroke_begin() const {
    return state_.phase == Phase::load ? plate_.start : plate_.end;
}
double ProtocolRunner::stroke_end() const { return state_.phase == Phase::load ? plate_.end : plate_.start; }

double ProtocolRunner::level_z(int level) const {
    return stroke_begin() + (stroke_end() - stroke_begin()) * level / protocol_.scans_per_stroke;
}

double ProtocolRunner::distance_left() const { return level_z(state_.level + 1) - state_.plate_z; }

long ProtocolRunner::max_settling_steps() const {
    const double time = state_.stage == Stage::relax ? protocol_.relax_time : protocol_.settle_time;
    return std::lround(time / time_step_);
}

/// The next interval as far as the protocol is concerned. The plate ends a move at the scan position: its
/// last speed is a little lower.
StepInterval ProtocolRunner::planned() const {
    constexpr double max_steps = 1e6;
    if (state_.stage != Stage::move) {
        const long left = std::max(1L, max_settling_steps() - state_.stage_step);
        return {static_cast<int>(std::min<double>(left, max_steps)), state_.plate_z, 0, drag()};
    }
    const double left = distance_left();
    const double step = quasi_static_.speed(state_.plate_z, state_.pressure) * time_step_;
    const double steps = std::max(1.0, std::ceil(std::abs(left) / step - 1e-9));
    return {static_cast<int>(std::min(steps, max_steps)), state_.plate_z, left / (steps * time_step_), 0};
}

double ProtocolRunner::drag() const {
    return std::min(protocol_.settle_drag,
                    (state_.stage == Stage::relax ? max_relax_drag : max_drag) / time_step_);
}

void ProtocolRunner::take_pressure(const IntervalResult& result) {
    const double now =
        quasi_static_.pressure(force_along_z(result, Wall::plate), force_along_z(result, Wall::floor));
    state_.pressure += pressure_share * (now - state_.pressure);
}

/// At rest: net forces are small. The drag is so strong that velocities follow from the net forces alone.
bool ProtocolRunner::settled(const IntervalResult& result, bool plate_arrived) {
    const double unbalanced = quasi_static_.unbalanced_force(result.kinetic_energy, drag(), state_.pressure);
    const bool still = plate_arrived && unbalanced <= protocol_.settle_unbalanced_force;
    state_.settled_intervals = still ? state_.settled_intervals + 1 : 0;
    return state_.settled_intervals >= enough_settled_intervals;
}

void ProtocolRunner::begin(Stage stage) {
    state_.stage = stage;
    state_.stage_step = 0;
    state_.settled_intervals = 0;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::made(const IntervalResult& result,
                                                            bool plate_arrived) {
    if (finished()) return std::nullopt;
    if (state_.stage == Stage::move) {
        auto scan = moved(result.steps);
        take_pressure(result);
        return scan;
    }
    count(result.steps);
    take_pressure(result);
    const bool still = settled(result, plate_arrived);
    if (!still && state_.stage_step < max_settling_steps()) return std::nullopt;
    if (state_.stage == Stage::settle) return arrive(still);
    begin(Stage::move);
    if (!protocol_.scan_at_start) return std::nullopt;
    return tag(0, still);
}

void ProtocolRunner::count(int steps) {
    state_.step += steps;
    state_.stage_step += steps;
    state_.time += steps * time_step_;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::moved(int steps) {
    const double speed = planned().plate_velocity;
    count(steps);
    state_.rate_error = quasi_static_.rate_error(std::abs(speed), state_.plate_z, state_.pressure);
    state_.plate_z += speed * time_step_ * steps;
    if (std::abs(distance_left()) > rounding * plate_.start) return std::nullopt;
    state_.plate_z = level_z(state_.level + 1);
    if (!protocol_.stop_at_scans) return arrive(false);
    begin(Stage::settle);
    return std::nullopt;
}

ProtocolRunner::ScanTag ProtocolRunner::tag(int cycle, bool settled) {
    return {state_.frame++, cycle, state_.phase, state_.plate_z, state_.time, state_.rate_error, settled};
}

/// The plate is at a scan position: a scan is due, and the next move begins.
std::optional<ProtocolRunner::ScanTag> ProtocolRunner::arrive(bool settled) {
    const ScanTag scan = tag(state_.cycle, settled);
    begin(Stage::move);
    if (++state_.level == protocol_.scans_per_stroke) {
        state_.level = 0;
        if (state_.phase == Phase::unload && ++state_.cycle == protocol_.cycles) stop();
        state_.phase = state_.phase == Phase::load ? Phase::unload : Phase::load;
    }
    return scan;
}

double ProtocolRunner::progress() const {
    if (finished()) return 1;
    const double all = 2.0 * protocol_.cycles * protocol_.scans_per_stroke + protocol_.scan_at_start;
    double moved = 0;
    if (state_.stage == Stage::move) moved = 1 - std::abs(distance_left() / (level_z(1) - level_z(0)));
    if (state_.stage == Stage::settle) moved = 1;
    return (state_.frame + 0.9 * std::max(0.0, moved)) / all;
}

}  // namespace mcdem::sim
