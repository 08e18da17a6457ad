#include "experiment/from_recording.h"

#include <fmt/format.h>

#include "core/container.h"
#include "core/errors.h"
#include "scene/packing_fields.h"

namespace mcdem::inline experiment {

Experiment experiment_from(const Recording& truth, const Instrument& instrument, std::uint64_t seed) {
    if (is_cell(truth.box))
        throw InputError(
            fmt::format("{}: container.shape must be one with a plate, got {}: an experiment is a "
                        "compression by a plate",
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
