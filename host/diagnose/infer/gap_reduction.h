// How far does the gap shrink? The effect's amplitude and the nuisances are fitted on loading up to 85
// % of the stroke; the gap is measured on the rest, once with the nuisances refitted alone and once with the
// effect too.
#pragma once
#include "diagnose/decide/diagnosis.h"
#include "diagnose/infer/proposals.h"

namespace mcdem::inline diagnose {

/// Part of the stroke that is fitted, loading only.
inline constexpr double fitted_part = 0.85;

/// Cells that the fit may use and those held out.
struct Split {
    CellChoice fitted, held_out;
};
Split split_cells(const CellChoice& cells, const Grid& grid);

/// Gap without noise over cells, in squared sigmas: r'Dr - tr(D Sigma); `extra`: how many replicates' scatter
/// was added to it.
double gap_size(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap, int mean_of,
                int extra = 0);

/// Gap on the held-out cells once the nuisances are fitted on the others, and its scatter where there is
/// none.
struct HeldOutGap {
    double size = 0, noise = 0;
    bool shows() const { return size > 2 * noise; }
};
HeldOutGap held_out_gap(const GapData& data, const Split& split, int mean_of);

/// Part of the held-out gap that the candidates named (one or two) take away, fitted on the other cells.
double held_out_reduction(const GapData& data, const Split& split, const std::vector<std::size_t>& candidates,
                          int mean_of);
/// .. that runs with what was fitted there take away; row: replicate. Nothing where they failed.
std::optional<double> reduction_by_runs(const GapData& data, const Split& split,
                                        const Eigen::VectorXd& observed, const Eigen::MatrixXd& runs,
                                        int mean_of);
/// .. that the best of twenty random signatures takes away.
double held_out_placebo(const GapData& data, const Split& split, int mean_of, std::uint64_t seed);
/// The same of the whole gap by likelihood: gain over `excess`, what the whole gap would gain.
double whole_placebo(const GapSpace& space, const GapData& data, double excess, std::uint64_t seed);

/// Fit on `split.fitted` of the candidates named (one or two), measured on `split.held_out`. Interval by
/// bootstrap: the replicates' scatter is added once more, and its size taken off again.
GapReduction measure_reduction(const GapData& data, const Split& split, const Proposal& proposal, int mean_of,
                               std::uint64_t seed);

/// Amplitudes fitted on the split's first part, and the nuisances' shifts with them: what a confirming run is
/// made with.
struct PartialFit {
    std::vector<double> amplitudes;
    Eigen::VectorXd nuisances;
};
PartialFit fit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap,
                    const std::vector<std::size_t>& candidates, int mean_of);

/// The same from runs that were made with `at` and left `left` (observed less their mean, of `mean_of` runs):
/// a step of Gauss and Newton's method on the cells alone. Nuisances start from zero again, so that nothing
/// of the other cells is kept in them.
PartialFit refit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& left,
                      const std::vector<std::size_t>& candidates, const PartialFit& at, int mean_of);

}  // namespace mcdem::diagnose
