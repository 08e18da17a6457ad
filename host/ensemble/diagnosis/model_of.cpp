// What a diagnosis takes from an experiment.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "core/parameters.h"
#include "ensemble/diagnosis/diagnosis_plan.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline ensemble {

Packing start_packing(const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    if (recording.scans.empty() || recording.scans.front().position.empty())
        throw InputError(
            fmt::format("{}: grains.csv must have the positions of frame 0, from which simulations start",
                        experiment.name));
    return {recording.scans.front().position, recording.diameter};
}

namespace {

int simulated_cycles(const Scene& scene) {
    const Protocol& protocol = scene.replicas.front().protocol;
    return std::max(protocol.cycles, protocol.discard + 1);
}

}  // namespace

Experiment compared_cycles(const Scene& scene, Experiment experiment) {
    if (programme_of(experiment.recording.parameters).empty())
        std::erase_if(experiment.recording.scans,
                      [&](const Scan& scan) { return scan.cycle >= simulated_cycles(scene); });
    return experiment;
}

Model model_of(const Scene& scene, const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    if (scene.replicas.front().box.shape != recording.box.shape)
        throw InputError(fmt::format("{}: container.shape must be {}, as in {}: others cannot be diagnosed",
                                     scene.name, name(recording.box.shape), experiment.name));
    Model model;
    model.replica = scene.replicas.front();
    model.replica.box = recording.box;
    model.instrument.stated = experiment.measurement;
    model.experiment_speed = experiment.plate_speed;
    model.mean_diameter = std::reduce(recording.diameter.begin(), recording.diameter.end()) /
                          static_cast<double>(std::max<std::size_t>(1, recording.diameter.size()));
    double lowest = recording.plate_start;
    for (const Scan& scan : recording.scans) lowest = std::min(lowest, scan.plate_z);
    model.replica.programme = programme_of(recording.parameters);
    if (model.replica.programme.empty() && !scene.replicas.front().programme.empty())
        throw InputError(fmt::format(
            "{}: experiment.toml must state the [[programme]] of the experiment, and plate.csv its "
            "time_s, for a scene that has one",
            experiment.name));
    // A scan before the stroke is not one of its levels, even if the plate's zero is slightly wrong.
    const double begun = 0.02 * (recording.plate_start - lowest);
    int loading = 0, cycles = 1;
    for (const Scan& scan : recording.scans) {
        loading += scan.cycle == 0 && scan.phase == Phase::load && recording.displacement(scan) > begun;
        cycles = std::max(cycles, scan.cycle + 1);
    }
    if (loading == 0 || !(lowest < recording.plate_start))
        throw InputError(experiment.name + ": plate.csv must have loading frames below plate.start");
    model.replica.plate.start = recording.plate_start;
    model.replica.protocol.scan_at_start = true;
    if (!model.replica.programme
             .empty()) {  // under a prescribed force the plate may move as far as the scene allows
        model.replica.plate.end = std::min(scene.replicas.front().plate.end, lowest);
        return model;
    }
    model.replica.plate.end = lowest;
    model.replica.protocol.scans_per_stroke = loading;
    model.replica.protocol.cycles = std::min(cycles, simulated_cycles(scene));
    return model;
}

std::vector<std::string> other_materials(const Replica& replica,
                                         const std::map<std::string, double>& stated) {
    std::vector<std::string> list;
    if (!replica.species.empty()) return list;
    for (const auto& [name, material] : stated) {
        const auto* used = std::get_if<double>(&find_parameter(replica.parameters, name));
        if (used && std::abs(*used - material) > 1e-6 * std::abs(material))
            list.push_back(fmt::format("{} = {} (scene: {})", name, material, *used));
    }
    return list;
}

}  // namespace mcdem::ensemble
