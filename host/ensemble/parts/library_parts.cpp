#include "ensemble/parts/library_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/look.h"
#include "diagnose/observe/needed_to_diagnose.h"
#include "ensemble/parts/manifest.h"
#include "io/folder_lock.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline ensemble {
namespace {

class LibraryParts : public PartedWork {
public:
    LibraryParts(DiagnosisPlan plan, const DiagnoseOptions& options)
        : options_(options),
          lock_(options.folder, FolderLock::Use::shared),
          store_(options.folder / "simulations"),
          common_(std::move(plan.common)) {
        for (const char* folder : {"", "simulations"})  // of killed processes; others lock theirs
            remove_temporaries(options.folder / folder);
        if (options.library && is_there(*options.library)) return;
        auto trials = library_trials(plan.library);
        if (options.paper_metrics) keep_recordings(trials);
        parts_ = parts_of_trials(common_, trials);
    }

    std::size_t count() override { return parts_.size(); }

    std::vector<std::size_t> missing() override {
        const auto device = read_manifest(device_file(options_.folder));
        std::vector<std::size_t> numbers;
        for (std::size_t k = 0; k < parts_.size(); ++k)
            if (!device || !are_observed(device->at("device"), common_, parts_[k], store_))
                numbers.push_back(k);
        return numbers;
    }

    void compute(Device& device, std::size_t part) override {
        keep_manifest(device_file(options_.folder), {{"device", device.description()}});
        observe_trials(device, common_, parts_[part], store_, {on_progress, options_.stop_wanted});
    }

    bool merge() override { return true; }

private:
    const DiagnoseOptions& options_;
    FolderLock lock_;
    ObservationStore store_;
    TrialSettings common_;
    std::vector<std::vector<Trial>> parts_;
};

}  // namespace

namespace {

/// The grid within the shortest stroke.
Grid common_grid(const std::vector<Experiment>& experiments) {
    Grid grid;
    for (const Experiment& experiment : experiments)
        if (Grid own = grid_of(experiment.recording); grid.stroke == 0 || own.stroke < grid.stroke)
            grid = std::move(own);
    return grid;
}

/// Checks that the packings of one experiment are compressed and measured in the same way.
void expect_alike(const std::vector<Experiment>& experiments, const Grid& grid) {
    constexpr double alike = 0.1;
    const Experiment& first = experiments.front();
    std::vector<std::string> problems;
    for (const Experiment& other : experiments) {
        if (other.measurement != first.measurement || other.uncertainty != first.uncertainty)
            problems.push_back(
                fmt::format("{}: experiment.toml must state the same [measurement] and "
                            "[uncertainty] as that of {}, to be diagnosed with it",
                            other.name, first.name));
        if (programme_parameters(programme_of(other.recording.parameters)) !=
            programme_parameters(programme_of(first.recording.parameters)))
            problems.push_back(
                fmt::format("{}: experiment.toml must state the same [[programme]] as that of {}, to be "
                            "diagnosed with it",
                            other.name, first.name));
        if (const double stroke = grid_of(other.recording).stroke; stroke > (1 + alike) * grid.stroke)
            problems.push_back(
                fmt::format("{}: its stroke of {:.4g} mm must be within a tenth of the shortest, "
                            "{:.4g} mm, to be diagnosed with it",
                            other.name, 1e3 * stroke, 1e3 * grid.stroke));
    }
    if (!problems.empty()) throw InputError(problems);
}

void note_cycles(const Experiment& measured, const Experiment& compared, const DiagnoseOptions& options) {
    const int all = measured.recording.scans.back().cycle + 1,
              some = compared.recording.scans.back().cycle + 1;
    if (all == some) return;
    options.on_note(
        fmt::format("{}: only the first {} compared, of {}; protocol.cycles in the scene is the number of "
                    "cycles to simulate",
                    measured.name, some == 1 ? "cycle is" : fmt::format("{} cycles are", some), all));
}

}  // namespace

DiagnosisPlan plan_of(const Scene& scene, const std::vector<Experiment>& measured,
                      const DiagnoseOptions& options) {
    std::vector<std::string> problems;
    for (const Experiment& experiment : measured)
        for (const std::string& needed : needed_to_diagnose(experiment)) problems.push_back(needed);
    if (!problems.empty()) throw InputError(problems);
    DiagnosisPlan plan;
    for (const Experiment& experiment : measured)
        plan.experiments.push_back(compared_cycles(scene, experiment));
    const std::vector<Experiment>& experiments = plan.experiments;
    note_cycles(measured.front(), experiments.front(), options);
    const Grid grid = common_grid(experiments);
    expect_alike(experiments, grid);
    for (const Experiment& experiment : experiments)
        plan.library.packings.push_back({model_of(scene, experiment), start_packing(experiment)});
    const Experiment& first = experiments.front();
    const Model& model = plan.library.packings.front().model;
    plan.common = {scene, grid, reference_material(model), model.replica.protocol.discard, options.program};
    plan.choice = choose_candidates(model, options.candidates);
    plan.library.replicates = options.replicates;
    plan.library.pairs = std::min(options.pairs, options.replicates);
    plan.library.jitter = first.measurement.position_error;
    plan.library.diameter_jitter = first.measurement.diameter_error;
    plan.library.seed = options.seed;
    plan.library.candidates = plan.choice.chosen;
    plan.library.nuisances = nuisances(model, first);
    return plan;
}

void keep_recordings(std::vector<Trial>& trials) {
    for (std::size_t t = 0; t < std::min(trials.size(), trials_recorded); ++t)
        trials[t].keep_recording = true;
}

std::unique_ptr<PartedWork> library_parts(const Scene& scene, const std::vector<Experiment>& experiments,
                                          const DiagnoseOptions& options) {
    return std::make_unique<LibraryParts>(plan_of(scene, experiments, options), options);
}

}  // namespace mcdem::ensemble
