#include "ensemble/parts/library_parts.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "ensemble/parts/manifest.h"
#include "experiment/check_experiment.h"
#include "io/folder_lock.h"

namespace mcdem::inline ensemble {
namespace {

class LibraryParts : public PartedWork {
public:
    LibraryParts(const Scene& scene, const Experiment& experiment, const DiagnoseOptions& options)
        : options_(options),
          lock_(options.folder, FolderLock::Use::shared),
          store_(options.folder / "simulations") {
        const Model model = model_of(scene, experiment);
        question_ = question_of(scene, experiment, options, model);
        if (options.library && std::filesystem::exists(*options.library)) return;
        auto trials = library_trials(
            model, plan_of(experiment, options, model, choose_candidates(model, options.candidates)));
        if (options.paper_metrics) keep_recordings(trials);
        parts_ = parts_of_trials(question_, trials);
    }

    std::vector<std::size_t> missing() override {
        const auto device = read_manifest(device_file(options_.folder));
        std::vector<std::size_t> numbers;
        for (std::size_t k = 0; k < parts_.size(); ++k)
            if (!device || !are_observed(device->at("device"), question_, parts_[k], store_))
                numbers.push_back(k);
        return numbers;
    }

    bool compute(Device& device, std::size_t part) override try {
        keep_manifest(device_file(options_.folder), {{"device", device.description()}});
        if (part >= parts_.size())
            throw InputError(fmt::format(
                "--part: must be below {}, the number of parts of the library, got {}", parts_.size(), part));
        TrialOptions trials;
        trials.on_progress = on_progress;
        trials.stop_wanted = options_.stop_wanted;
        observe_trials(device, question_, parts_[part], store_, trials);
        return true;
    } catch (const Interrupted&) {
        return false;
    }

    bool merge() override { return true; }

private:
    const DiagnoseOptions& options_;
    FolderLock lock_;
    ObservationStore store_;
    Question question_;
    std::vector<std::vector<Trial>> parts_;
};

}  // namespace

Question question_of(const Scene& scene, const Experiment& experiment, const DiagnoseOptions& options,
                     const Model& model) {
    return {scene, grid_of(experiment.recording), reference_material(model), model.replica.protocol.discard,
            options.program};
}

LibraryPlan plan_of(const Experiment& experiment, const DiagnoseOptions& options, const Model& model,
                    const CandidateChoice& choice) {
    return {{start_packing(experiment)},
            options.replicates,
            options.pairs,
            experiment.measurement.position_error,
            experiment.measurement.diameter_error,
            options.seed,
            choice.chosen,
            nuisances(model, experiment)};
}

void keep_recordings(std::vector<Trial>& trials) {
    for (std::size_t t = 0; t < std::min(trials.size(), trials_recorded); ++t)
        trials[t].keep_recording = true;
}

std::unique_ptr<PartedWork> library_parts(const Scene& scene, const Experiment& experiment,
                                          const DiagnoseOptions& options) {
    if (const auto needed = needed_to_diagnose(experiment); !needed.empty()) throw InputError(needed);
    return std::make_unique<LibraryParts>(scene, experiment, options);
}

}  // namespace mcdem::ensemble
