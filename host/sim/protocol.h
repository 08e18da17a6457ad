// The experiment of one replica as a sequence of intervals: relax, then the moves and holds of its programme,
// with scans. The protocol depends only on the results of its own replica, so a replica does the same alone
// and in any batch.
#pragma once
#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "core/expects.h"
#include "sim/motion.h"

namespace mcdem::inline sim {

class ProtocolRunner {
public:
    /// `time_step` [s]
    ProtocolRunner(const Replica& replica, double time_step, const PackingScale& scale);

    /// The next interval, with at most `longest(interval)` steps; no steps if finished or stopped.
    template <class Longest>
    StepInterval next(Longest longest) const {
        if (finished()) return {};
        StepInterval interval = motion().plan(programme_).interval;
        expects(interval.steps > 0, "a replica whose programme goes on makes steps");
        interval.steps = std::min(interval.steps, longest(interval));
        return interval;
    }

    /// A scan to be taken in the state after an interval.
    struct ScanTag {
        int frame, cycle;
        Phase phase;
        double plate_z, time, rate_error;
        bool settled;
    };
    /// Records an interval. The packing does not count as settled while the plate still moves.
    std::optional<ScanTag> on_interval_done(const IntervalResult& result, bool plate_arrived = true);

    /// Time step of the next intervals [s].
    void set_time_step(double time_step) { programme_.time_step = time_step; }
    void stop() { programme_.state.activity = Activity::finished; }
    bool finished() const { return state().activity == Activity::finished; }
    /// Reason why the programme could not continue in the last interval, with a remedy; otherwise empty.
    const std::string& hindrance() const { return programme_.hindrance; }
    double plate_z() const { return state().plate_z; }             ///< now [m]
    Strain strain() const { return motion().strain(programme_); }  ///< of a cell, now
    double progress() const;  ///< fraction of the protocol that is done, 0 to 1
    const ProtocolState& state() const { return programme_.state; }
    void set_state(const ProtocolState& state) { programme_.state = state; }
    /// Whether the state can come from a valid checkpoint.
    bool is_possible(const ProtocolState& state) const;

private:
    const ProgrammeMotion& motion() const;
    void record(const IntervalResult& result);
    bool settled(const IntervalResult& result, double drag, bool plate_arrived);
    std::optional<ScanTag> at_waypoint();
    std::optional<ScanTag> arrive(bool settled);
    std::optional<ScanTag> held(bool settled);
    std::optional<ScanTag> scan(bool settled);
    ScanTag tag(int cycle, bool settled);
    void begin_leg();
    void next_leg();

    RunningProgramme programme_;
    std::unique_ptr<const ProgrammeMotion> moved_;       ///< by position or strain
    std::unique_ptr<const ProgrammeMotion> controlled_;  ///< by force or stress
};

}  // namespace mcdem::sim
