#include "experiment/from_recording.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "scene/packing_fields.h"

namespace mcdem::inline experiment {

Experiment experiment_from(const Recording& truth, const Instrument& instrument, std::uint64_t seed) {
    if (truth.box.shape != ContainerShape::box)
        throw InputError(
            fmt::format("{}: container.shape must be box, got {}: experiments in other containers can be "
                        "neither checked nor "
                        "diagnosed",
                        truth.label, name(truth.box.shape)));
    Experiment experiment;
    experiment.name = truth.label;
    experiment.measurement = instrument.stated;
    for (const std::string& key : material_keys())
        if (const auto found = truth.parameters.find(key); found != truth.parameters.end())
            if (const auto value = to_number(found->second)) experiment.materials[key] = *value;
    Recording& recording = experiment.recording = measured(truth, instrument, seed);
    if (!recording.scans.empty() && !recording.scans.front().position.empty()) return experiment;
    recording.diameter.clear();
    for (Scan& scan : recording.scans) {
        scan.position.clear();
        scan.contacts.clear();
    }
    return experiment;
}

}  // namespace mcdem::experiment
