// How far does the gap shrink? The effect's amplitude and the nuisances are fitted on loading up to four
// fifths of the stroke; the gap is measured on the rest, once with the nuisances refitted alone and once with
// the effect too.
#pragma once
#include "diagnose/diagnosis.h"
#include "diagnose/proposals.h"

namespace mcdem {

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

/// Fit on `split.fitted` of the candidates named (one or two), measured on `split.held_out`. Interval by
/// bootstrap: the replicates' scatter is added once more, and its size taken off again; placebo: the best of
/// as many random signatures.
Shrink measure_shrink(const GapData& data, const Split& split, const Proposal& proposal, int mean_of,
                      std::uint64_t seed);

/// Amplitudes fitted on the split's first part, and the nuisances' shifts with them: what a confirming run is
/// made with.
struct PartialFit {
    std::vector<double> amplitudes;
    Eigen::VectorXd nuisances;
};
PartialFit fit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap,
                    const std::vector<std::size_t>& candidates, int mean_of);

}  // namespace mcdem
