#include "diagnose/identification.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mcdem {
namespace {

/// What the explanation leaves of the gap.
Eigen::VectorXd without(const Eigen::VectorXd& gap, const Setting& setting, const Explanation& explanation,
                        std::size_t but = SIZE_MAX) {
    Eigen::VectorXd left = gap;
    for (std::size_t k = 0; k < explanation.candidates.size(); ++k)
        if (k != but) left -= setting.candidates[explanation.candidates[k]].signature->at(explanation.fits[k].amplitude);
    return left;
}

/// Two effects together: one after the other, until neither moves.
Explanation fit_together(const Comparison& comparison, const Setting& setting, const Eigen::VectorXd& gap,
                         double omnibus, Explanation explanation) {
    for (int round = 0; round < 6; ++round)
        for (std::size_t k = 0; k < explanation.candidates.size(); ++k)
            explanation.fits[k] = fit_effect(comparison, setting.candidates[explanation.candidates[k]],
                                             without(gap, setting, explanation, k));
    explanation.remainder = comparison.whiten(without(gap, setting, explanation)).squaredNorm();
    explanation.gain = 0.5 * (omnibus - explanation.remainder);
    return explanation;
}

/// The best second effect beside the first.
Explanation best_pair(const Comparison& comparison, const Setting& setting, const Eigen::VectorXd& gap, double omnibus,
                      const Explanation& single) {
    Explanation best = single;
    for (std::size_t second = 0; second < setting.candidates.size(); ++second) {
        if (second == single.candidates[0]) continue;
        Explanation pair = single;
        pair.candidates.push_back(second);
        pair.fits.emplace_back();
        pair = fit_together(comparison, setting, gap, omnibus, pair);
        if (pair.gain > best.gain) best = pair;
    }
    return best;
}

/// Probabilities from gains: a gain that signatures may get wrong by a share counts less.
std::vector<double> confidences(const std::vector<EffectFit>& fits, double best, const Limits& limits) {
    const double unit = 1 + limits.group_share * best / limits.group;
    std::vector<double> all;
    double sum = 0;
    for (const EffectFit& fit : fits) sum += all.emplace_back(std::exp((fit.score - best) / unit));
    for (double& p : all) p /= sum;
    return all;
}

}  // namespace

Identification identify(const Comparison& comparison, const Setting& setting, const NullDistribution& null,
                        const GapStatistics& statistics, const Eigen::VectorXd& gap, const Limits& limits) {
    Identification id;
    id.order.resize(statistics.fits.size());
    std::iota(id.order.begin(), id.order.end(), std::size_t{0});
    std::ranges::stable_sort(id.order, [&](auto a, auto b) { return statistics.fits[a].score > statistics.fits[b].score; });
    id.confidence = confidences(statistics.fits, statistics.directed, limits);
    const double margin = std::max(limits.group, limits.group_share * statistics.directed);
    for (const std::size_t candidate : id.order)
        if (statistics.directed - statistics.fits[candidate].score <= margin && statistics.fits[candidate].score > 0)
            id.group.push_back(candidate);
    id.best = {{statistics.best}, {statistics.fits[statistics.best]}, statistics.directed, statistics.remainder};
    const auto misfit = [&](const Explanation& e) {
        return null.p_value(&GapStatistics::remainder, e.remainder - 2 * limits.surrogate_error * e.gain);
    };
    const Explanation pair = best_pair(comparison, setting, gap, statistics.omnibus, id.best);
    const bool worth = pair.gain - id.best.gain >
                       std::max(limits.second_gain, limits.second_share * id.best.gain);
    if (misfit(id.best) < limits.misfit && worth) id.best = pair;
    id.misfit_p = misfit(id.best);
    id.explained = id.misfit_p >= limits.misfit;
    return id;
}

Verdict verdict_of(const Identification& id, const Setting& setting, bool detected) {
    if (!detected) return Verdict::no_gap;
    if (!id.explained) return Verdict::unknown_effect;
    const auto is_effect = [&](std::size_t c) { return static_cast<int>(c) < setting.effects; };
    if (std::ranges::none_of(id.group, is_effect) || !is_effect(id.best.candidates[0])) return Verdict::calibration_suspect;
    return id.group.size() > 1 ? Verdict::group : Verdict::effect;
}

}  // namespace mcdem
