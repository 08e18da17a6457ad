#include "sim/protocol.h"

#include "core/container.h"
#include "sim/cell_by_stress.h"
#include "sim/plate_by_force.h"

namespace mcdem::inline sim {

ProtocolRunner::ProtocolRunner(const Replica& replica, double time_step, const PackingScale& scale)
    : programme_(replica, time_step, scale) {
    if (is_cell(replica.box)) {
        moved_ = std::make_unique<CellByStrain>();
        controlled_ = std::make_unique<CellByStress>(replica, scale);
    } else {
        moved_ = std::make_unique<PlateByPosition>();
        controlled_ = std::make_unique<PlateByForce>(replica, scale);
    }
}

const ProgrammeMotion& ProtocolRunner::motion() const {
    const bool moves =
        state().activity == Activity::relax || controlled(programme_.stage()) == Controlled::position;
    return moves ? *moved_ : *controlled_;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::on_interval_done(const IntervalResult& result,
                                                                        bool plate_arrived) {
    if (finished()) return std::nullopt;
    const double drag = programme_.drag(motion().drag(programme_));
    record(result);
    if (finished()) return std::nullopt;
    if (state().activity == Activity::move)
        return motion().arrived(programme_) ? at_waypoint() : std::nullopt;
    const bool still = settled(result, drag, plate_arrived);
    if (state().activity == Activity::hold) return held(still);
    const bool in_time = state().activity_step < programme_.max_standing_steps();
    if (in_time && (!still || programme_.pauses())) return std::nullopt;
    if (state().activity == Activity::settle) return arrive(still);
    programme_.state.relax_steps = state().step;
    begin_leg();
    if (!programme_.protocol.scan_at_start) return std::nullopt;
    return tag(0, still);
}

void ProtocolRunner::record(const IntervalResult& result) {
    ProtocolState& now = programme_.state;
    const ProgrammeMotion::Plan plan = motion().plan(programme_);
    const double step = plan.interval.step_part * programme_.time_step, duration = step * result.steps;
    now.step += result.steps;
    now.activity_step += result.steps;
    now.time += duration;
    const bool touches = result.wall_force[static_cast<std::size_t>(Wall::plate)].z() != 0;
    if (now.activity == Activity::move)
        now.rate_error =
            programme_.is_free() && !touches
                ? 0
                : programme_.quasi_static.rate_error(plan.fastest, motion().length(programme_), now.pressure);
    now.plate_z += plan.speed * step * result.steps;
    now.kinetic_energy = result.kinetic_energy;
    motion().follow(programme_, plan, result, duration);
}

/// Whether net forces are small. The drag is so strong that velocities are determined by the net forces.
bool ProtocolRunner::settled(const IntervalResult& result, double drag, bool plate_arrived) {
    ProtocolState& now = programme_.state;
    const double unbalanced =
        programme_.quasi_static.unbalanced_force(result.kinetic_energy, drag, now.pressure);
    const bool still = plate_arrived && unbalanced <= programme_.protocol.settle_unbalanced_force &&
                       motion().reached(programme_);
    now.settled_intervals = still ? now.settled_intervals + 1 : 0;
    return now.settled_intervals >= enough_intervals;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::at_waypoint() {
    const bool stops = programme_.protocol.stop_at_scans || programme_.holds();
    if (!stops || state().level == scans_of(programme_.stage())) return arrive(false);
    programme_.begin(Activity::settle);
    return std::nullopt;
}

/// At a scan position or at the end of a move; then the next move starts.
std::optional<ProtocolRunner::ScanTag> ProtocolRunner::arrive(bool settled) {
    const bool end = programme_.waypoint_is_end();
    const auto taken = scan(settled);
    programme_.begin(Activity::move);
    if (end) next_leg();
    return taken;
}

std::optional<ProtocolRunner::ScanTag> ProtocolRunner::held(bool settled) {
    const auto waits = [&] { return state().activity_step < programme_.max_standing_steps(); };
    if (waits()) return std::nullopt;
    const auto taken = scan(settled);
    if (state().level == scans_of(programme_.stage()) && !waits()) next_leg();
    return taken;
}

/// The next scan of the leg, if there is one.
std::optional<ProtocolRunner::ScanTag> ProtocolRunner::scan(bool settled) {
    if (state().level == scans_of(programme_.stage())) return std::nullopt;
    ++programme_.state.level;
    return tag(state().cycle, settled);
}

ProtocolRunner::ScanTag ProtocolRunner::tag(int cycle, bool settled) {
    ProtocolState& now = programme_.state;
    return {now.frame++, cycle, now.phase, now.plate_z, now.time, now.rate_error, settled};
}

void ProtocolRunner::begin_leg() {
    programme_.state.level = 0;
    programme_.state.hold_begin = state().time;
    programme_.begin(programme_.is_hold() ? Activity::hold : Activity::move);
    motion().begin_leg(programme_);
}

void ProtocolRunner::next_leg() {
    if (state().leg + 1 == static_cast<int>(programme_.legs.size())) return stop();
    motion().end_leg(programme_);
    ++programme_.state.leg;
    begin_leg();
}

/// In steps: those of the relaxation, at most or as it took, and those that are expected of the programme.
double ProtocolRunner::progress() const {
    if (finished()) return 1;
    const auto& [relax, programme, lowest, force] = programme_.expected;
    if (state().activity == Activity::relax)
        return std::min(1.0, static_cast<double>(state().step) / (relax + programme));
    const double part = state().activity == Activity::hold
                            ? (state().time - state().hold_begin) / programme_.stage().time
                            : motion().progress(programme_);
    const double done =
        (state().leg + 0.95 * std::clamp(part, 0.0, 1.0)) / static_cast<double>(programme_.legs.size());
    const auto relaxed = static_cast<double>(state().relax_steps);
    return (relaxed + done * programme) / (relaxed + programme);
}

bool ProtocolRunner::is_possible(const ProtocolState& state) const {
    const int activity = static_cast<int>(state.activity), phase = static_cast<int>(state.phase);
    if (state.leg < 0 || state.leg >= static_cast<int>(programme_.legs.size())) return false;
    return state.step >= 0 && state.relax_steps >= 0 && state.activity_step >= 0 && activity >= 0 &&
           activity <= static_cast<int>(Activity::finished) && state.cycle >= 0 &&
           (phase == 0 || phase == 1) && state.level >= 0 &&
           state.level <= scans_of(programme_.stage_of(state.leg)) && state.frame >= 0 &&
           state.settled_intervals >= 0 && state.reached_intervals >= 0 &&
           ForceControl::is_possible(state.control) && CellControl::is_possible(state.cell) &&
           !std::isnan(state.free_above);
}

}  // namespace mcdem::sim
