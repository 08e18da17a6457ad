// Findings from which decisions are tested.
#pragma once
#include "diagnose/decide/decision.h"

namespace mcdem {

/// A gap reduction of nearly the whole gap.
inline Proposal proposal(std::vector<std::size_t> candidates, double gain, double misfit_p,
                         double reduction = 0.96) {
    Proposal p;
    p.amplitudes.assign(candidates.size(), 1);
    p.errors.assign(candidates.size(), 0.1);
    p.candidates = std::move(candidates);
    p.gain = gain;
    p.misfit_p = misfit_p;
    p.reduction = reduction;
    return p;
}

/// Four effects, a nuisance beyond its prior, and a clear gap that the second effect explains.
inline Findings clear_case() {
    Findings f;
    f.p_value = 1e-4;
    f.names = {"adhesion", "friction", "plasticity", "plate_tilt", "modulus"};
    f.effects = 4;
    f.gain = {10, 50, 2, 0, 20};
    f.proposals = {proposal({1}, 50, 0.5), proposal({4}, 20, 1e-6, 0.3)};
    f.placebo = 0.1;
    return f;
}

}  // namespace mcdem
