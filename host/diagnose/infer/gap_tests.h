// Tests for a gap: an omnibus test (any difference) and a directed test (a difference similar to a known
// effect), both ranked against replicates that go through the same comparison.
#pragma once
#include <map>

#include "diagnose/infer/evidence.h"

namespace mcdem::inline diagnose {

/// Statistics of one gap.
struct GapStatistics {
    double omnibus = 0;           ///< chi-square with nuisances marginalised
    double directed = 0;          ///< largest gain in log likelihood of any candidate
    double remainder = 0;         ///< chi-square after the best candidate
    double highest_refitted = 0;  ///< largest |gap|/sigma of a cell after refitting the nuisances
    double pattern_left = 0;      ///< highest_pattern of the gap that the best candidate leaves
    std::vector<EffectFit> fits;  ///< by candidate
    std::size_t best = 0;
};
GapStatistics gap_statistics(const GapSpace& space, const GapData& data, const Eigen::VectorXd& gap);

/// Significance of the strongest simple pattern in a gap after refitting the nuisances: a cell, the mean over
/// the cells of an observable, or their trend in the order in which the plate passes them.
double highest_pattern(const GapSpace& space, const Eigen::VectorXd& gap);

/// Distribution of the statistics without a gap: each replicate is compared without its own contribution to
/// the noise, with nuisances drawn from their priors.
class NullDistribution {
public:
    NullDistribution(const GapData& data, int mean_of, std::uint64_t seed);
    /// Probability of a statistic at least as large without a gap, from Student's t of its cube root with the
    /// mean and the variance of the replicates.
    double p_value(double GapStatistics::*statistic, double value) const;
    /// Probability that the remainder of an explanation is noise: Bonferroni correction for two tests, its
    /// chi-square over all cells (insensitive to gaps in few cells) and its highest pattern (insensitive to
    /// gaps spread over many cells). Student's t has the degrees of freedom of all replicates, with which
    /// the limits of the verdict were set.
    double misfit_p(const GapSpace& space, const Eigen::VectorXd& left) const;
    /// The value that a fraction `p` of the null distribution exceeds.
    double quantile(double GapStatistics::*statistic, double p) const;
    double mean(double GapStatistics::*statistic) const;
    /// By packing, the experiment's own first. Without replicates of its own: all of them under 0.
    const std::map<int, std::vector<GapStatistics>>& draws() const { return draws_; }

private:
    std::map<int, std::vector<GapStatistics>> draws_;
};

}  // namespace mcdem::diagnose
