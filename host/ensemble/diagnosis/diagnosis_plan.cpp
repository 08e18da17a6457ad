#include "ensemble/diagnosis/diagnosis_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"
#include "core/random.h"
#include "ensemble/make_packings.h"
#include "scene/programme/legs.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline ensemble {
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

void note_cycles(const Experiment& measured, const Experiment& compared, const PlanOptions& options) {
    const int all = measured.recording.scans.back().cycle + 1,
              some = compared.recording.scans.back().cycle + 1;
    if (all == some) return;
    options.on_note(
        fmt::format("{}: only the first {} compared, of {}; protocol.cycles in the scene is the number of "
                    "cycles to simulate",
                    measured.name, some == 1 ? "cycle is" : fmt::format("{} cycles are", some), all));
}

/// What follows from the experiments and the packings of a plan.
void fill_in(DiagnosisPlan& plan, const Scene& scene, const Grid& grid, const PlanOptions& options) {
    const Experiment& first = plan.experiments.front();
    const Model& model = plan.library.packings.front().model;
    plan.common = {scene, grid, reference_material(model), model.replica.protocol.discard, options.program};
    plan.choice = choose_candidates(model, options.candidates);
    plan.with_recordings = options.with_recordings;
    plan.library.replicates = options.replicates;
    plan.library.pairs = std::min(options.pairs, options.replicates);
    plan.library.jitter = first.measurement.position_error;
    plan.library.diameter_jitter = first.measurement.diameter_error;
    plan.library.seed = options.seed;
    plan.library.candidates = plan.choice.chosen;
    plan.library.nuisances = nuisances(model, first);
}

}  // namespace

DiagnosisPlan plan_of(const Scene& scene, const std::vector<Experiment>& measured,
                      const PlanOptions& options) {
    expect_plate(scene, "a diagnosis");
    if (scene.replicas.size() > 1)
        options.on_note(fmt::format("the scene has {} replicas; the first one is diagnosed: {}",
                                    scene.replicas.size(), scene.replicas.front().label));
    DiagnosisPlan plan;
    for (const Experiment& experiment : measured)
        plan.experiments.push_back(compared_cycles(scene, experiment));
    for (const Experiment& experiment : plan.experiments)
        if (experiment.recording.scans.empty())
            throw InputError(experiment.name +
                             ": cycles in plate.csv must count from 0, got none below protocol.cycles");
    const std::vector<Experiment>& experiments = plan.experiments;
    note_cycles(measured.front(), experiments.front(), options);
    const Grid grid = common_grid(experiments);
    expect_alike(experiments, grid);
    for (const Experiment& experiment : experiments)
        plan.library.packings.push_back({model_of(scene, experiment), start_packing(experiment)});
    fill_in(plan, scene, grid, options);
    return plan;
}

namespace {

/// The grid of an experiment with the plate positions of the scene, from which the experiment's zero of
/// strain differs.
Grid grid_of_scene(const Scene& scene, const Experiment& experiment) {
    const Plate& plate = scene.replicas.front().plate;
    Grid grid = grid_of(experiment.recording);
    const double factor = (plate.start - plate.end) / grid.stroke;
    for (double& displacement : grid.displacement) displacement *= factor;
    grid.width *= factor;
    grid.stroke *= factor;
    return grid;
}

/// Packings whose seeds are not those of any experiment, but for an improbable coincidence.
std::vector<Packing> other_packings(Scene scene, const Replica& replica, int count, std::uint64_t seed,
                                    const StopWanted& stop_wanted) {
    constexpr std::uint64_t apart = 0x6c696272617279;
    scene.replicas.clear();
    for (int p = 0; p < count; ++p) {
        scene.replicas.push_back(replica);
        scene.replicas.back().packing.seed = derived_seed(seed + apart, static_cast<std::uint64_t>(p));
    }
    return make_packings(scene, stop_wanted);
}

}  // namespace

DiagnosisPlan plan_of_others(const Scene& scene, const Experiment& measured, int packings,
                             const PlanOptions& options, const StopWanted& stop_wanted) {
    expect_plain_strokes(scene, "a challenge");
    DiagnosisPlan plan;
    plan.experiments.push_back(compared_cycles(scene, measured));
    const Experiment& experiment = plan.experiments.front();
    Model model = model_of(scene, experiment);
    model.replica.plate = scene.replicas.front().plate;
    for (Packing& packing : other_packings(scene, model.replica, packings, options.seed, stop_wanted))
        plan.library.packings.push_back({model, std::move(packing)});
    fill_in(plan, scene, grid_of_scene(scene, experiment), options);
    return plan;
}

}  // namespace mcdem::ensemble
