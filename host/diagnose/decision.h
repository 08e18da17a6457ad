// The verdict, from the few numbers that it hangs on: no data and no simulations behind it, so that
// thresholds can be studied on cases that were worked out once.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/diagnosis.h"

namespace mcdem {

/// Limits that decisions are made with. Set on one half of the challenge, scored on the other
/// (challenge/README.md).
struct Limits {
    double false_alarm = 0.01;   ///< p below which there is a gap
    double misfit = 0.001;       ///< p below which what one effect leaves is a gap of its own
    double pair_misfit = 0.05;   ///< .. what two leave: two can mimic much
    double group = 2.0;          ///< log likelihood by which members of a group differ at most ..
    double group_share = 0.01;   ///< .. or this part of the leader's gain
    double second_gain = 8.0;    ///< log likelihood that a second effect must gain ..
    double second_share = 0.02;  ///< .. and this part of the leader's gain
    double unknown_odds = 0.03;  ///< of an effect that the library lacks, before what is left was looked at
    double shrink_margin = 0.1;  ///< what signatures get wrong in the shrink, on either side of its interval
};

/// One effect, or two together, and how well they do.
struct Proposal {
    std::vector<std::size_t> candidates;  ///< indices in Findings::names
    std::vector<double> amplitudes, errors;
    double gain = 0;      ///< in log likelihood over no effect, by the signatures
    double misfit_p = 1;  ///< of what it leaves, by the signatures
    std::optional<double> confirmed_gain, confirmed_misfit_p;  ///< .. by real runs
    double best_gain() const { return confirmed_gain.value_or(gain); }
    double best_misfit() const { return confirmed_misfit_p.value_or(misfit_p); }
};

struct Findings {
    double p_value = 1;               ///< of there being no gap
    std::vector<std::string> names;   ///< candidates: effects, then nuisances beyond their priors
    int effects = 0;                  ///< how many of them are effects
    std::vector<double> gain;         ///< by candidate, by the signatures
    std::vector<Proposal> proposals;  ///< single effects by gain, then the best pair
    bool is_nuisance(std::size_t candidate) const { return static_cast<int>(candidate) >= effects; }
};

struct Decision {
    Verdict verdict = Verdict::no_gap;
    int proposal = -1;               ///< index in Findings::proposals, -1: none
    std::vector<std::size_t> group;  ///< candidates that cannot be told apart, the leader first
    std::vector<double> confidence;  ///< by candidate; what is missing to one is for something unknown
};
Decision decide(const Findings& findings, const Limits& limits);

}  // namespace mcdem
