// Control of a plate that moves to a force and keeps it. The controller knows only the force at the ends of
// intervals and nothing about the packing. It works with rates: the speed is changed until the force
// approaches the target at a rate proportional to the remaining difference. The stiffness of the packing
// determines how fast the speed changes, not the final state. A direction of a cell with a prescribed stress
// is controlled in the same way, with stress in place of force [Pa] and the rate of the cell's length over
// its initial length in place of the plate's velocity [1/s]; so is a shear, with minus the rate of shear.
#pragma once
#include "scene/scene.h"
#include "sim/engine.h"
#include "sim/quasi_static.h"

namespace mcdem::inline sim {

class ForceControl {
public:
    static constexpr double least_caution = 0.25, most_caution = 1e3;
    /// Plain values, stored in checkpoints.
    struct State {
        double force = 0;     ///< at the end of the last interval [N]
        double rate = 0;      ///< rate of the force in the last interval [N/s]
        double velocity = 0;  ///< of the plate from now on, upward [m/s]
        /// Above 1, the stiffness of the packing over that which the controller would expect.
        double caution = least_caution;
    };

    /// Made from a force alone, differences are relative to that force.
    struct Target {
        Target(double set) : set(set), scale(set) {}
        double set;       ///< [N]
        double scale;     ///< differences are relative to this [N]
        double load = 0;  ///< force that stiffens the packing, if larger than the controlled one [N]
    };

    static ForceControl of_plate(const Replica& replica, const PackingScale& scale);
    /// One controller for each direction.
    static ForceControl of_cell(const Replica& replica, const PackingScale& scale);

    /// Records an interval: the `force` at its end [N] and its `duration` [s].
    static void observe(State& state, double force, double duration);
    /// Chooses the velocity towards the target, at most `max_speed` [m/s].
    void steer(State& state, const Target& target, double duration, double max_speed) const;
    /// A new target: the plate starts from rest.
    static void rest(State& state) { state.velocity = state.rate = 0; }

    /// Maximum duration of an interval, so that the plate reacts to the force in time [s].
    double interval(const State& state, const Target& target) const;
    /// Drag on the grains near the target [1/s], otherwise 0.
    double drag(const State& state, const Target& target) const;
    /// Time in which the remaining difference decreases to 1/e near the target [s].
    double approach_time(const State& state, const Target& target) const;
    /// Whether the force is within half of the tolerance.
    static bool reached(const State& state, const Target& target);
    /// Whether the state can come from a valid checkpoint.
    static bool is_possible(const State& state) {
        return state.caution >= least_caution && state.caution <= most_caution;
    }

private:
    ForceControl() = default;
    double far_speed(const State& state, const Target& target, double duration) const;
    static double layer_stiffness(double force, double layer);
    double stiffness(const State& state, const Target& target) const;
    double response_time(const State& state, const Target& target) const;

    double inertia_ = 0;       ///< mass of all grains [kg]; of a cell times length squared over volume
    double quiet_ = 0;         ///< relative distance from the target below which there is drag
    double layers_ = 1;        ///< layers of grains between floor and plate; of a cell, per metre
    double rigid_layers_ = 1;  ///< smallest number of layers that may deform
    double layer_ =
        0;  ///< coefficient in Hertz's law of a full layer of grains [N/m^(3/2)]; of a cell, over its area
    double stiffest_layer_ = 0;  ///< the same if all grains were of the stiffest species
};

}  // namespace mcdem::sim
