#include "challenge/figure_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline challenge {
namespace {

using Json = nlohmann::ordered_json;

constexpr double normal_quantile_975 = 1.959964;

Json names_json(const std::vector<std::string>& names) {
    Json words = Json::array();
    for (const auto& name : names) words.push_back(words_of(name));
    return words;
}

/// Appends a proportion with its interval.
void add_proportion(Json& points, double x, int successes, int trials) {
    points["x"].push_back(x);
    points["part"].push_back(double(successes) / trials);
    points["interval"].push_back(wilson_interval(successes, trials));
    points["cases"].push_back(trials);
}

}  // namespace

std::array<double, 2> wilson_interval(int successes, int trials) {
    if (trials <= 0) return {0, 1};
    const double n = trials, part = successes / n, z2 = normal_quantile_975 * normal_quantile_975;
    const double middle = (part + z2 / (2 * n)) / (1 + z2 / n);
    const double half =
        normal_quantile_975 / (1 + z2 / n) * std::sqrt(part * (1 - part) / n + z2 / (4 * n * n));
    return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

double ideal_power(const PowerCurve& curve, double over_limit) {
    const boost::math::normal normal;
    const double threshold = boost::math::quantile(normal, 1 - curve.false_alarm / 2);  // two-sided
    const double at_limit = threshold + boost::math::quantile(normal, curve.power_at_limit);
    const double mean = over_limit * at_limit;
    return boost::math::cdf(normal, mean - threshold) + boost::math::cdf(normal, -mean - threshold);
}

Json confusion_values(const ConfusionMatrix& matrix) {
    Json right = Json::array();
    for (std::size_t t = 0; t < matrix.truths.size(); ++t)
        for (std::size_t v = 0; v < matrix.verdicts.size(); ++v)
            if (matrix.truths[t] == matrix.verdicts[v]) right.push_back({t, v});
    return {{"truths", names_json(matrix.truths)},
            {"verdicts", names_json(matrix.verdicts)},
            {"cases", matrix.counts},
            {"right", right}};
}

Json power_values(const PowerCurve& curve) {
    Json json{{"x_label", "amplitude / predicted detection limit"}, {"y_label", "part that is detected"}};
    double smallest = 0.5, largest = 2;
    for (const auto& point : curve.points) {
        if (point.cases <= 0) continue;
        add_proportion(json["measured"], point.over_limit, point.detected, point.cases);
        smallest = std::min(smallest, point.over_limit);
        largest = std::max(largest, point.over_limit);
    }
    smallest /= 1.2, largest *= 1.2;
    for (int i = 0; i <= 100; ++i) {
        const double x = smallest * std::pow(largest / smallest, i / 100.0);
        json["predicted"]["x"].push_back(x);
        json["predicted"]["part"].push_back(ideal_power(curve, x));
    }
    json["words_predicted"] = fmt::format("as predicted: {:.2g} without an effect, {:.2g} at the limit",
                                          curve.false_alarm, curve.power_at_limit);
    return json;
}

Json confidence_values(const std::vector<ConfidenceBin>& bins) {
    Json json{{"x_label", "probability stated"}, {"y_label", "part that is right"}};
    for (const auto& bin : bins)
        if (bin.cases > 0) add_proportion(json["measured"], bin.stated, bin.right, bin.cases);
    json["predicted"] = {{"x", {0, 1}}, {"part", {0, 1}}};
    json["words_predicted"] = "as stated";
    return json;
}

}  // namespace mcdem::challenge
