// The amplitudes of one effect, or of several together, that fit a gap best, and what they gain over no
// effect.
#pragma once
#include "diagnose/infer/gap_space.h"

namespace mcdem::inline diagnose {

/// A candidate: its signature and the amplitudes that are plausible.
struct Candidate {
    const Signature* signature = nullptr;
    double low = 0, high = 0;
};

struct EffectFit {
    double amplitude = 0;
    double error =
        0;  ///< one sigma, from the slope of the signature there; infinite: the data do not show it
    double score = 0;  ///< gain in log likelihood over amplitude zero, nuisances marginalised in both
    bool at_bound = false;
};

/// One sigma of an amplitude by what packings differ in the effect and what its random draws do (the slopes
/// of the pairs, as the fit weighs cells), without the scatter that chaos makes in them.
double draw_error(const GapSpace& space, const Candidate& candidate, double amplitude);

/// Of several effects at once. An error counts that the other amplitudes are not known either; it is infinite
/// for all where the data do not show one of them or cannot tell them apart.
struct JointFit {
    std::vector<double> amplitudes, errors;  ///< one a candidate
    double score = 0;                        ///< as EffectFit::score
};

/// `gap`: observed less model, all cells.
JointFit fit_effects(const GapSpace& space, const std::vector<Candidate>& candidates,
                     const Eigen::VectorXd& gap);
EffectFit fit_effect(const GapSpace& space, const Candidate& candidate, const Eigen::VectorXd& gap);

}  // namespace mcdem::diagnose
