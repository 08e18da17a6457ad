#include "diagnose/infer/detection_limits.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline diagnose {
namespace {

constexpr double power_of_four_fifths = 0.842;  // standard normal quantile

double expected_gain(const GapSpace& space, const Signature& signature, double amplitude) {
    return 0.5 * space.whiten(signature.at(amplitude)).squaredNorm();
}

/// Smallest amplitude between zero and `end` with a gain of `wanted`; infinite if there is none.
double smallest_amplitude(const GapSpace& space, const Signature& signature, double end, double wanted) {
    if (end == 0 || expected_gain(space, signature, end) < wanted) return INFINITY;
    double below = 0, above = end;
    for (int step = 0; step < 30; ++step) {
        const double middle = 0.5 * (below + above);
        (expected_gain(space, signature, middle) < wanted ? below : above) = middle;
    }
    return above;
}

}  // namespace

std::vector<DetectionLimit> detection_limits(const GapSpace& whole, const GapData& data,
                                             const NullDistribution& null, const Evidence& evidence,
                                             const Limits& limits) {
    // Bonferroni correction for two tests.
    const double threshold = null.quantile(&GapStatistics::directed, 0.5 * limits.false_alarm);
    const double wanted = 0.5 * std::pow(std::sqrt(2 * threshold) + power_of_four_fifths, 2);
    const GapSpace whole_fixed(data.noise, static_cast<int>(evidence.baseline.rows()), data.cells, {});
    std::vector<DetectionLimit> list;
    for (std::size_t c = 0; c < static_cast<std::size_t>(data.effects); ++c) {
        const Candidate& candidate = data.candidates[c];
        const GapSpace &space = whole.lacking(candidate.lacking),
                       &fixed = whole_fixed.lacking(candidate.lacking);
        DetectionLimit limit;
        limit.effect = data.name(c);
        limit.unit = evidence.candidates[c].unit;
        const double up = smallest_amplitude(space, *candidate.signature, candidate.high, wanted);
        const double down = smallest_amplitude(space, *candidate.signature, candidate.low, wanted);
        limit.minimum_amplitude = std::abs(down) < std::abs(up) ? std::abs(down) : up;
        const double probe = std::isfinite(up) ? up : candidate.high;
        const double alone = fixed.whiten(candidate.signature->at(probe)).squaredNorm();
        if (alone > 0)
            limit.absorbed_by_calibration = 1 - 2 * expected_gain(space, *candidate.signature, probe) / alone;
        const double twice = std::min(2 * probe, candidate.high);
        const GapStatistics as_if = gap_statistics(space, data, candidate.signature->at(twice));
        const double margin = limits.group_margin(as_if.fits[c].score);
        for (std::size_t other = 0; other < data.candidates.size(); ++other)
            if (other != c && as_if.fits[c].score - as_if.fits[other].score <= margin)
                limit.group.push_back(data.name(other));
        list.push_back(limit);
    }
    return list;
}

}  // namespace mcdem::diagnose
