// The limits of decisions, set on cases whose truth is known and that are not scored.
#pragma once
#include <span>
#include <string_view>

#include "challenge/merits.h"

namespace mcdem::inline challenge {

/// Findings of a case, to be decided with limits that are tried.
struct LimitCase {
    const ChallengeCase* truth = nullptr;
    const Findings* findings = nullptr;
    double over_limit = 0;  ///< as in ScoredCase
};

/// What is asked of a challenge.
struct Bars {
    double false_alarms = 0.10, named_unknown = 0.10, named_outside_prior = 0.10;  ///< at most
    double group_size = 1.5;                                                       ///< at most
    double led_by_truth = 0.80, truth_in_group = 0.85;                             ///< at least
};

/// Sharpness, half the pairs found, and five times what is missing to each bar off that.
double objective(const Merits& merits);

/// The limits with the largest objective: one after the other over a few values each, until none moves. Of
/// equally good ones the nearest to the start, the defaults.
Limits choose_limits(std::span<const LimitCase> cases);

Merits merits_with(std::span<const LimitCase> cases, const Limits& limits);

/// The limits by name, for tables.
std::map<std::string_view, double> named_limits(const Limits& limits);

}  // namespace mcdem::challenge
