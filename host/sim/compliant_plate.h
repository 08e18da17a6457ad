// A compliant plate: its true position is the commanded one plus compliance times the force on it. The force
// is known only from the last interval, so the plate follows it smoothly, interval by interval.
#pragma once
#include "scene/scene.h"
#include "sim/engine.h"

namespace mcdem::inline sim {

class CompliantPlate {
public:
    /// Plain values, stored in checkpoints.
    struct State {
        double given = 0;  ///< true minus commanded position [m]
        double slope = 0;  ///< deflection per commanded displacement, -1 to 0
        double force = 0;  ///< on the plate at the end of the last interval, upward [N]
    };

    explicit CompliantPlate(const Replica& replica);

    /// Converts the commanded interval into the true one. The plate moves at most `farthest` [m], or as far
    /// as commanded.
    void deflect(StepInterval& interval, double time_step, double farthest);
    /// Records the force at the end of the interval.
    void on_interval_done(const IntervalResult& result);

    /// Whether the deflection is right within a thousandth of itself or of `farthest` [m].
    bool arrived(double farthest) const;

    const State& state() const { return state_; }
    void set_state(const State& state) { state_ = state; }
    /// All values are possible.
    static bool is_possible(const State&) { return true; }

private:
    double error() const { return compliance_ * state_.force - state_.given; }

    double compliance_;    ///< [m/N]
    double follow_time_;   ///< time in which an error decreases to 1/e [s]
    double max_catch_up_;  ///< largest fraction of an error that one interval corrects
    State state_;
    double change_ = 0;  ///< of `given` per step, in the current interval [m]
};

}  // namespace mcdem::sim
