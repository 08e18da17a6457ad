#include "sim/plate_by_force.h"

#include <fmt/format.h>

#include <algorithm>

namespace mcdem::inline sim {
namespace {

/// The prescribed force [N]. With stops it is that of the next scan, otherwise that of the move.
double set_force(const RunningProgramme& programme) {
    if (programme.is_hold()) return programme.state.leg_begin;
    return programme.protocol.stop_at_scans ? programme.waypoint() : programme.leg().target;
}

void give_up_force(RunningProgramme& programme, const std::string& why) {
    programme.give_up(fmt::format(
        "the force {:.6g} N cannot be reached: {}, and the force {:.6g} N (set a force that the packing can "
        "bear there, or move plate.end or plate.start)",
        set_force(programme), why, programme.state.control.force));
}

/// Whether the plate is at the end of its range and would have to leave it.
void expect_range(RunningProgramme& programme) {
    const ProtocolState& now = programme.state;
    const Plate& plate = programme.plate;
    const double set = set_force(programme), edge = position_rounding * plate.start;
    if (now.plate_z <= plate.end + edge && now.control.force < set && now.control.velocity < 0)
        give_up_force(programme, fmt::format("the plate is at plate.end = {}", plate.end));
    else if (now.plate_z >= plate.start - edge && now.control.force > set && now.control.velocity > 0)
        give_up_force(programme, fmt::format("the plate is at plate.start = {}", plate.start));
}

}  // namespace

PlateByForce::PlateByForce(const Replica& replica, const PackingScale& scale)
    : control_(ForceControl::of_plate(replica, scale)) {}

ProgrammeMotion::Plan PlateByForce::plan(const RunningProgramme& programme) const {
    const ProtocolState& now = programme.state;
    const Plate& plate = programme.plate;
    const double steps = controlled_steps(programme, control_.interval(now.control, set_force(programme)));
    const double duration = steps * programme.time_step;
    const double velocity = std::clamp(now.control.velocity, (plate.end - now.plate_z) / duration,
                                       (plate.start - now.plate_z) / duration);
    return {{static_cast<int>(steps), now.plate_z, velocity, programme.drag(drag(programme))},
            velocity,
            std::abs(velocity)};
}

void PlateByForce::follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                          double duration) const {
    PlateByPosition::follow(programme, plan, result, duration);
    ProtocolState& now = programme.state;
    const bool there = reached(programme);
    now.reached_intervals = there ? now.reached_intervals + 1 : 0;
    control_.steer(now.control, set_force(programme), duration, slow_speed(programme));
    if (!there) expect_range(programme);
}

/// Scans at forces are taken in passing or, with stops, at a target like the last one.
bool PlateByForce::arrived(RunningProgramme& programme) const {
    const ProtocolState& now = programme.state;
    const double beyond = now.control.force - programme.waypoint();
    const bool up = programme.leg().target > now.leg_begin;
    const bool passed =
        !programme.protocol.stop_at_scans && !programme.waypoint_is_end() && (up ? beyond >= 0 : beyond <= 0);
    if (passed || now.reached_intervals >= enough_intervals) return true;
    if (now.activity_step >= max_steps(programme))
        give_up_force(programme, fmt::format("after {:.3g} s the plate is at {:.6g}",
                                             now.activity_step * programme.time_step, now.plate_z));
    return false;
}

bool PlateByForce::reached(const RunningProgramme& programme) const {
    return ForceControl::reached(programme.state.control, set_force(programme));
}

double PlateByForce::drag(const RunningProgramme& programme) const {
    return control_.drag(programme.state.control, set_force(programme));
}

double PlateByForce::progress(const RunningProgramme& programme) const { return programme.part_of_scans(); }

/// After a hold of a force the next move starts from that force.
void PlateByForce::begin_leg(RunningProgramme& programme) const {
    ProtocolState& now = programme.state;
    const Leg* const before = programme.move_before(Controlled::force);
    const bool goes_on = programme.was_controlled(Controlled::force);
    if (before)
        now.leg_begin = before->target;
    else if (!goes_on)
        now.leg_begin = now.control.force;
    if (!(goes_on && programme.is_hold())) ForceControl::rest(now.control);
    if (programme.is_hold()) {
        if (!(now.leg_begin > 0)) give_up_force(programme, "no grain presses on the plate");
    } else if (programme.leg().target != now.leg_begin) {
        programme.set_phase(programme.leg().target > now.leg_begin);
    }
}

long PlateByForce::max_steps(const RunningProgramme& programme) const {
    const Plate& plate = programme.plate;
    const QuasiStatic& limit = programme.quasi_static;
    const double slowest = limit.speed(max_speed(programme), plate.start, limit.min_pressure());
    const double approach = control_.approach_time(programme.state.control, set_force(programme));
    return std::lround(patience *
                       ((plate.start - plate.end) / slowest + programme.protocol.settle_time + approach) /
                       programme.time_step);
}

}  // namespace mcdem::sim
