// Reduction of the gap by an effect. The effect's amplitude and the nuisances are fitted on loading up to 85
// % of the stroke. The gap is measured on the remaining data, once with only the nuisances refitted and once
// with the effect as well.
#pragma once
#include "diagnose/decide/diagnosis.h"
#include "diagnose/infer/proposals.h"

namespace mcdem::inline diagnose {

/// Fraction of the stroke that is fitted, loading only.
inline constexpr double fitted_part = 0.85;

/// Cells for the fit, and held-out cells.
struct Split {
    CellChoice fitted, held_out;
};
Split split_cells(const CellChoice& cells, const Grid& grid);

/// Gap without noise over cells, in squared sigmas: r'Dr - tr(D Sigma). `extra`: number of replicates whose
/// scatter was added to it.
double gap_size(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap, int mean_of,
                int extra = 0);

/// Gap on the held-out cells after the nuisances are fitted on the others, and its scatter without a gap.
struct HeldOutGap {
    double size = 0, noise = 0;
    bool shows() const { return size > 2 * noise; }
};
HeldOutGap held_out_gap(const GapData& data, const Split& split, int mean_of);

/// Fraction of the held-out gap taken away by the given candidates (one or two), fitted on the other cells.
/// Nothing of it is taken away in cells that a candidate lacks.
double held_out_reduction(const GapData& data, const Split& split, const std::vector<std::size_t>& candidates,
                          int mean_of);
/// The same for runs with the amplitudes fitted there; row: replicate. Empty if they failed. The gap stays as
/// it was in those `lacking` cells of the candidates in which some run has no value.
std::optional<double> reduction_by_runs(const GapData& data, const Split& split,
                                        const Eigen::VectorXd& observed, const Eigen::MatrixXd& runs,
                                        int mean_of, const CellChoice& lacking = {});
/// The same for the best of twenty random signatures.
double held_out_placebo(const GapData& data, const Split& split, int mean_of, std::uint64_t seed);
/// The same for the whole gap by likelihood: gain over `excess`, the gain if the whole gap were explained.
double whole_placebo(const GapSpace& space, const GapData& data, double excess, std::uint64_t seed);

/// Fits the given candidates (one or two) on `split.fitted` and measures on `split.held_out`. The interval is
/// from a bootstrap: the scatter of the replicates is added once more, and its size subtracted.
GapReduction measure_reduction(const GapData& data, const Split& split, const Proposal& proposal, int mean_of,
                               std::uint64_t seed);

/// Amplitudes fitted on the first part of the split, with the shifts of the nuisances: the settings of a
/// confirming run.
struct PartialFit {
    std::vector<double> amplitudes;
    Eigen::VectorXd nuisances;
};
/// After a step of nuisances and amplitudes, as far as simulations can follow it.
PartialFit stepped(const GapData& data, const std::vector<std::size_t>& candidates, PartialFit fit,
                   const Eigen::VectorXd& step);
PartialFit fit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap,
                    const std::vector<std::size_t>& candidates, int mean_of);

/// The same from runs with `at` that left `left` (observed minus their mean, of `mean_of` runs): one
/// Gauss-Newton step on these cells only. Nuisances start from zero again, so that they contain no
/// information from other cells.
PartialFit refit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& left,
                      const std::vector<std::size_t>& candidates, const PartialFit& at, int mean_of);

}  // namespace mcdem::diagnose
