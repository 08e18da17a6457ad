#include "challenge/figure_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <set>

#include "diagnose/decide/diagnosis_json.h"

namespace mcdem::inline challenge {
namespace {

using Json = nlohmann::ordered_json;

constexpr double normal_quantile_975 = 1.959964;
constexpr double power_at_limit = 0.8;  ///< fraction of the cases at the detection limit that are detected
const std::string two_effects = "two effects";

/// The right verdict.
std::string row_of(const ChallengeCase& truth) {
    switch (truth.kind) {
        case CaseKind::none:
            return verdict_name(Verdict::no_gap);
        case CaseKind::effect:
            return truth.effects.front().name;
        case CaseKind::pair:
            return two_effects;
        case CaseKind::unknown:
            return verdict_name(Verdict::unknown_effect);
        case CaseKind::outside_prior:
            break;
    }
    return verdict_name(Verdict::calibration_suspect);
}

std::string column_of(const Answer& answer) {
    if (!answer.names()) return verdict_name(answer.verdict);
    return answer.verdict == Verdict::effect && answer.group.size() == 2 ? two_effects : answer.group.front();
}

/// Order of rows and columns: no gap, single effects, two effects, unknown, not converged, calibration.
std::vector<std::string> in_order(std::set<std::string> names) {
    std::vector<std::string> list, last;
    if (names.erase(verdict_name(Verdict::no_gap))) list.push_back(verdict_name(Verdict::no_gap));
    for (const std::string& name :
         {two_effects, verdict_name(Verdict::unknown_effect), verdict_name(Verdict::not_converged),
          verdict_name(Verdict::calibration_suspect)})
        if (names.erase(name)) last.push_back(name);
    list.insert(list.end(), names.begin(), names.end());
    list.insert(list.end(), last.begin(), last.end());
    return list;
}

std::size_t place_in(const std::vector<std::string>& list, const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(list, name) - list.begin());
}

/// Number of cases by truth and verdict.
Json confusion_values(const std::vector<ScoredCase>& cases) {
    std::set<std::string> rows, columns;
    for (const ScoredCase& c : cases) {
        rows.insert(row_of(*c.truth));
        columns.insert(column_of(c.answer));
    }
    const auto truths = in_order(rows), verdicts = in_order(columns);
    std::vector<std::vector<int>> counts(truths.size(), std::vector<int>(verdicts.size(), 0));
    for (const ScoredCase& c : cases)
        ++counts[place_in(truths, row_of(*c.truth))][place_in(verdicts, column_of(c.answer))];
    Json right = Json::array();
    for (std::size_t t = 0; t < truths.size(); ++t)
        if (const auto v = place_in(verdicts, truths[t]); v < verdicts.size()) right.push_back({t, v});
    return {{"truths", truths}, {"verdicts", verdicts}, {"cases", counts}, {"right", right}};
}

/// Fraction of the cases that are hits, with its interval, in bins of `x_of` with these upper edges; null
/// for empty bins.
template <class X, class Hit>
Json measured(const std::vector<ScoredCase>& cases, std::vector<double> edges, X x_of, Hit is_hit) {
    struct Bin {
        double x = 0;  ///< mean
        int hits = 0, cases = 0;
    };
    edges.push_back(INFINITY);
    std::vector<Bin> bins(edges.size());
    for (const ScoredCase& c : cases) {
        const auto bin = std::ranges::upper_bound(edges, x_of(c)) - edges.begin();
        Bin& b = bins[std::min<std::ptrdiff_t>(bin, std::ssize(edges) - 1)];
        b.x += (x_of(c) - b.x) / ++b.cases;
        b.hits += is_hit(c);
    }
    Json points;
    for (const Bin& bin : bins) {
        if (bin.cases == 0) continue;
        points["x"].push_back(bin.x);
        points["part"].push_back(double(bin.hits) / bin.cases);
        points["interval"].push_back(wilson_interval(bin.hits, bin.cases));
        points["cases"].push_back(bin.cases);
    }
    return points;
}

/// Power against the amplitude over the predicted detection limit.
Json power_values(std::vector<ScoredCase> cases, double false_alarm) {
    std::erase_if(cases, [](const ScoredCase& c) { return !(c.over_limit > 0); });
    Json points = measured(
        cases, {0.35, 0.7, 1, 1.5, 3, 6, 12}, [](const ScoredCase& c) { return c.over_limit; },
        [](const ScoredCase& c) { return c.answer.detected(); });
    if (points.is_null()) return points;
    const double smallest = std::min(0.5, points["x"].front().get<double>()) / 1.2;
    const double largest = std::max(2.0, points["x"].back().get<double>()) * 1.2;
    Json json{{"x_label", "amplitude / predicted detection limit"},
              {"y_label", "fraction detected"},
              {"measured", points}};
    for (int i = 0; i <= 100; ++i) {
        const double x = smallest * std::pow(largest / smallest, i / 100.0);
        json["predicted"]["x"].push_back(x);
        json["predicted"]["part"].push_back(ideal_power(false_alarm, x));
    }
    json["words_predicted"] = fmt::format("as predicted: {:.2g} without an effect, {:.2g} at the limit",
                                          false_alarm, power_at_limit);
    return json;
}

/// Success rate of leading effects, named or not, against the probability that the diagnosis states.
Json confidence_values(std::vector<ScoredCase> cases) {
    std::erase_if(cases, [](const ScoredCase& c) { return !c.answer.leads(); });
    Json points = measured(
        cases, {0.2, 0.4, 0.6, 0.8, 0.95}, [](const ScoredCase& c) { return c.answer.confidence; },
        leader_is_true);
    if (points.is_null()) return points;
    return {{"x_label", "probability stated"},
            {"y_label", "fraction right"},
            {"measured", points},
            {"predicted", {{"x", {0, 1}}, {"part", {0, 1}}}},
            {"words_predicted", "as stated"}};
}

}  // namespace

std::array<double, 2> wilson_interval(int successes, int trials) {
    if (trials <= 0) return {0, 1};
    const double n = trials, part = successes / n, z2 = normal_quantile_975 * normal_quantile_975;
    const double middle = (part + z2 / (2 * n)) / (1 + z2 / n);
    const double half =
        normal_quantile_975 / (1 + z2 / n) * std::sqrt(part * (1 - part) / n + z2 / (4 * n * n));
    // exactly around the share, also where rounding would leave 0 or 1 of it outside
    return {std::clamp(middle - half, 0.0, part), std::clamp(middle + half, part, 1.0)};
}

double ideal_power(double false_alarm, double over_limit) {
    const boost::math::normal normal;
    const double threshold = boost::math::quantile(normal, 1 - false_alarm / 2);  // two-sided
    const double at_limit = threshold + boost::math::quantile(normal, power_at_limit);
    const double mean = over_limit * at_limit;
    return boost::math::cdf(normal, mean - threshold) + boost::math::cdf(normal, -mean - threshold);
}

Json score_figure_values(const ChallengeScore& score) {
    Json values = Json::object();
    if (!score.scored.empty()) values["confusion"] = confusion_values(score.scored);
    if (const Json power = power_values(score.scored, score.arms.front().limits.false_alarm);
        !power.is_null())
        values["power"] = power;
    if (const Json confidence = confidence_values(score.scored); !confidence.is_null())
        values["confidence"] = confidence;
    return values;
}

}  // namespace mcdem::challenge
