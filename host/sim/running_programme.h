// A replica's programme and how far it has come: what the protocol shares with the motions of plates and
// cells. For a cell, the plate's position is the position along its strain path
// (scene/programme/cell_path.h).
#pragma once
#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/programme/cell_path.h"
#include "scene/programme/legs.h"
#include "scene/programme/scan_quantity.h"
#include "sim/cell_control.h"
#include "sim/expected_run.h"
#include "sim/force_control.h"

namespace mcdem::inline sim {

/// State of the protocol: plain values, stored in checkpoints.
struct ProtocolState {
    long step = 0;           ///< since the start
    long activity_step = 0;  ///< since the start of this activity
    long relax_steps = 0;    ///< of the relaxation that is done
    enum class Activity : int { relax, move, settle, hold, finished };
    Activity activity = Activity::relax;
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
                  sizeof(ProtocolState) == 8 * (3 + 4 + 9 + 3 + 7 + 36),
              "no padding: equal states have equal bytes in checkpoints");
using Activity = ProtocolState::Activity;

/// Number of consecutive intervals at rest, or at a force, that are required. One is not enough: an
/// oscillating packing passes through rest at its turning points, and a force can pass through its target.
inline constexpr int enough_intervals = 2;

struct RunningProgramme {
    /// `time_step` [s]
    RunningProgramme(const Replica& replica, double time_step, const PackingScale& scale);

    const Leg& leg() const { return legs[static_cast<std::size_t>(state.leg)]; }
    const Stage& stage() const { return stage_of(state.leg); }
    const Stage& stage_of(int leg) const {
        return stages[static_cast<std::size_t>(legs[static_cast<std::size_t>(leg)].stage)];
    }
    /// The leg before the current one, if it moved in this quantity; was_controlled(): or held it.
    const Leg* move_before(Controlled quantity) const;
    bool was_controlled(Controlled quantity) const {
        return state.leg > 0 && controlled(stage_of(state.leg - 1)) == quantity;
    }
    const Stage& last_move() const;  ///< of a cell: a hold keeps its stresses
    bool is_hold() const { return stage().kind == StageKind::hold; }
    /// Of a cell, in the current leg.
    CellMove cell_move() const { return {stage(), state.cell.begin, state.leg_begin}; }
    const ScanQuantity& quantity() const { return quantities[static_cast<std::size_t>(state.leg)]; }
    /// The quantity of the scans of a cell's move, at its start.
    double quantity_begin() const;

    /// End of the move: position [m] or force [N], or position along the strain path.
    double target() const { return is_cell ? cell_move().end : leg().target; }
    /// Of scan `number` (from 1) of the move, like target().
    double level_value(int number) const;
    /// Of the next scan, or the end of the move.
    double waypoint() const;
    bool waypoint_is_end() const;
    /// Part of the way of a cell's move at which a scan is taken.
    double way_to_scan(int number, double way = 1) const;

    /// Fraction of the scans of this leg that are taken.
    double part_of_scans() const { return static_cast<double>(state.level) / std::max(1, scans_of(stage())); }
    /// Whether a moving plate is so far from the grains that its speed has no effect on them.
    bool is_free() const { return state.plate_z > state.free_above; }
    /// Whether the plate is held where the current move ends.
    bool holds() const;
    /// Whether the plate stands still as in an experiment, without any settling.
    bool pauses() const { return state.activity == Activity::settle && standing_time() > 0; }
    double standing_time() const { return holds() ? protocol.hold : protocol.pause; }  ///< at a scan [s]
    /// Steps of this activity at most, while the plate stands still or is held.
    long max_standing_steps() const;
    /// Drag on the grains in addition to their own, at most `wanted` [1/s].
    double drag(double wanted) const;

    void begin(Activity activity);
    void set_phase(bool load);
    void add_pressure(double pressure);  ///< of an interval [Pa]
    /// The replica stops, for the reason `why` with a remedy.
    void give_up(const std::string& why);

    Plate plate;
    Protocol protocol;
    std::vector<Stage> stages;
    std::vector<Leg> legs;
    std::vector<ScanQuantity> quantities;  ///< of each leg, if a move of a cell lists its scans
    bool is_cell;
    double clearance;      ///< of a plate above grains at rest; grains without weight may be anywhere [m]
    double time_step;      ///< current one [s]
    double max_time_step;  ///< without shortening [s]
    ExpectedRun expected;
    QuasiStatic quasi_static;
    ProtocolState state;
    std::string hindrance;  ///< why the programme could not continue in the last interval
};

}  // namespace mcdem::sim
