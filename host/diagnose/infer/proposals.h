// Explanations worth a real run: the leading effects one by one, and the best two together.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// `statistics` of the observed gap; `mean_of`: replicates behind the baseline's mean.
std::vector<Proposal> propose(const GapSpace& space, const GapData& data, const NullDistribution& null,
                              const GapStatistics& statistics, int mean_of);

/// What real runs say of a proposal: its gain in log likelihood over no effect, with what its scatter and its
/// free parameters cost (their determinants, and the prior of the `nuisances` that it was run with), and its
/// misfit. Within its error and a quarter of its size the amplitude may still move, and the nuisances within
/// their priors: the steps that they take are returned (nuisances, then amplitudes). Nothing where fewer than
/// two runs came to their end. `runs`: row a replicate.
std::optional<Eigen::VectorXd> confirm(Proposal& proposal, const GapData& data, const NullDistribution& null,
                                       const Eigen::VectorXd& observed, const Eigen::VectorXd& nuisances,
                                       const Eigen::MatrixXd& runs);

/// The runs that came to their end: packings may run away at amplitudes at which others hold.
Eigen::MatrixXd whole_runs(const Eigen::MatrixXd& runs, const CellChoice& cells);

/// Variance by which a proposal's signatures may be wrong for one packing: packings differ in an effect, and
/// a tenth of a signature is not known.
Eigen::VectorXd signature_variance(const GapData& data, const Proposal& proposal);

/// The sum of a proposal's signatures, or its best fit on other cells.
Eigen::VectorXd explained_by(const Proposal& proposal, const GapData& data);

}  // namespace mcdem::diagnose
