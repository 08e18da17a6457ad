// Which effect? The candidates by what they gain, the group that the data cannot tell apart, and whether what is left
// is a gap of its own.
#pragma once
#include <optional>

#include "diagnose/diagnosis.h"
#include "diagnose/gap_tests.h"

namespace mcdem {

/// One effect, or two together, at their best amplitudes.
struct Explanation {
    std::vector<std::size_t> candidates;  ///< indices in Setting::candidates
    std::vector<EffectFit> fits;
    double gain = 0;       ///< in log likelihood, all together
    double remainder = 0;  ///< chi-square that is left
};

struct Identification {
    std::vector<std::size_t> order;   ///< candidates, best first
    std::vector<double> confidence;   ///< by candidate
    std::vector<std::size_t> group;   ///< of the best, itself first
    Explanation best;
    double misfit_p = 1;              ///< of what is left
    bool explained = false;
};

/// `statistics` of the observed gap.
Identification identify(const Comparison& comparison, const Setting& setting, const NullDistribution& null,
                        const GapStatistics& statistics, const Eigen::VectorXd& gap, const Limits& limits);

Verdict verdict_of(const Identification& identification, const Setting& setting, bool detected);

}  // namespace mcdem
