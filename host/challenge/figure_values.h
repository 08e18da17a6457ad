// Figures of a challenge as JSON (report/run/figure_values.h): confusion of truth and verdict, detection
// power, and calibration of stated probabilities.
#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mcdem::inline challenge {

/// Number of cases by truth and verdict.
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
    double false_alarm = 0.05;    ///< fraction of the cases without an effect in which one is detected
    double power_at_limit = 0.8;  ///< fraction of the cases at the detection limit that are detected
};

/// Cases with similar stated probabilities.
struct ConfidenceBin {
    double stated = 0;  ///< mean of the stated probabilities
    int right = 0, cases = 0;
};

/// 95 % interval of a proportion (Wilson 1927); from 0 to 1 without trials.
std::array<double, 2> wilson_interval(int successes, int trials);

/// Ideal power curve: detection probability at an amplitude over the detection limit for a normal variate
/// with unit noise.
double ideal_power(const PowerCurve& curve, double over_limit);

/// The arguments must not be empty. Points without cases are left out.
nlohmann::ordered_json confusion_values(const ConfusionMatrix& matrix);
nlohmann::ordered_json power_values(const PowerCurve& curve);
nlohmann::ordered_json confidence_values(const std::vector<ConfidenceBin>& bins);

}  // namespace mcdem::challenge
