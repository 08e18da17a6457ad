// Figures of a challenge as JSON, which host/python/mcdem/figures/challenge.py draws: confusion of truth and
// verdict, detection power, and calibration of stated probabilities.
#pragma once
#include <array>
#include <nlohmann/json.hpp>

#include "challenge/score.h"

namespace mcdem::inline challenge {

/// 95 % interval of a proportion (Wilson 1927); from 0 to 1 without trials.
std::array<double, 2> wilson_interval(int successes, int trials);

/// Ideal power curve: detection probability at an amplitude over the detection limit for a normal variate
/// with unit noise. `false_alarm`: that without an effect.
double ideal_power(double false_alarm, double over_limit);

/// Values of the available figures: confusion, power and confidence.
nlohmann::ordered_json score_figure_values(const ChallengeScore& score);

}  // namespace mcdem::challenge
