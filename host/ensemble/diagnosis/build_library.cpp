#include "ensemble/diagnosis/build_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/errors.h"
#include "ensemble/diagnosis/library_origin.h"

namespace mcdem::inline ensemble {
namespace {

/// Amplitudes of the paired runs of a nuisance: on both sides of the model, so that its slope there is
/// accurate.
constexpr double nuisance_step = 1.0;  // sigmas

/// An effect or nuisance that is simulated at two amplitudes.
struct Probe {
    std::string name;
    double amplitudes[2];
    void (*apply)(Model&, double);
};

/// Amplitudes use the scale of the first packing.
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

}  // namespace

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

namespace {

/// Baseline trials that are repeated with every probe.
std::vector<std::size_t> paired_trials(const LibraryPlan& plan) {
    std::vector<std::size_t> paired;
    for (std::size_t t = 0; t < plan.packings.size() * static_cast<std::size_t>(plan.replicates); ++t)
        if (static_cast<int>(t) % plan.replicates < plan.pairs) paired.push_back(t);
    return paired;
}

}  // namespace

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

Library build_library(Device& device, const TrialSettings& common, const LibraryPlan& plan,
                      const ObservationStore& store, const TrialOptions& options) {
    Library library;
    library.grid = common.grid;
    const std::size_t baseline_count = plan.packings.size() * static_cast<std::size_t>(plan.replicates);
    for (std::size_t t = 0; t < baseline_count; ++t)
        library.packing.push_back(static_cast<int>(t) / plan.replicates);
    const Eigen::MatrixXd observed = observe_trials(device, common, library_trials(plan), store, options);
    library.baseline = observed.topRows(static_cast<Eigen::Index>(baseline_count));
    const Eigen::MatrixXd before = library.baseline(paired_trials(plan), Eigen::all);
    auto next = static_cast<Eigen::Index>(baseline_count);
    for (const Probe& probe : probes_of(plan)) {
        Eigen::MatrixXd differences[2];
        for (Eigen::MatrixXd& difference : differences) {
            difference = observed.middleRows(next, before.rows()) - before;
            next += before.rows();
        }
        auto& list = find_effect(probe.name) && library.effects.size() < plan.candidates.size()
                         ? library.effects
                         : library.nuisances;
        list.push_back(learn_signature(probe.name, probe.amplitudes[0], probe.amplitudes[1], differences[0],
                                       differences[1]));
    }
    const LibraryPacking& first = plan.packings.front();
    library.origin = library_origin(common, first.model, first.packing.size());
    library.provenance = {{"program", common.program}, {"device", device.description()}};
    return library;
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
