#include <algorithm>
#include <cmath>
#include <set>

#include "challenge/figure_values.h"
#include "cli/challenge/challenge_tables.h"
#include "report/diagnosis/diagnosis_json.h"

namespace mcdem::inline cli {
namespace {

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

/// No gap, effects, two of them, unknown, calibration.
std::vector<std::string> in_order(std::set<std::string> names) {
    std::vector<std::string> list;
    const auto take = [&](const std::string& name) {
        if (names.erase(name)) list.push_back(name);
    };
    take(verdict_name(Verdict::no_gap));
    std::vector<std::string> last;
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

ConfusionMatrix confusion_of(const std::vector<ScoredCase>& cases) {
    std::set<std::string> rows, columns;
    for (const ScoredCase& c : cases) {
        rows.insert(row_of(*c.truth));
        columns.insert(column_of(c.answer));
    }
    ConfusionMatrix matrix{in_order(rows), in_order(columns), {}};
    matrix.counts.assign(matrix.truths.size(), std::vector<int>(matrix.verdicts.size(), 0));
    for (const ScoredCase& c : cases)
        ++matrix.counts[place_in(matrix.truths, row_of(*c.truth))]
                       [place_in(matrix.verdicts, column_of(c.answer))];
    return matrix;
}

/// Values in bins with these upper edges; `point` adds one case to its bin.
template <class Point, class Add>
std::vector<Point> binned(const std::vector<double>& values, std::vector<double> edges, Add add) {
    edges.push_back(INFINITY);
    std::vector<Point> points(edges.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        const auto bin = std::ranges::upper_bound(edges, values[k]) - edges.begin();
        add(points[static_cast<std::size_t>(std::min<std::ptrdiff_t>(bin, std::ssize(edges) - 1))], k);
    }
    std::erase_if(points, [](const Point& point) { return point.cases == 0; });
    return points;
}

PowerCurve power_of(const std::vector<ScoredCase>& cases, double false_alarm) {
    std::vector<ScoredCase> single;
    std::vector<double> sizes;
    for (const ScoredCase& c : cases)
        if (c.over_limit > 0) {
            single.push_back(c);
            sizes.push_back(c.over_limit);
        }
    PowerCurve curve;
    curve.false_alarm = false_alarm;
    curve.points =
        binned<PowerPoint>(sizes, {0.35, 0.7, 1, 1.5, 3, 6, 12}, [&](PowerPoint& point, std::size_t k) {
            point.over_limit += (sizes[k] - point.over_limit) / ++point.cases;
            point.detected += single[k].answer.detected();
        });
    return curve;
}

std::vector<ConfidenceBin> confidences_of(const std::vector<ScoredCase>& cases) {
    std::vector<ScoredCase> named;
    std::vector<double> stated;
    for (const ScoredCase& c : cases)
        if (c.answer.names()) {
            named.push_back(c);
            stated.push_back(c.answer.confidence);
        }
    return binned<ConfidenceBin>(stated, {0.4, 0.6, 0.8, 0.95}, [&](ConfidenceBin& bin, std::size_t k) {
        bin.stated += (stated[k] - bin.stated) / ++bin.cases;
        bin.right += leads_rightly(named[k]);
    });
}

}  // namespace

nlohmann::ordered_json score_figure_values(const ChallengeScore& score) {
    nlohmann::ordered_json values = nlohmann::ordered_json::object();
    if (!score.scored.empty()) values["confusion"] = confusion_values(confusion_of(score.scored));
    if (const auto power = power_of(score.scored, score.arms.front().limits.false_alarm);
        !power.points.empty())
        values["power"] = power_values(power);
    if (const auto bins = confidences_of(score.scored); !bins.empty())
        values["confidence"] = confidence_values(bins);
    return values;
}

}  // namespace mcdem::cli
