// Computes the verdict from a small set of numbers, without data and simulations, so that thresholds can be
// studied on stored cases.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline diagnose {

/// Thresholds of the decision. They were set on one half of the challenge and scored on the other
/// (tests/challenge/README.md), except `reduction`: in 108 gaps from an independent solver, 63 of 63 leading
/// effects that took away 0.6 or more were right, and 41 of 45 that took away less were wrong.
struct Limits {
    double false_alarm = 0.01;    ///< there is a gap if p is smaller
    double reduction = 0.6;       ///< fraction of the gap that an effect must take away to be named,
    double min_reduction = 0.3;   ///< less by its noise, but this at least, if one effect leaves only noise,
    double over_placebo = 0.1;    ///< and by how much this must exceed the placebo's
    double pair_reduction = 0.8;  ///< the least fraction that a pair must take away
    double misfit = 0.001;        ///< the remainder of one effect exceeds noise if its p is smaller;
    double remainder = 0.3;       ///< largest fraction of the gap that a named effect may leave beyond noise,
    double another_form = 1e-10;  ///< and if p is smaller than this: another effect may be the cause, so it
    double form_remainder = 0.1;  ///< may leave only this fraction
    double only_noise = 0.05;     ///< the remainder of one effect is only noise if its p is at least this,
    double pair_misfit = 0.02;    ///< that of a pair, which is named only then, at least this
    double group = 2.0;           ///< largest difference in log likelihood within a group,
    double group_share = 0.01;    ///< or this fraction of the leading effect's gain
    double second_gain = 8.0;     ///< gain in log likelihood required of a second effect,
    double second_share = 0.02;   ///< and this fraction of the leading effect's gain,
    double second_certain =
        50;  ///< but not more than this; it then counts even if one effect leaves only noise
    double right_below = 0.1;    ///< probability that a leading effect is right if the fraction that it takes
    double doubt_below = 0.4;    ///< away is less than required to name it by this much,
    double right_above = 0.98;   ///< and if it takes away
    double certain_above = 0.2;  ///< this much more than required; linear in between
    double right_form = 0.4;     ///< instead of `right_above` if p is smaller than `another_form`
    double right_refused = 0.5;  ///< largest probability of an effect that is not named
    double reduction_margin = 0.1;  ///< error of the reduction by signatures, on either side of its interval
    /// p-value of the remainder below which a proposal leaves more than noise.
    double enough(bool pair) const { return pair ? pair_misfit : misfit; }
    /// Largest difference in log likelihood within the group of an effect with this gain.
    double group_margin(double gain) const { return std::max(group, group_share * gain); }
    /// Gain in log likelihood required of a second effect beside one with this gain.
    double second_margin(double gain) const {
        return std::max(second_gain, std::min(second_share * gain, second_certain));
    }
};

/// One effect or a pair, and how well it explains the gap.
struct Proposal {
    std::vector<std::size_t> candidates;  ///< indices in Findings::names
    std::vector<double> amplitudes, errors;
    double gain = 0;      ///< in log likelihood over no effect, from signatures
    double misfit_p = 1;  ///< p-value of the remainder, from signatures
    std::optional<double> confirmed_gain, confirmed_misfit_p;  ///< the same from real runs
    double reduction = 0;  ///< fraction of the gap that it takes away (Findings::held_out), from signatures
    std::optional<double> confirmed_reduction = {};  ///< the same from real runs
    std::optional<int> left_out = {};  ///< place of the grid without which the runs leave no more than noise:
                                       ///< grains may have rearranged there; reductions are without it, too
    double rest_misfit_p = 0;          ///< p-value of the remainder without it
    bool is_pair() const { return candidates.size() == 2; }
    double best_gain() const { return confirmed_gain.value_or(gain); }
    double whole_misfit() const { return confirmed_misfit_p.value_or(misfit_p); }
    double best_misfit() const { return left_out ? rest_misfit_p : whole_misfit(); }
    /// At most zero without a gain in likelihood: a smaller remainder in some data then costs more in others.
    double best_reduction() const {
        const double known = confirmed_reduction.value_or(reduction);
        return best_gain() > 0 ? known : std::min(known, 0.0);
    }
};

struct Findings {
    double p_value = 1;               ///< probability of the data without a gap
    std::vector<std::string> names;   ///< candidates: effects, then nuisances beyond their priors
    int effects = 0;                  ///< number of effects among them
    std::vector<double> gain;         ///< by candidate, from signatures
    std::vector<Proposal> proposals;  ///< single effects by gain, then the best pair
    bool held_out =
        true;  ///< reductions are of the gap in held-out data; false: these show no gap, so of the whole gap
    double held_out_noise = 0;  ///< noise of these reductions, as a fraction of the gap in held-out data
    double placebo = 0;         ///< reduction by the best of random signatures
    std::vector<std::size_t> numerics = {};  ///< effects that are the simulation's own numerics
    bool is_nuisance(std::size_t candidate) const { return static_cast<int>(candidate) >= effects; }
    bool is_numerical(std::size_t candidate) const { return std::ranges::count(numerics, candidate) > 0; }
};

struct Decision {
    Verdict verdict = Verdict::no_gap;
    int proposal = -1;               ///< index in Findings::proposals, -1: none
    std::vector<std::size_t> group;  ///< candidates that cannot be distinguished, the leading one first
    std::vector<double> confidence;  ///< by candidate: probability that it is the cause, or one of a pair;
                                     ///< the rest to one is the probability of an unknown effect
};
/// The proposal of a decision that has one.
inline const Proposal& chosen_proposal(const Findings& findings, const Decision& decision) {
    return findings.proposals[decision.proposal];
}
Decision decide(const Findings& findings, const Limits& limits);

/// Proposals whose reductions the decision depends on: the best single one, and a pair with a sufficient
/// additional gain.
std::vector<std::size_t> contenders(const Findings& findings, const Limits& limits);

/// What the chosen proposal explains and what it leaves; nothing without a proposal.
std::optional<Explanation> explanation_of(const Findings& findings, const Decision& decision,
                                          const Limits& limits);

}  // namespace mcdem::diagnose
