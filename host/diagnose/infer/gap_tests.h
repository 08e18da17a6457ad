// Is there a gap? An omnibus test (anything at all) and a directed one (something that looks like a known
// effect), both ranked against replicates sent through the same comparison.
#pragma once
#include "diagnose/infer/evidence.h"

namespace mcdem::inline diagnose {

/// Statistics of one gap.
struct GapStatistics {
    double omnibus = 0;           ///< chi-square, nuisances marginalised
    double directed = 0;          ///< largest gain in log likelihood of a candidate
    double remainder = 0;         ///< chi-square after the best candidate
    double highest_refitted = 0;  ///< largest |gap|/sigma of a cell after the nuisances were refitted
    double pattern_left = 0;      ///< highest_pattern of what the best candidate leaves
    std::vector<EffectFit> fits;  ///< by candidate
    std::size_t best = 0;
};
GapStatistics gap_statistics(const GapSpace& space, const GapData& data, const Eigen::VectorXd& gap);

/// The simple pattern that a gap shows most strongly once nuisances are refitted, over its sigma: a cell, the
/// mean over the cells of an observable, or their trend from the first to the last one that the plate passes.
double highest_pattern(const GapSpace& space, const Eigen::VectorXd& gap);

/// What the statistics are where there is no gap: replicates, each compared without its own part in the
/// noise, with nuisances drawn from their priors.
class NullDistribution {
public:
    NullDistribution(const GapData& data, int mean_of, std::uint64_t seed);
    /// Probability of a statistic at least as large in one more replicate: by Student's t of its cube root,
    /// whose mean and variance are the replicates'.
    double p_value(double GapStatistics::*statistic, double value) const;
    /// Probability that what an explanation leaves is noise: by its chi-square over all cells, in which a gap
    /// of few cells drowns, and by its highest pattern, which sees no gap that is spread thin. The smaller
    /// one, doubled.
    double misfit_p(const GapSpace& space, const Eigen::VectorXd& left) const;
    /// The value that a part `p` of the null exceeds.
    double quantile(double GapStatistics::*statistic, double p) const;
    double mean(double GapStatistics::*statistic) const;
    const std::vector<GapStatistics>& draws() const { return draws_; }

private:
    int replicates() const;
    std::vector<GapStatistics> draws_;
};

}  // namespace mcdem::diagnose
