#include "ensemble/diagnosis/case_simulator.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"
#include "ensemble/diagnosis/outside_effects.h"
#include "ensemble/make_packings.h"
#include "experiment/instrument.h"
#include "scene/packing/make_packing.h"
#include "scene/programme/legs.h"

namespace mcdem::inline ensemble {
namespace {

// Hidden numerics of every case, so that the diagnosis cannot rely on identical numerics.
constexpr double time_step_factor = 0.7;
constexpr double restitution_factor = 0.95;
constexpr double start_jitter = 0.02;  ///< over the mean diameter, so that packings with the same seed differ

constexpr std::size_t max_grains_of_cases = 16'384;  ///< a batch is lost after an interruption

GeneratedPacking generated(const Scene& scene) {
    expect_plain_strokes(scene, "a challenge");
    std::vector<std::string> problems;
    if (scene.replicas.size() != 1)
        problems.push_back(
            fmt::format("{}: a challenge needs one replica, got {}", scene.name, scene.replicas.size()));
    if (scene.replicas.front().box.shape != ContainerShape::box)
        problems.push_back(fmt::format("{}: a challenge's container.shape must be box, got {}", scene.name,
                                       name(scene.replicas.front().box.shape)));
    const auto* packing = std::get_if<GeneratedPacking>(&scene.replicas.front().packing.source);
    if (!packing)
        problems.push_back(
            fmt::format("{}: a challenge generates its packings; packing.file must not be set", scene.name));
    if (!problems.empty()) throw InputError(problems);
    return *packing;
}

}  // namespace

CaseSimulator::CaseSimulator(const Scene& scene, const Measurement& measurement, const std::string& device)
    : scene_(scene),
      stated_{scene.replicas.front(), {measurement}, generated(scene).diameter_mean},
      device_(device) {
    stated_.replica.protocol.scan_at_start = true;
    scene_.output.positions = scene_.output.contacts = true;
    nuisances_ = mcdem::nuisances(stated_, {});
}

void CaseSimulator::make_packings(const std::vector<std::uint64_t>& seeds, const StopWanted& stop_wanted) {
    Scene all = scene_;
    all.replicas.clear();
    for (const std::uint64_t seed : seeds) {
        all.replicas.push_back(stated_.replica);
        all.replicas.back().packing.seed = seed;
    }
    packings_ = mcdem::make_packings(all, stop_wanted);
}

std::size_t CaseSimulator::at_once() const {
    return std::max<std::size_t>(1, max_grains_of_cases / packings_.front().size());
}

Model CaseSimulator::model_of_case(const SimulatedCase& c) const {
    Model model = stated_;
    for (const auto& [name, shift] : c.nuisances)
        std::ranges::find(nuisances_, name, &Nuisance::name)->apply(model, shift);
    for (const auto& [name, amplitude] : c.effects) {
        const OutsideEffect* outside = find_outside_effect(name);
        if (!outside)
            find_effect(name)->apply(model, amplitude);
        else if (outside->change_model)
            outside->change_model(model.replica, amplitude);
    }
    model.replica.numerics.time_step *= time_step_factor;
    model.replica.grains.restitution *= restitution_factor;
    model.replica.walls.restitution *= restitution_factor;
    model.replica.packing.seed = c.seed;
    return model;
}

std::vector<std::string> CaseSimulator::simulate(std::vector<SimulatedCase> cases, bool loading_only,
                                                 const Callbacks& callbacks) {
    cases_ = std::move(cases);
    Scene batch = scene_;
    batch.replicas.clear();
    std::vector<Packing> starts;
    for (const SimulatedCase& c : cases_) {
        batch.replicas.push_back(model_of_case(c).replica);
        starts.push_back(packings_.at(c.packing));
        apply_jitter(starts.back(), start_jitter * stated_.mean_diameter, c.seed);
    }
    const auto loading = static_cast<std::size_t>(1 + stated_.replica.protocol.scans_per_stroke);
    recordings_ =
        mcdem::simulate(device_, batch, starts, callbacks, {.scans = loading_only ? loading : SIZE_MAX});
    std::vector<std::string> failures;
    for (const Recording& recording : recordings_)
        failures.push_back(recording.failure ? recording.failure->text() : "");
    return failures;
}

Recording CaseSimulator::measured(std::size_t k) const {
    const SimulatedCase& c = cases_.at(k);
    Recording recording = recordings_.at(k);
    for (const auto& [name, amplitude] : c.effects)
        if (const OutsideEffect* outside = find_outside_effect(name); outside && outside->change_reading)
            outside->change_reading(recording, amplitude);
    recording.box = stated_.replica.box;
    recording.label = c.folder;
    return mcdem::measured(recording, model_of_case(c).instrument, c.seed);
}

}  // namespace mcdem::ensemble
