// A plate that goes to a force and stays there. It knows the force at interval ends only and nothing of the
// packing, so that it acts on rates: the speed changes until the force approaches the one set at a rate in
// proportion to what is left. How stiff the packing is decides how fast the speed changes, not where it ends.
// A cell's direction goes to a stress in the same way: stress in place of force [Pa], the rate of the cell's
// length over that at start in place of the plate's velocity [1/s].
#pragma once
#include "scene/scene.h"
#include "sim/engine.h"
#include "sim/quasi_static.h"

namespace mcdem::inline sim {

class ForceControl {
public:
    /// Plain values, so that a checkpoint can hold them.
    struct State {
        double force = 0;     ///< on the plate at the end of the last interval, upward [N]
        double rate = 0;      ///< of the force in it [N/s]
        double velocity = 0;  ///< of the plate from now on, upward [m/s]
    };

    static ForceControl of_plate(const Replica& replica, const PackingScale& scale);
    /// One for every direction.
    static ForceControl of_cell(const Replica& replica, const PackingScale& scale);

    /// Takes note of an interval: `force` at its end [N], its `duration` [s].
    static void observe(State& state, double force, double duration);
    /// Chooses the velocity towards `set` [N], at most `max_speed` [m/s].
    void steer(State& state, double set, double duration, double max_speed) const;
    /// A new target: the plate starts from rest.
    static void rest(State& state) { state.velocity = state.rate = 0; }

    /// How long an interval may be, so that the plate hears of the force in time [s].
    double interval(const State& state, double set) const;
    /// So near that grains' motion is drag's to end: the drag [1/s], or 0.
    double drag(const State& state, double set) const;
    /// In which what is left shrinks to 1/e, near the force [s].
    double approach_time(const State& state, double set) const;
    /// Within half of what is asked for.
    static bool reached(const State& state, double set);

private:
    ForceControl() = default;
    double far_speed(double left, double force, double duration) const;
    static double layer_stiffness(double force, double layer);
    double stiffness(const State& state, double set) const;
    double response_time(const State& state, double set) const;

    double inertia_ = 0;       ///< mass of all grains [kg]; of a cell times length squared over volume
    double quiet_ = 0;         ///< relative distance of a force from which on there is drag
    double layers_ = 1;        ///< of grains between floor and plate; of a cell, in a metre
    double rigid_layers_ = 1;  ///< the fewest that may deform
    double layer_ = 0;  ///< of the Hertz law of all grains of a layer [N/m^(3/2)]; of a cell, over its area
    double stiffest_layer_ = 0;  ///< .. were all of the stiffest species
};

}  // namespace mcdem::sim
