#include "ensemble/diagnosis/convergence_simulator.h"

#include <fmt/format.h>

#include <stdexcept>
#include <variant>

#include "core/errors.h"
#include "ensemble/make_packings.h"
#include "scene/packing/make_packing.h"
#include "scene/programme/legs.h"
#include "scene/read/change_scene.h"

namespace mcdem::inline ensemble {
namespace {

constexpr double jitter_of_diameter = 0.005;

Scene with_one_replica(Scene scene) {
    expect_plate(scene, "mcdem converge");
    scene.replicas.resize(1);
    return scene;
}

/// The grid of a diagnosis of an experiment with this stroke.
Grid grid_of_stroke(const Replica& replica) {
    Recording levels;
    levels.plate_start = replica.plate.start;
    const int scans = replica.protocol.scans_per_stroke;
    for (int k = 1; k <= scans; ++k) {
        Scan scan;
        scan.plate_z = replica.plate.start + (replica.plate.end - replica.plate.start) * k / scans;
        levels.scans.push_back(scan);
    }
    return grid_of(levels);
}

}  // namespace

ConvergenceSimulator::ConvergenceSimulator(const Scene& scene, const std::filesystem::path& folder,
                                           int replicas, double jitter, std::uint64_t seed,
                                           std::string program, const std::string& device)
    : device_(device),
      scene_(with_one_replica(scene)),
      store_(folder / "simulations"),
      seed_(seed),
      program_(std::move(program)) {
    const Packing packing = make_packing(scene_.replicas.front());
    packings_.assign(static_cast<std::size_t>(replicas), packing);
    for (const double diameter : packing.diameter)
        mean_diameter_ += diameter / static_cast<double>(packing.size());
    jitter_ = jitter > 0 ? jitter : jitter_of_diameter * mean_diameter_;
}

void ConvergenceSimulator::find_grid(const Callbacks& callbacks) {
    const Replica& replica = scene_.replicas.front();
    if (replica.programme.empty()) {
        grid_ = grid_of_stroke(replica);
        return;
    }
    std::vector<Trial> trials = trials_of(replica, 0);
    trials.resize(1);
    trials.front().keep_recording = true;
    const TrialSettings settings = settings_of(scene_, trials.front().model);
    observe_trials(device_, settings, trials, store_, callbacks);
    const Recording recording = kept_recordings(device_, settings, trials, store_).front();
    if (recording.failure || recording.scans.empty())
        throw InputError(fmt::format(
            "{}: the first replica does not come to the end of the programme: `mcdem run` with the same "
            "settings says why",
            scene_.name));
    grid_ = grid_of(recording);
}

Eigen::MatrixXd ConvergenceSimulator::observe(const std::map<std::string, std::string>& values,
                                              const Callbacks& callbacks) {
    if (grid_.displacement.empty()) throw std::logic_error("displacements are compared that were not found");
    const Scene changed = with_changes(scene_, values);
    const std::vector<Trial> trials = trials_of(changed.replicas.front(), jitter_);
    return observe_trials(device_, settings_of(changed, trials.front().model), trials, store_, callbacks);
}

bool ConvergenceSimulator::draws_packings() const {
    return std::holds_alternative<GeneratedPacking>(scene_.replicas.front().packing.source);
}

void ConvergenceSimulator::draw_packings(const StopWanted& stop_wanted) {
    Scene all = scene_;
    all.replicas.assign(packings_.size(), scene_.replicas.front());
    for (std::size_t r = 0; r < packings_.size(); ++r) all.replicas[r].packing.seed += r;
    packings_ = make_packings(all, stop_wanted);
}

std::vector<Trial> ConvergenceSimulator::trials_of(const Replica& replica, double jitter) const {
    Model model{replica, {}, mean_diameter_};
    model.instrument.stated.force_threshold = replica.protocol.force_threshold;
    std::vector<Trial> trials;
    for (std::size_t r = 0; r < packings_.size(); ++r)
        trials.push_back({model, packings_[r], jitter, 0, seed_ + r});
    return trials;
}

TrialSettings ConvergenceSimulator::settings_of(const Scene& scene, const Model& model) const {
    return {scene, grid_, reference_material(model), model.replica.protocol.discard, program_};
}

}  // namespace mcdem::ensemble
