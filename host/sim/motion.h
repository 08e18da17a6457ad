// How a plate or a cell of a programme moves: to a position or a strain at a prescribed speed, or to a force
// or stresses under control. A motion holds only constants; its state is that of the programme.
#pragma once
#include <cmath>

#include "sim/engine.h"
#include "sim/running_programme.h"

namespace mcdem::inline sim {

/// Maximum number of steps of a planned interval.
inline constexpr double most_planned_steps = 1e6;
/// Within this distance of a level, relative to the plate's start or a strain of one, the plate has arrived.
inline constexpr double position_rounding = 1e-12;

class ProgrammeMotion {
public:
    struct Plan {
        StepInterval interval;
        double speed = 0;    ///< of the position: of the plate [m/s], or along the strain path [1/s]
        double fastest = 0;  ///< the largest of it and of the other strain rates
    };

    virtual ~ProgrammeMotion() = default;

    /// The next interval, without a limit to its steps.
    virtual Plan plan(const RunningProgramme& programme) const = 0;
    /// Records the forces at the end of an interval of this `duration` [s], and chooses the next rates.
    virtual void follow(RunningProgramme& programme, const Plan& plan, const IntervalResult& result,
                        double duration) const = 0;
    /// Whether a move is at its waypoint. Gives up if it takes too long.
    virtual bool arrived(RunningProgramme& programme) const;
    /// Whether the force or the stresses are the prescribed ones.
    virtual bool reached(const RunningProgramme&) const { return true; }
    /// Drag on the grains near the prescribed force or stresses, without other limits [1/s].
    virtual double drag(const RunningProgramme&) const { return HUGE_VAL; }
    /// Length over which a speed is a strain rate: of a plate its position [m].
    virtual double length(const RunningProgramme& programme) const = 0;
    /// Fraction of the move that is done.
    virtual double progress(const RunningProgramme& programme) const;
    /// Of a cell, now.
    virtual Strain strain(const RunningProgramme&) const { return {}; }
    /// Starts a leg; gives up if it is impossible.
    virtual void begin_leg(RunningProgramme& programme) const = 0;
    virtual void end_leg(RunningProgramme&) const {}

protected:
    /// A force must be reached within this multiple of the time that the slowest plate needs for its whole
    /// range, a scan to settle and the approach; a stress within this multiple of the time for a strain of
    /// one.
    static constexpr double patience = 10;

    virtual double max_speed(const RunningProgramme& programme) const = 0;
    /// Speed at which forces are quasi-static.
    double slow_speed(const RunningProgramme& programme) const {
        return programme.quasi_static.speed(max_speed(programme), length(programme),
                                            programme.state.pressure);
    }
    /// The plate or the cell stands still.
    static Plan standing(const RunningProgramme& programme);
    /// Moves at this speed towards the waypoint, in at most `most` steps.
    static Plan moving(const RunningProgramme& programme, double speed, double most = most_planned_steps);
};

/// Steps of an interval of `duration` [s] under control; of a hold, not beyond its next scan.
double controlled_steps(const RunningProgramme& programme, double duration);

/// Whole steps for a way of `way_in_steps` at full speed. Without a tolerance this speed is prescribed, up to
/// 0.1 %, so the steps are shorter; otherwise it is a maximum.
struct WholeSteps {
    double count = 1, part = 1;  ///< part of the time step
};
WholeSteps whole_steps(const Protocol& protocol, double way_in_steps);

}  // namespace mcdem::sim
