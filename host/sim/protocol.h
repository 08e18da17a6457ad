// The experiment of one replica as a sequence of intervals: relax, then the moves and holds of its programme,
// with scans. For a cell, the plate's position is the position along its strain path
// (scene/programme/cell_path.h). The protocol depends only on the results of its own replica, so a replica
// does the same alone and in any batch.
#pragma once
#include <optional>
#include <string>
#include <type_traits>

#include "scene/programme/cell_path.h"
#include "scene/programme/legs.h"
#include "scene/programme/scan_quantity.h"
#include "sim/cell_control.h"
#include "sim/engine.h"
#include "sim/force_control.h"
#include "sim/quasi_static.h"

namespace mcdem::inline sim {

/// State of the protocol: plain values, stored in checkpoints.
struct ProtocolState {
    long step = 0;        ///< since the start
    long stage_step = 0;  ///< since the start of this stage
    enum class Stage : int { relax, move, settle, hold, finished };
    Stage stage = Stage::relax;
    int cycle = 0;
    Phase phase = Phase::load;
    int leg = 0;                ///< the current one
    int level = 0;              ///< scans of this leg, including the current one
    int frame = 0;              ///< scans taken
    int settled_intervals = 0;  ///< consecutive ones that met the settling criterion
    int reached_intervals = 0;  ///< consecutive ones at the prescribed force or stresses
    double plate_z = 0;         ///< [m]
    double pressure = 0;        ///< smoothed over some intervals [Pa]
    double kinetic_energy = 0;  ///< of the grains [J]
    double rate_error = 0;      ///< estimate for the last move
    double leg_begin = 0;       ///< position [m] or force [N] from which scans of this leg are counted
    double time = 0;            ///< since the start [s]
    double hold_begin = 0;      ///< time at which the hold began [s]
    double free_above = 0;      ///< above this position the plate touches no grain [m]
    ForceControl::State control;
    CellControl::State cell;
};
static_assert(std::is_trivially_copyable_v<ProtocolState> &&
                  sizeof(ProtocolState) == 8 * (2 + 4 + 9 + 3 + 7 + 36),
              "no padding: equal states have equal bytes in checkpoints");

class ProtocolRunner {
public:
    /// `time_step` [s]
    ProtocolRunner(const Replica& replica, double time_step, const PackingScale& scale);

    /// The next interval, with at most `longest(interval)` steps; no steps if finished or stopped.
    template <class Longest>
    StepInterval next(Longest longest) const {
        if (state_.stage == ProtocolState::Stage::finished) return {};
        StepInterval interval = planned();
        if (cell_) deform(interval);
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
    void set_time_step(double time_step) { time_step_ = time_step; }
    void stop() { state_.stage = ProtocolState::Stage::finished; }
    bool finished() const { return state_.stage == ProtocolState::Stage::finished; }
    /// Reason why the programme could not continue in the last interval, with a remedy; otherwise empty.
    const std::string& hindrance() const { return hindrance_; }
    double plate_z() const { return state_.plate_z; }  ///< now [m]
    Strain strain() const;                             ///< of a cell, now
    double progress() const;                           ///< fraction of the protocol that is done, 0 to 1
    const ProtocolState& state() const { return state_; }
    void set_state(const ProtocolState& state) { state_ = state; }
    /// Whether the state can come from a valid checkpoint.
    bool is_possible(const ProtocolState& state) const;

private:
    /// Number of consecutive intervals below the limit. One is not enough: an oscillating packing passes
    /// through rest at its turning points, and a force can pass through its target.
    static constexpr int enough_intervals = 2;
    static constexpr double max_steps = 1e6;
    /// A force must be reached within this multiple of the time that the slowest plate needs for its whole
    /// range, a scan to settle and the approach; a stress within this multiple of the time for a strain of
    /// one.
    static constexpr double patience = 10;

    const Stage& stage() const { return stages_[static_cast<std::size_t>(leg().stage)]; }
    const Leg& leg() const { return legs_[static_cast<std::size_t>(state_.leg)]; }
    bool by_force() const;
    bool by_stress() const;
    bool driven() const;
    double set_force() const;
    SetStress end_stress() const;
    SetStress stress() const;
    const mcdem::Stage& last_move() const;
    CellMove move() const { return {stage(), state_.cell.begin, state_.leg_begin}; }
    double target() const { return cell_ ? move().end : leg().target; }
    double max_speed() const;
    /// Whether a moving plate is so far from the grains that its speed has no effect on them.
    bool is_free() const { return state_.plate_z > state_.free_above; }
    double rate_length() const { return cell_ ? 1 : state_.plate_z; }
    double level_value(int level) const;
    const ScanQuantity& quantity() const { return quantities_[static_cast<std::size_t>(state_.leg)]; }
    double quantity_begin() const;
    double listed_part(int scan) const;
    double scan_part(int scan, double way) const;
    double stress_done() const;
    void expect_listed_scans();
    double waypoint() const;
    bool waypoint_is_end() const;
    double hold_time() const;
    long max_stage_steps() const;
    long max_steps_by_stress() const;
    struct Steps {
        double count = 1, part = 1;  ///< part of the time step
    };
    Steps steps_of_way(double way_in_steps) const;
    StepInterval planned() const;
    double slow_speed() const;
    bool pauses() const;
    bool holds() const;
    double standing_time() const;  ///< at the current scan, without settling [s]
    bool is_smooth() const;
    StepInterval planned_smoothly() const;
    StepInterval planned_by_force() const;
    StepInterval planned_by_stress() const;
    void deform(StepInterval& interval) const;
    double drag() const;  ///< in addition to the grains' own [1/s]
    void take_note(const IntervalResult& result);
    void follow_force(double duration);
    void follow_stress(double duration);
    bool stresses_are_back();
    bool settled(const IntervalResult& result, double drag, bool plate_arrived);
    std::optional<ScanTag> moved();
    std::optional<ScanTag> moved_by_force();
    std::optional<ScanTag> moved_by_stress();
    std::optional<ScanTag> held(bool settled);
    std::optional<ScanTag> waypoint_reached();
    std::optional<ScanTag> arrive(bool settled);
    ScanTag tag(int cycle, bool settled);
    void begin(ProtocolState::Stage stage);
    void begin_leg();
    void begin_leg_of_cell();
    void end_leg_of_cell();
    void set_phase(bool load);
    void next_leg();
    void give_up(const std::string& why);
    void give_up(std::size_t direction, const std::string& why);
    void give_up_late();

    Plate plate_;
    Protocol protocol_;
    std::vector<mcdem::Stage> stages_;
    std::vector<Leg> legs_;
    std::vector<ScanQuantity> quantities_;  ///< of each leg, if a move of a cell lists its scans
    std::optional<CellControl> cell_;       ///< only for a cell
    double clearance_;      ///< of a plate above grains at rest; grains without weight may be anywhere [m]
    double scale_;          ///< scale of positions: the plate's start [m], 1 for a cell
    double time_step_;      ///< current one [s]
    double max_time_step_;  ///< without shortening [s]
    QuasiStatic quasi_static_;
    ForceControl force_control_;
    ProtocolState state_;
    std::string hindrance_;
};

}  // namespace mcdem::sim
