// Stress control of a cell: each direction and each shear with a prescribed stress has its own controller.
// The shears, and the strains of the same move, change as fast as the other stresses can follow.
#pragma once
#include <array>
#include <optional>

#include "core/vec3.h"
#include "scene/programme/legs.h"
#include "sim/force_control.h"

namespace mcdem::inline sim {

class CellControl {
public:
    /// x, y, z, or a shear xy, xz, yz.
    struct Direction {
        ForceControl::State control;  ///< of a shear: of minus its stress
        double strain = 0;            ///< current strain, if its stress is prescribed
        double begin = 0;             ///< its stress at the start of the leg [Pa]
    };
    /// Plain values, stored in checkpoints.
    struct State {
        Strain begin{};    ///< at the start of the leg
        double drive = 0;  ///< current rate of the move's strains [1/s]
        std::array<Direction, 6> direction{};
        double stress(std::size_t axis) const;  ///< now [Pa]
    };

    CellControl(const Replica& replica, const PackingScale& scale);

    static void observe(State& state, const Mat3& stress, double duration);
    /// Starts a leg at these strains.
    static void begin_leg(State& state, const Strain& strain);
    /// The directions restart from rest.
    static void rest(State& state);
    /// Chooses the rates of the directions and, if `drives`, of the strains, at most `max_rate` [1/s].
    void steer(State& state, const SetStress& set, double duration, double max_rate, bool drives) const;
    /// Strain rates of the directions with a prescribed stress, limited by the allowed lengths of the cell.
    Strain rates(const State& state, const SetStress& set, double duration) const;

    double interval(const State& state, const SetStress& set) const;       ///< as ForceControl's [s]
    double drag(const State& state, const SetStress& set) const;           ///< [1/s]
    double approach_time(const State& state, const SetStress& set) const;  ///< [s]
    bool reached(const State& state, const SetStress& set) const;
    /// Fraction of the change of stress since the start of the leg; 1 at the target.
    static double done(const State& state, const SetStress& target);
    /// Change of stress in this leg, relative to its target.
    static double change(const State& state, const SetStress& target);
    /// The direction with the largest relative deviation from its prescribed stress.
    std::size_t farthest(const State& state, const SetStress& set) const;
    /// Whether the state can come from a valid checkpoint: all lengths are positive.
    static bool is_possible(const State& state);
    /// A direction that would have to exceed the allowed lengths of the cell.
    std::optional<std::size_t> stuck(const State& state, const SetStress& set) const;

private:
    ForceControl::Target target(const State& state, const SetStress& set, std::size_t axis) const;
    double distance(const State& state, const SetStress& set, std::size_t axis) const;
    double farthest_distance(const State& state, const SetStress& set) const;

    ForceControl control_;
    double min_load_;  ///< of a shear [Pa]
    Strain min_strain_{}, max_strain_{};
};

}  // namespace mcdem::sim
