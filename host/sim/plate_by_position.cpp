#include "sim/plate_by_position.h"

namespace mcdem::inline sim {
namespace {

double force_along_z(const IntervalResult& result, Wall wall) {
    return result.wall_force[static_cast<std::size_t>(wall)].z();
}

}  // namespace

double PlateByPosition::max_speed(const RunningProgramme& programme) const {
    const double speed = programme.stage().speed;
    return std::isnan(speed) ? programme.plate.speed : speed;
}

/// Far from the grains the plate is fast; on its way down it slows down before them. A plate that pauses
/// moves as that of an experiment, which does not wait for grains that rearrange.
ProgrammeMotion::Plan PlateByPosition::plan(const RunningProgramme& programme) const {
    const ProtocolState& now = programme.state;
    if (now.activity != Activity::move) return standing(programme);
    if (programme.is_free()) {
        const double speed = max_speed(programme), step = speed * programme.time_step;
        const bool down = programme.waypoint() < now.plate_z;
        return moving(programme, speed,
                      down ? std::ceil((now.plate_z - now.free_above) / step) : most_planned_steps);
    }
    const double speed = slow_speed(programme);
    const bool waits = programme.protocol.pause == 0;
    return moving(programme,
                  waits ? speed * programme.quasi_static.slowing(now.kinetic_energy, speed) : speed);
}

void PlateByPosition::follow(RunningProgramme& programme, const Plan&, const IntervalResult& result,
                             double duration) const {
    ProtocolState& now = programme.state;
    const double force = force_along_z(result, Wall::plate);
    if (force != 0) now.free_above = now.plate_z + programme.clearance;
    programme.add_pressure(programme.quasi_static.pressure(force, force_along_z(result, Wall::floor)));
    ForceControl::observe(now.control, force, duration);
}

/// After a move to a position the next one starts where that should have ended.
void PlateByPosition::begin_leg(RunningProgramme& programme) const {
    ProtocolState& now = programme.state;
    const Leg* const before = programme.move_before(Controlled::position);
    now.leg_begin = before ? before->target : now.plate_z;
    ForceControl::rest(now.control);
    if (!programme.is_hold() && programme.leg().target != now.leg_begin)
        programme.set_phase(programme.leg().target < now.leg_begin);
}

}  // namespace mcdem::sim
