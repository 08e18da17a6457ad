// Proposals to be confirmed by real runs: the leading single effects, and the best pair.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/rearrangements.h"

namespace mcdem::inline diagnose {

/// `statistics` of the observed gap; `mean_of`: number of replicates in the baseline's mean.
std::vector<Proposal> propose(const GapSpace& space, const GapData& data, const NullDistribution& null,
                              const GapStatistics& statistics, int mean_of);

/// Evaluates the real runs of a proposal: its gain in log likelihood over no effect, including the cost of
/// its scatter and its free parameters (their determinants, and the prior of the `nuisances` of the runs),
/// and its misfit; if this is below `enough`, but not without one of the `places`, that one is left out. The
/// amplitude may still move with a prior of twice its error plus a quarter of its size, and the nuisances
/// within their priors; these steps are returned (nuisances, then amplitudes). Returns nothing if fewer than
/// two runs finished. In cells that a candidate lacks and the runs as well, nothing is gained and the gap
/// stays. `runs`: one row per replicate.
std::optional<Eigen::VectorXd> confirm(Proposal& proposal, const GapData& data, const NullDistribution& null,
                                       const std::vector<PlaceLeftOut>& places, double enough,
                                       const Eigen::VectorXd& observed, const Eigen::VectorXd& nuisances,
                                       const Eigen::MatrixXd& runs);

/// The runs that finished: packings may run away at amplitudes at which others do not.
Eigen::MatrixXd whole_runs(const Eigen::MatrixXd& runs, const CellChoice& cells);

/// Variance of the error of a proposal's signatures for one packing: packings differ in an effect, and a
/// tenth of a signature is uncertain.
Eigen::VectorXd signature_variance(const GapData& data, const Proposal& proposal);

/// The sum of a proposal's signatures at its amplitudes.
Eigen::VectorXd explained_by(const Proposal& proposal, const GapData& data);

}  // namespace mcdem::diagnose
