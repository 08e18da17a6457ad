// Sets the limits of decisions with cases whose truth is known and that are not scored.
#pragma once
#include <span>
#include <string_view>

#include "challenge/merits.h"

namespace mcdem::inline challenge {

/// Findings of a case, to be decided with trial limits.
struct LimitCase {
    const ChallengeCase* truth = nullptr;
    const Findings* findings = nullptr;
    double over_limit = 0;  ///< as in ScoredCase
};

/// Targets of a challenge.
struct Bars {
    double false_alarms = 0.10, named_unknown = 0.10, named_outside_prior = 0.10;  ///< at most
    double group_size = 1.5;                                                       ///< at most
    double led_by_truth = 0.80, truth_in_group = 0.85;                             ///< at least
};

/// Sharpness plus half the fraction of found pairs, minus five times the shortfall from each target.
double objective(const Merits& merits);

/// The limits with the largest objective: one limit after the other is varied over a few values until none
/// changes. Among equally good limits, those nearest to the defaults.
Limits choose_limits(std::span<const LimitCase> cases);

Merits merits_with(std::span<const LimitCase> cases, const Limits& limits);

/// The limits by name, for tables.
std::map<std::string_view, double> named_limits(const Limits& limits);

}  // namespace mcdem::challenge
