#include "ensemble/diagnosis/library_trials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/errors.h"

namespace mcdem::inline ensemble {
namespace {

/// Amplitudes of the paired runs of a nuisance: on both sides of the model, so that its slope there is
/// accurate.
constexpr double nuisance_step = 1.0;  // sigmas

}  // namespace

std::vector<Probe> probes_of(const LibraryPlan& plan) {
    const Model& model = plan.packings.front().model;
    std::vector<Probe> probes;
    for (const std::string& name : plan.candidates) {
        const Effect& effect = *find_effect(name);
        const double scale = effect.scale(model);
        probes.push_back({name, {effect.first * scale, effect.second * scale}, effect.apply});
    }
    for (const Nuisance& nuisance : plan.nuisances)
        probes.push_back({nuisance.name,
                          {-nuisance_step * nuisance.sigma, nuisance_step * nuisance.sigma},
                          nuisance.apply});
    return probes;
}

std::vector<Trial> baseline_trials(const LibraryPlan& plan) {
    std::vector<Trial> trials;
    for (std::size_t p = 0; p < plan.packings.size(); ++p)
        for (int r = 0; r < plan.replicates; ++r)
            trials.push_back({plan.packings[p].model, plan.packings[p].packing, plan.jitter,
                              plan.diameter_jitter, plan.seed + 1000 * p + static_cast<std::uint64_t>(r)});
    return trials;
}

std::vector<Trial> finer_baseline_trials(LibraryPlan plan) {
    plan.jitter /= 2;
    for (LibraryPacking& packing : plan.packings) packing.model.instrument.stated.position_error /= 2;
    return baseline_trials(plan);
}

std::vector<std::size_t> paired_trials(const LibraryPlan& plan) {
    std::vector<std::size_t> paired;
    for (std::size_t t = 0; t < plan.packings.size() * static_cast<std::size_t>(plan.replicates); ++t)
        if (static_cast<int>(t) % plan.replicates < plan.pairs) paired.push_back(t);
    return paired;
}

std::vector<Trial> library_trials(const LibraryPlan& plan) {
    std::vector<Trial> trials = baseline_trials(plan);
    const std::vector<std::size_t> paired = paired_trials(plan);
    for (const Probe& probe : probes_of(plan))
        for (const double amplitude : probe.amplitudes)
            for (const std::size_t t : paired) {
                trials.push_back(trials[t]);
                probe.apply(trials.back().model, amplitude);
            }
    return trials;
}

std::string probe_of_trial(const LibraryPlan& plan, std::size_t trial) {
    const std::size_t baseline = plan.packings.size() * static_cast<std::size_t>(plan.replicates);
    if (trial < baseline) return {};
    return probes_of(plan).at((trial - baseline) / (2 * paired_trials(plan).size())).name;
}

CandidateChoice choose_candidates(const Model& model, const std::vector<std::string>& wanted) {
    std::vector<std::string> problems, names = wanted;
    for (const std::string& name : wanted)
        if (!find_effect(name)) {
            std::vector<std::string_view> known;
            for (const Effect& effect : effects()) known.push_back(effect.name);
            problems.push_back(
                fmt::format("--candidates: {} is not an effect; there are {}", name, fmt::join(known, ", ")));
        }
    if (!problems.empty()) throw InputError(problems);
    if (names.empty())
        for (const Effect& effect : effects()) names.emplace_back(effect.name);
    CandidateChoice choice;
    for (const std::string& name : names) {
        const std::string_view hindrance = find_effect(name)->hindrance(model);
        if (hindrance.empty())
            choice.chosen.push_back(name);
        else
            choice.hindered.push_back(fmt::format("{}: {}", name, hindrance));
    }
    if (choice.chosen.empty())
        throw InputError(fmt::format("--candidates: must name an effect that can be tested, got {}",
                                     fmt::join(choice.hindered, "; ")));
    return choice;
}

}  // namespace mcdem::ensemble
