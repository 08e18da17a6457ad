// Maximum-likelihood amplitudes of one or several effects for a gap, and their gain over no effect.
#pragma once
#include "diagnose/infer/gap_space.h"

namespace mcdem::inline diagnose {

/// A candidate: its signature and the range of plausible amplitudes.
struct Candidate {
    const Signature* signature = nullptr;
    double low = 0, high = 0;
    /// Cells without a value of the signature, which is zero there. The candidate is fitted on the others,
    /// so these cells gain nothing, and their gap counts as unexplained by it.
    CellChoice lacking = {};
};
/// Cells that one of the candidates lacks.
CellChoice lacking_cells(const std::vector<Candidate>& candidates);

struct EffectFit {
    double amplitude = 0;
    double error = 0;  ///< one sigma, from the slope of the signature at the amplitude; infinite: the data do
                       ///< not show the effect
    double score = 0;  ///< gain in log likelihood over amplitude zero, with nuisances marginalised in both
    bool at_bound = false;
};

/// One sigma of an amplitude from differences of the effect between packings and from its random draws (the
/// slopes of the pairs, with the weights of the fit), without the scatter from chaos.
double draw_error(const GapSpace& space, const Candidate& candidate, double amplitude);

/// Joint fit of several effects. The errors include the uncertainty of the other amplitudes. They are all
/// infinite if the data do not show one of the effects or cannot distinguish them.
struct JointFit {
    std::vector<double> amplitudes, errors;  ///< one per candidate
    double score = 0;                        ///< like EffectFit::score
};

/// `gap`: observed minus model, all cells.
JointFit fit_effects(const GapSpace& space, const std::vector<Candidate>& candidates,
                     const Eigen::VectorXd& gap);
EffectFit fit_effect(const GapSpace& space, const Candidate& candidate, const Eigen::VectorXd& gap);

}  // namespace mcdem::diagnose
