#include "ensemble/diagnosis/library_origin.h"

#include <fmt/format.h>

#include "cl/program.h"
#include "core/sha256.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"

namespace mcdem::inline ensemble {
namespace {

std::string observables_digest() {
    Sha256 digest;
    for (const Observable& observable : observables()) digest.add(observable.name).add(";");
    return digest.hex();
}

}  // namespace

std::map<std::string, std::string> library_origin(const TrialSettings& common, const Model& model,
                                                  std::size_t grains) {
    std::map<std::string, std::string> origin;
    Settings settings;
    settings.run = common.scene;
    settings.replica = model.replica;
    for (const Key& key : keys())
        if ((key.scope == Scope::replica && !key.name.starts_with("packing.")) ||
            key.name == "numerics.precision")
            origin[std::string(key.name)] = value_text(key, settings);
    origin.merge(parameter_texts(programme_parameters(model.replica.programme)));
    const Measurement& stated = model.instrument.stated;
    origin["measurement.position_error"] = fmt::format("{}", stated.position_error);
    origin["measurement.diameter_error"] = fmt::format("{}", stated.diameter_error);
    origin["measurement.force_error"] = fmt::format("{}", stated.force_error);
    origin["measurement.force_threshold"] = fmt::format("{}", stated.force_threshold);
    origin["mean diameter"] = fmt::format("{}", model.mean_diameter);
    origin["grains"] = fmt::format("{}", grains);
    origin["kernels"] = Sha256().add(program_text()).hex();
    origin["observables"] = observables_digest();
    origin["program"] = common.program.substr(
        0, common.program.find(' '));  // only the version; a commit need not change results
    return origin;
}

}  // namespace mcdem::ensemble
