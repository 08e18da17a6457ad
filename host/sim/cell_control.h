// A cell that goes to stresses: each direction whose stress is set has a control of its own, and the strains
// of the same move go as fast as the stresses can follow.
#pragma once
#include <array>
#include <optional>

#include "core/vec3.h"
#include "scene/legs.h"
#include "sim/force_control.h"

namespace mcdem::inline sim {

class CellControl {
public:
    /// x, y or z.
    struct Direction {
        ForceControl::State control;
        double strain = 0;  ///< now, where its stress is set
        double begin = 0;   ///< its stress when the leg began [Pa]
    };
    /// Plain values, so that a checkpoint can hold them.
    struct State {
        Strain begin{};    ///< when the leg began
        double drive = 0;  ///< the rate of a move's strains [1/s]
        std::array<Direction, 3> direction{};
    };

    CellControl(const Replica& replica, const PackingScale& scale);

    static void observe(State& state, const Mat3& stress, double duration);
    /// A leg begins at these strains.
    static void begin_leg(State& state, const Strain& strain);
    /// The directions start anew from rest.
    static void rest(State& state);
    /// Chooses how fast the directions go, and the strains where `drives`, at most `max_rate` [1/s].
    void steer(State& state, const SetStress& set, double duration, double max_rate, bool drives) const;
    /// Rates of strain of the directions with a stress; they stay within the lengths that the cell may have.
    Strain rates(const State& state, const SetStress& set, double duration) const;

    double interval(const State& state, const SetStress& set) const;       ///< as ForceControl's [s]
    double drag(const State& state, const SetStress& set) const;           ///< [1/s]
    double approach_time(const State& state, const SetStress& set) const;  ///< [s]
    static bool reached(const State& state, const SetStress& set);
    /// Part of the way from the stresses that the leg began with.
    static double done(const State& state, const SetStress& target);
    /// By how much the leg changes stresses, over those that it ends at.
    static double change(const State& state, const SetStress& target);
    /// The direction whose stress is farthest from the one set.
    static std::size_t farthest(const State& state, const SetStress& set);
    /// Whether a checkpoint may say so: no length is lost.
    static bool is_possible(const State& state);
    /// A direction that would have to become shorter, or longer, than the cell may be.
    std::optional<std::size_t> stuck(const State& state, const SetStress& set) const;

private:
    ForceControl control_;
    std::array<double, 3> max_strain_;
};

}  // namespace mcdem::sim
