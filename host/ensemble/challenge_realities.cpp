#include "ensemble/challenge_realities.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "diagnose/challenge_files.h"
#include "diagnose/challenge_outside.h"
#include "diagnose/challenge_truth.h"
#include "ensemble/make_packings.h"
#include "ensemble/observe_trials.h"
#include "ensemble/simulate.h"
#include "experiment/from_recording.h"
#include "scene/make_packing.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

// What every reality has and no diagnosis is told: other numerics, so that they are not what is recognised.
constexpr double time_step_factor = 0.7;
constexpr double restitution_factor = 0.95;
constexpr double start_jitter = 0.02;  ///< over the mean diameter: packings of one seed are not quite alike

constexpr std::size_t most_grains_at_once = 16'384;  ///< a batch is what an interruption may lose

GeneratedPacking generated(const Scene& scene) {
    std::vector<std::string> problems;
    if (scene.replicas.size() != 1)
        problems.push_back(fmt::format("{}: a challenge needs one replica, got {}", scene.name, scene.replicas.size()));
    const auto* packing = std::get_if<GeneratedPacking>(&scene.replicas.front().packing.source);
    if (!packing) problems.push_back(fmt::format("{}: a challenge generates its packings; packing.file must not be set", scene.name));
    if (!problems.empty()) throw InputError(problems);
    return *packing;
}

/// The scene with what its instrument states, before anything is hidden in it.
Model stated_model(const Scene& scene, const Measurement& measurement) {
    Model model{scene.replicas.front(), {measurement}, generated(scene).diameter_mean};
    model.replica.protocol.scan_at_start = true;
    return model;
}

std::vector<std::string> effects_to_try(const ChallengeOptions& options, const Model& model) {
    if (!options.effects.empty()) return options.effects;
    std::vector<std::string> names;
    for (const std::string_view name : challenged_effects())
        if (find_effect(name)->hindrance(model).empty()) names.emplace_back(name);
    return names;
}

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::uint64_t seed_of(const ChallengeOptions& options) {
    if (options.seed) return *options.seed;
    if (fs::exists(options.truth)) return parse_truth(text_of(options.truth), options.truth.string()).seed;
    std::random_device machine;
    return static_cast<std::uint64_t>(machine()) << 32 | machine();
}

/// Writes a file that is not there; one that is there must be the same.
void write_once(const fs::path& file, const std::string& text) {
    if (!fs::exists(file)) return replace_file(file, text);
    if (text_of(file) != text)
        throw InputError(fmt::format("{}: is of another challenge; choose another folder, or the same scene, seed and numbers",
                                     file.string()));
}

/// experiment.toml is written last.
bool is_complete(const fs::path& folder) { return fs::exists(folder / "experiment.toml"); }

class Making {
public:
    Making(Device& device, const Scene& scene, const ChallengeOptions& options)
        : device_(device), scene_(scene), options_(options), model_(stated_model(scene, options.measurement)) {
        scene_.output.positions = scene_.output.contacts = true;
        scene_.replicas = {model_.replica};
        nuisances_ = nuisances(model_, {});
        challenge_ = draw_challenge(options.size, effects_to_try(options, model_), model_, nuisances_, seal_of(scene.text),
                                    seed_of(options));
    }

    std::string all() {
        const std::string truth = truth_text(challenge_), seal = seal_of(truth);
        fs::create_directories(options_.folder);
        if (options_.truth.has_parent_path()) fs::create_directories(options_.truth.parent_path());
        write_once(options_.truth, truth);
        write_once(options_.folder / "challenge.json", open_text(seal));
        std::vector<const ChallengeCase*> missing;
        for (const ChallengeCase& c : challenge_.cases)
            if (!is_complete(options_.folder / c.folder)) missing.push_back(&c);
        if (missing.empty()) return seal;
        packings_ = draw_packings();
        const std::size_t at_once = std::max<std::size_t>(1, most_grains_at_once / packings_.front().size());
        for (std::size_t first = 0; first < missing.size(); first += at_once) {
            const std::size_t last = std::min(missing.size(), first + at_once), before = challenge_.cases.size() - missing.size();
            make({missing.begin() + static_cast<std::ptrdiff_t>(first), missing.begin() + static_cast<std::ptrdiff_t>(last)},
                 part_of_all(before + first), part_of_all(before + last));
        }
        return seal;
    }

private:
    double part_of_all(std::size_t cases) const { return static_cast<double>(cases) / static_cast<double>(challenge_.cases.size()); }

    std::string open_text(const std::string& seal) const {
        OpenChallenge open{challenge_.scene, seal, {}};
        for (const ChallengeCase& c : challenge_.cases) {
            open.cases.push_back({c.folder, std::nullopt});
            if (c.struck.empty()) continue;
            auto& candidates = open.cases.back().candidates.emplace();
            for (const Effect& effect : effects())
                if (std::ranges::find(c.struck, effect.name) == c.struck.end()) candidates.emplace_back(effect.name);
        }
        return open_challenge_text(open);
    }

    std::vector<Packing> draw_packings() {
        Scene all = scene_;
        all.replicas.clear();
        for (const std::uint64_t seed : challenge_.packing_seeds) {
            all.replicas.push_back(model_.replica);
            all.replicas.back().packing.seed = seed;
        }
        auto packings = make_packings(all, options_.stop_wanted);
        if (packings.size() < all.replicas.size()) throw Interrupted();
        // Relaxed without effects: what generation pressed together leaves no mark in contacts with a memory.
        const auto relaxed = simulate(device_, all, packings, 1);
        for (std::size_t p = 0; p < packings.size(); ++p) packings[p].position = relaxed[p].scans.at(0).position;
        return packings;
    }

    /// The model with everything that is hidden.
    Model reality_of(const ChallengeCase& c) const {
        Model model = model_;
        for (const Hidden& shift : c.nuisances)
            std::ranges::find(nuisances_, shift.name, &Nuisance::name)->apply(model, shift.amplitude);
        for (const Hidden& hidden : c.effects) {
            const OutsideEffect* outside = find_outside_effect(hidden.name);
            if (!outside)
                find_effect(hidden.name)->apply(model, hidden.amplitude);
            else if (outside->change_model)
                outside->change_model(model.replica, hidden.amplitude);
        }
        model.replica.numerics.time_step *= time_step_factor;
        model.replica.grains.restitution *= restitution_factor;
        model.replica.walls.restitution *= restitution_factor;
        model.replica.packing.seed = c.seed;
        return model;
    }

    void make(const std::vector<const ChallengeCase*>& cases, double from, double to) {
        Scene batch = scene_;
        batch.replicas.clear();
        std::vector<Packing> starts;
        std::vector<Model> realities;
        for (const ChallengeCase* c : cases) {
            realities.push_back(reality_of(*c));
            batch.replicas.push_back(realities.back().replica);
            starts.push_back(packings_[static_cast<std::size_t>(c->packing)]);
            apply_jitter(starts.back(), start_jitter * model_.mean_diameter, c->seed);
        }
        const auto on_progress = [&](double fraction) {
            options_.on_progress(from + (to - from) * fraction);
            if (options_.stop_wanted()) throw Interrupted();
        };
        auto recordings = simulate(device_, batch, starts, SIZE_MAX, on_progress);
        for (std::size_t k = 0; k < cases.size(); ++k) write(*cases[k], std::move(recordings[k]), realities[k].instrument);
    }

    void write(const ChallengeCase& c, Recording recording, const Instrument& instrument) const {
        if (recording.failure)
            throw RunError(fmt::format("{}: its simulation failed at step {}: {}", c.folder, recording.failure->step,
                                       recording.failure->cause));
        for (const Hidden& hidden : c.effects)
            if (const OutsideEffect* outside = find_outside_effect(hidden.name); outside && outside->change_reading)
                outside->change_reading(recording, hidden.amplitude);
        recording.box = model_.replica.box;
        recording.label = c.folder;
        write_experiment(options_.folder / c.folder, experiment_from(recording, instrument, c.seed), Packed::gzip);
    }

    Device& device_;
    Scene scene_;
    const ChallengeOptions& options_;
    Model model_;
    std::vector<Nuisance> nuisances_;
    Challenge challenge_;
    std::vector<Packing> packings_;
};

}  // namespace

std::string make_challenge(Device& device, const Scene& scene, const ChallengeOptions& options) {
    return Making(device, scene, options).all();
}

}  // namespace mcdem
