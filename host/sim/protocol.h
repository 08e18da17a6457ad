// The experiment of one replica as a sequence of intervals: relax, then cycles of load and unload strokes
// with scans on the way. It depends on its own replica's results only, so that a replica does the same
// alone and in any batch.
#pragma once
#include <optional>
#include <type_traits>

#include "scene/scene.h"
#include "sim/engine.h"
#include "sim/quasi_static.h"

namespace mcdem::inline sim {

/// The plate's program and how far it has come: plain values, so that a checkpoint can hold them.
struct ProtocolState {
    long step = 0;        ///< since the start
    long stage_step = 0;  ///< since this stage began
    enum class Stage : int { relax, move, settle, finished };
    Stage stage = Stage::relax;
    int cycle = 0;
    Phase phase = Phase::load;
    int level = 0;              ///< scans of this stroke taken or under way
    int frame = 0;              ///< scans taken
    int settled_intervals = 0;  ///< in a row that met the settling criterion
    double plate_z = 0;         ///< [m]
    double pressure = 0;        ///< smoothed over some intervals [Pa]
    double rate_error = 0;      ///< estimated, of the last move
    double time = 0;            ///< since the start [s]
};
static_assert(std::is_trivially_copyable_v<ProtocolState> && sizeof(ProtocolState) == 8 * (2 + 3 + 4),
              "no padding: equal states have equal bytes in checkpoints");

class ProtocolRunner {
public:
    /// `time_step` [s]
    ProtocolRunner(const Replica& replica, double time_step, const PackingScale& scale);

    /// What to do next, at most `longest(plate_velocity)` steps; no steps when finished or stopped.
    template <class Longest>
    StepInterval next(Longest longest) const {
        if (state_.stage == ProtocolState::Stage::finished) return {};
        StepInterval interval = planned();
        interval.steps = std::min(interval.steps, longest(interval.plate_velocity));
        return interval;
    }

    /// A scan to be taken of the state that an interval has led to.
    struct ScanTag {
        int frame, cycle;
        Phase phase;
        double plate_z, time, rate_error;
        bool settled;
    };
    /// Takes note of an interval. Nothing counts as settled while the plate is still on its way.
    std::optional<ScanTag> made(const IntervalResult& result, bool plate_arrived = true);

    /// Of the steps that follow [s].
    void set_time_step(double time_step) { time_step_ = time_step; }
    void stop() { state_.stage = ProtocolState::Stage::finished; }
    bool finished() const { return state_.stage == ProtocolState::Stage::finished; }
    double plate_z() const { return state_.plate_z; }  ///< now [m]
    double progress() const;                           ///< part of the protocol that is done, 0 to 1
    const ProtocolState& state() const { return state_; }
    void set_state(const ProtocolState& state) { state_ = state; }

private:
    double stroke_begin() const;
    double stroke_end() const;
    double level_z(int level) const;
    double distance_left() const;
    long max_settling_steps() const;
    StepInterval planned() const;
    double drag() const;  ///< while the plate stands still [1/s]
    void take_pressure(const IntervalResult& result);
    bool settled(const IntervalResult& result, bool plate_arrived);
    void count(int steps);
    std::optional<ScanTag> moved(int steps);
    std::optional<ScanTag> arrive(bool settled);
    ScanTag tag(int cycle, bool settled);
    void begin(ProtocolState::Stage stage);

    Plate plate_;
    Protocol protocol_;
    double time_step_;
    QuasiStatic quasi_static_;
    ProtocolState state_;
};

}  // namespace mcdem::sim
