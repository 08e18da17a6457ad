#include "challenge/ablations.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "diagnose/decide/diagnose.h"
#include "metrics/estimate.h"

namespace mcdem::inline challenge {
namespace {

/// Removes the observations in the cells of other observables.
template <class Wanted>
void observe_only(Evidence& evidence, Wanted wanted) {
    const auto cells = cells_of(evidence.library.grid);
    for (std::size_t k = 0; k < cells.size(); ++k)
        if (!wanted(observables()[cells[k].observable]))
            evidence.observed[static_cast<Eigen::Index>(k)] = not_available;
}

void as_it_is(Evidence&) {}

void without_conditional_observables(Evidence& evidence) {
    observe_only(evidence, [](const Observable& o) { return o.needs != Needs::positions; });
}

void top_force_alone(Evidence& evidence) {
    observe_only(evidence,
                 [](const Observable& o) { return o.needs == Needs::plate || o.needs == Needs::programme; });
}

void without_nuisances(Evidence& evidence) { evidence.nuisances.clear(); }

/// Uses the mean over the library's packings instead of the experiment's own packing, and their scatter
/// instead of that of replicates.
void without_pairing(Evidence& evidence) {
    Library& library = evidence.library;
    const int packings = 1 + *std::ranges::max_element(library.packing);
    evidence.library_is_own = true;  // the baseline is not of the experiment's packing
    evidence.baseline = Eigen::MatrixXd::Zero(packings, library.baseline.cols());
    std::vector<int> replicates(static_cast<std::size_t>(packings), 0);
    for (const int packing : library.packing) ++replicates[packing];
    // Every replicate represents a packing of its own; those of one packing stay in one fold of eight.
    const int step = (packings + 7) / 8 * 8;
    std::vector<int> seen(static_cast<std::size_t>(packings), 0);
    for (std::size_t r = 0; r < library.packing.size(); ++r) {
        const auto packing = static_cast<std::size_t>(library.packing[r]);
        evidence.baseline.row(library.packing[r]) +=
            library.baseline.row(static_cast<Eigen::Index>(r)) / replicates[packing];
        library.packing[r] += step * seen[packing]++;
    }
}

// clang-format off
const Ablation ablation_table[] = {
    {"without confirming runs", "signatures alone", as_it_is},
    {"without conditional observables", "nothing that needs positions", without_conditional_observables},
    {"without pairing", "the mean over other packings for runs of the experiment's own", without_pairing},
    {"without nuisances", "modulus and strain zero treated as exact", without_nuisances},
    {"top force alone", "one curve", top_force_alone},
};
// clang-format on

/// The effect with the largest gain in `space`, with its share of `exp(gain)`.
struct BestEffect {
    std::string name;
    double gain = 0, confidence = 0;
};

BestEffect best_effect(const GapSpace& space, const GapData& data) {
    BestEffect best;
    std::vector<double> gains;
    for (int c = 0; c < data.effects; ++c) {
        const Candidate& candidate = data.candidates[c];
        const double gain = gains.emplace_back(fit_effect(space, candidate, data.gap).score);
        if (gain >= best.gain) best = {candidate.signature->name, gain, 0};
    }
    double sum = 0;
    for (const double gain : gains) sum += std::exp(gain - best.gain);
    best.confidence = 1 / sum;
    return best;
}

/// Least squares in units of the scatter of each cell, without covariance and nuisances; always names an
/// effect.
Answer smallest_residual(const Evidence& evidence) {
    const GapData data = gap_data(evidence);
    const auto count = static_cast<Eigen::Index>(data.cells.size());
    Eigen::MatrixXd independent = Eigen::MatrixXd::Zero(count, data.noise.cols());
    for (Eigen::Index k = 0; k < count; ++k) {
        const auto cell = data.cells[k];
        independent(k, cell) = data.noise.col(cell).norm() /
                               std::sqrt(static_cast<double>(data.noise.rows())) *
                               std::sqrt(static_cast<double>(count));
    }
    return {Verdict::effect, {best_effect(GapSpace(independent, 0, data.cells, {}), data).name}, 1};
}

/// Schwarz 1978: an effect is accepted if it justifies its parameter; the method cannot abstain.
Answer bayesian_information(const Evidence& evidence) {
    const GapData data = gap_data(evidence);
    const GapSpace space(data.noise, static_cast<int>(evidence.baseline.rows()), data.cells, data.free);
    const BestEffect best = best_effect(space, data);
    if (2 * best.gain <= std::log(static_cast<double>(data.cells.size()))) return {};
    return {Verdict::effect, {best.name}, best.confidence};
}

// clang-format off
const SimplerMethod method_table[] = {
    {"RMSE ranking", "the effect with the smallest residual", smallest_residual},
    {"BIC", "the best effect, where its information criterion beats that of none", bayesian_information},
};
// clang-format on

}  // namespace

std::span<const Ablation> ablations() { return ablation_table; }
std::span<const SimplerMethod> simpler_methods() { return method_table; }

Findings ablated_findings(Evidence evidence, const Ablation& ablation) try {
    ablation.change(evidence);
    return DiagnosisBuilder(evidence, Limits{}).findings();
} catch (const InputError&) {
    return {};
}

}  // namespace mcdem::challenge
