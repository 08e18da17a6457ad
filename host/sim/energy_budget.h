// Energy budget of a replica since its first report: the work done on the grains, what they store, and what
// is dissipated. Kernels sum the work of every step (Track::work). The dissipated energy cannot fall: if it
// does, the time step creates energy.
#pragma once
#include "scene/scene.h"
#include "sim/engine.h"
#include "sim/quasi_static.h"

namespace mcdem::inline sim {

/// As in Scan (core/recording.h) [J].
struct EnergyTerms {
    double wall_work = 0, weight_work = 0, damping_loss = 0, friction_loss = 0, drag_loss = 0;
    double energy_error = 0;
};

class EnergyBudget {
public:
    /// Plain values, stored in checkpoints [J].
    struct State {
        EnergyTerms terms;
        double stored_at_start = 0;   ///< kinetic and elastic energy
        double springs_at_start = 0;  ///< of them, in springs of friction and rolling resistance
        double rubbed = 0;            ///< work of tangential forces and couples, springs included
        double dissipated = 0;        ///< work minus change of the stored energy
        double most_dissipated = 0;   ///< its largest value since the last correction
        double most_stored = 0;       ///< largest stored energy so far
        double created = 0;           ///< by the time step, up to the last correction
        double begun = 0;             ///< 1 after the first report
    };

    EnergyBudget(const Replica& replica, const PackingScale& scale);
    void add(const IntervalResult& result);
    const EnergyTerms& terms() const { return state_.terms; }

    enum class Verdict { sound, creates_energy, too_much_created };
    /// Whether the dissipated energy has fallen. After creates_energy, call correct().
    Verdict verdict() const;
    /// The time step has been shortened: the energy created so far is kept in mind, and the budget begins
    /// anew.
    void correct();
    /// Energy created so far over the largest stored energy.
    double created() const;

    const State& state() const { return state_; }
    void set_state(const State& state) { state_ = state; }
    static bool is_possible(const State& state);

private:
    double tolerance_;
    double least_energy_;  ///< below it rounding matters [J]
    State state_;
};

}  // namespace mcdem::sim
