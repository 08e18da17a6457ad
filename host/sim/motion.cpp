#include "sim/motion.h"

#include <algorithm>
#include <numbers>

namespace mcdem::inline sim {
namespace {

/// A plate that pauses has constant velocities in this number of intervals of the way between two scans.
constexpr double intervals_of_way = 64;

/// Whether the plate starts and stops smoothly, because it pauses at the next scan.
bool is_smooth(const RunningProgramme& programme) {
    const ProtocolState& now = programme.state;
    return programme.protocol.stop_at_scans && programme.protocol.pause > 0 &&
           now.level < scans_of(programme.stage()) && now.plate_z != programme.waypoint();
}

StepInterval straight(const RunningProgramme& programme, double speed, double most) {
    const double left = programme.waypoint() - programme.state.plate_z;
    const auto [steps, part] =
        whole_steps(programme.protocol, std::abs(left) / (speed * programme.time_step));
    return in_part({static_cast<int>(std::min({steps, most, most_planned_steps})), programme.state.plate_z,
                    left / (steps * part * programme.time_step)},
                   part);
}

/// The velocity is half a sine over each way, which takes as long as at constant speed.
StepInterval smooth(const RunningProgramme& programme, double speed) {
    const ProtocolState& now = programme.state;
    const double from = now.level == 0 ? now.leg_begin : programme.level_value(now.level);
    const double way = programme.waypoint() - from;
    const double at_speed = std::abs(way) / (speed * programme.time_step),
                 part = whole_steps(programme.protocol, at_speed).part;
    const double all_steps = at_speed / part, time_step = part * programme.time_step;
    const double passed = std::clamp((now.plate_z - from) / way, 0.0, 1.0);
    const double time = std::acos(1 - 2 * passed) / std::numbers::pi;  // over that of the way
    const double left = std::max(1.0, std::ceil((1 - time) * all_steps - 1e-9));
    const double steps = std::min({left, std::ceil(all_steps / intervals_of_way), most_planned_steps});
    const double next = (1 - std::cos(std::numbers::pi * (time + steps / all_steps))) / 2;
    const double to = steps < left ? from + next * way : programme.waypoint();
    return in_part({static_cast<int>(steps), now.plate_z, (to - now.plate_z) / (steps * time_step)}, part);
}

}  // namespace

WholeSteps whole_steps(const Protocol& protocol, double way_in_steps) {
    const double count = std::max(1.0, std::ceil(way_in_steps - 1e-9)), part = way_in_steps / count;
    return {count, protocol.rate_tolerance == 0 && part > 0 && part < 0.999 ? part : 1};
}

double controlled_steps(const RunningProgramme& programme, double duration) {
    const double steps = std::clamp(std::floor(duration / programme.time_step), 2.0, most_planned_steps);
    if (programme.state.activity == Activity::move) return steps;
    return std::clamp(static_cast<double>(programme.max_standing_steps() - programme.state.activity_step),
                      1.0, steps);
}

ProgrammeMotion::Plan ProgrammeMotion::standing(const RunningProgramme& programme) {
    const double left =
        std::max(1.0, static_cast<double>(programme.max_standing_steps() - programme.state.activity_step));
    return {{static_cast<int>(std::min(left, most_planned_steps)), programme.state.plate_z, 0,
             programme.drag(HUGE_VAL)}};
}

/// A move ends exactly at the waypoint.
ProgrammeMotion::Plan ProgrammeMotion::moving(const RunningProgramme& programme, double speed, double most) {
    const StepInterval interval =
        is_smooth(programme) ? smooth(programme, speed) : straight(programme, speed, most);
    return {interval, interval.plate_velocity, std::abs(interval.plate_velocity)};
}

bool ProgrammeMotion::arrived(RunningProgramme& programme) const {
    const double at = programme.waypoint(), scale = programme.is_cell ? 1 : programme.plate.start;
    if (std::abs(at - programme.state.plate_z) > position_rounding * scale) return false;
    programme.state.plate_z = at;
    return true;
}

double ProgrammeMotion::progress(const RunningProgramme& programme) const {
    const double begin = programme.state.leg_begin, end = programme.target();
    return end == begin ? 0 : (programme.state.plate_z - begin) / (end - begin);
}

}  // namespace mcdem::sim
