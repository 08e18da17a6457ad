// The verdict, from the few numbers that it hangs on: no data and no simulations behind it, so that
// thresholds can be studied on cases that were worked out once.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline diagnose {

/// Limits that decisions are made with. Set on one half of the challenge, scored on the other
/// (tests/challenge/README.md), but for `reduction`: over 108 gaps of an independent solver's, 63 of 63
/// leaders that took away 0.6 or more were right, and 41 of 45 that took away less were wrong.
struct Limits {
    double false_alarm = 0.01;  ///< p below which there is a gap
    double reduction = 0.6;     ///< part of the gap that is to be taken away for a name ..
    double over_placebo = 0.1;  ///< .. and by how much more than a placebo does
    double misfit = 0.001;      ///< p below which what one effect leaves is more than noise ..
    double remainder = 0.1;  ///< .. and the largest part of the gap that a named one may leave of that kind
    double pair_misfit = 0.05;    ///< .. above which what two leave is noise
    double pair_remainder = 0.5;  ///< .. or at most this part of what one leaves
    double group = 2.0;           ///< log likelihood by which members of a group differ at most ..
    double group_share = 0.01;    ///< .. or this part of the leader's gain
    double second_gain = 8.0;     ///< log likelihood that a second effect must gain ..
    double second_share = 0.02;   ///< .. and this part of the leader's gain
    double right_below = 0.1;  ///< probability that a leader is right that takes away less than `reduction`
    double reduction_error = 0.1;  ///< .. by this much,
    double right_above = 0.97;     ///< .. and of one that takes away
    double certain = 0.8;          ///< .. this much; in between it is in proportion
    double reduction_margin =
        0.1;  ///< what signatures get wrong in the reduction, on either side of its interval
};

/// One effect, or two together, and how well they do.
struct Proposal {
    std::vector<std::size_t> candidates;  ///< indices in Findings::names
    std::vector<double> amplitudes, errors;
    double gain = 0;      ///< in log likelihood over no effect, by the signatures
    double misfit_p = 1;  ///< of what it leaves, by the signatures
    std::optional<double> confirmed_gain, confirmed_misfit_p;  ///< .. by real runs
    double reduction = 0;  ///< part of the gap that it takes away (Findings::held_out), by the signatures
    std::optional<double> confirmed_reduction = {};  ///< .. by real runs
    double best_gain() const { return confirmed_gain.value_or(gain); }
    double best_misfit() const { return confirmed_misfit_p.value_or(misfit_p); }
    /// Nothing where no likelihood is gained: less left in some data is then bought by more in others.
    double best_reduction() const {
        const double known = confirmed_reduction.value_or(reduction);
        return best_gain() > 0 ? known : std::min(known, 0.0);
    }
};

struct Findings {
    double p_value = 1;               ///< of there being no gap
    std::vector<std::string> names;   ///< candidates: effects, then nuisances beyond their priors
    int effects = 0;                  ///< how many of them are effects
    std::vector<double> gain;         ///< by candidate, by the signatures
    std::vector<Proposal> proposals;  ///< single effects by gain, then the best pair
    bool held_out =
        true;            ///< reductions are of the gap on data held out; where those show none, of the whole
    double placebo = 0;  ///< reduction by the best of random signatures
    std::vector<std::size_t> numerics = {};  ///< effects that are the simulation's own numerics
    bool is_nuisance(std::size_t candidate) const { return static_cast<int>(candidate) >= effects; }
    bool is_numerical(std::size_t candidate) const { return std::ranges::count(numerics, candidate) > 0; }
};

struct Decision {
    Verdict verdict = Verdict::no_gap;
    int proposal = -1;               ///< index in Findings::proposals, -1: none
    std::vector<std::size_t> group;  ///< candidates that cannot be told apart, the leader first
    std::vector<double> confidence;  ///< by candidate: that it is the one, or one of a pair; what is missing
                                     ///< to one is for something unknown
};
Decision decide(const Findings& findings, const Limits& limits);

/// Proposals whose reductions the decision hangs on: the best single one, and a pair that gains enough over
/// it.
std::vector<std::size_t> contenders(const Findings& findings, const Limits& limits);

/// What the decided proposal takes away of the gap, and what it leaves; nothing without a proposal.
std::optional<Explanation> explanation_of(const Findings& findings, const Decision& decision,
                                          const Limits& limits);

}  // namespace mcdem::diagnose
