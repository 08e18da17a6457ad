// A plate that gives way: its true position is where it is sent to plus compliance times the force on it. The
// force is known from the last interval only; the plate goes after it smoothly, interval by interval.
#pragma once
#include "scene/scene.h"
#include "sim/engine.h"

namespace mcdem::inline sim {

class CompliantPlate {
public:
    /// Plain values, so that a checkpoint can hold them.
    struct State {
        double given = 0;  ///< true less commanded position [m]
        double slope = 0;  ///< how much of a commanded move it gives way by, -1 to 0
        double force = 0;  ///< on the plate at the end of the last interval, upward [N]
    };

    explicit CompliantPlate(const Replica& replica);

    /// Turns the commanded interval into the true one. The plate moves at most `farthest` [m] or as far as
    /// commanded.
    void deflect(StepInterval& interval, double time_step, double farthest);
    /// Takes note of the force at the interval's end.
    void made(const IntervalResult& result);

    /// The plate gives way as much as it should, to a thousandth of that or of `farthest` [m].
    bool arrived(double farthest) const;

    const State& state() const { return state_; }
    void set_state(const State& state) { state_ = state; }
    /// A plate's numbers are any.
    static bool is_possible(const State&) { return true; }

private:
    double error() const { return compliance_ * state_.force - state_.given; }

    double compliance_;    ///< [m/N]
    double follow_time_;   ///< in which an error shrinks to 1/e [s]
    double max_catch_up_;  ///< part of an error that an interval makes good
    State state_;
    double change_ = 0;  ///< of `given` a step, in the interval under way [m]
};

}  // namespace mcdem::sim
