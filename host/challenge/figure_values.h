// Figures of how well diagnoses of withheld truths did: what was called what, how small an effect was seen,
// and whether stated probabilities hold. As JSON (figure_values.h).
#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mcdem::inline challenge {

/// How often which truth got which verdict.
struct ConfusionMatrix {
    std::vector<std::string> truths, verdicts;  ///< names of rows and of columns
    std::vector<std::vector<int>> counts;       ///< by truth, then verdict
};

/// Cases of similar amplitude.
struct PowerPoint {
    double over_limit = 0;  ///< amplitude over the predicted detection limit
    int detected = 0, cases = 0;
};

struct PowerCurve {
    std::vector<PowerPoint> points;
    double false_alarm = 0.05;    ///< part of the cases without an effect in which one is detected
    double power_at_limit = 0.8;  ///< part of the cases at the detection limit that are detected
};

/// Cases whose verdict was given with a similar probability.
struct ConfidenceBin {
    double stated = 0;  ///< mean of the probabilities
    int right = 0, cases = 0;
};

/// 95 % interval of a proportion (Wilson 1927); from 0 to 1 without trials.
std::array<double, 2> wilson_interval(int successes, int trials);

/// Part that is detected at an amplitude, over the detection limit, of a normal variate of unit noise: what
/// the points of a power curve scatter around when the limits are right.
double ideal_power(const PowerCurve& curve, double over_limit);

/// Nothing of these may be empty. Points without cases are left out.
nlohmann::ordered_json confusion_values(const ConfusionMatrix& matrix);
nlohmann::ordered_json power_values(const PowerCurve& curve);
nlohmann::ordered_json confidence_values(const std::vector<ConfidenceBin>& bins);

}  // namespace mcdem::challenge
