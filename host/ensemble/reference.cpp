#include "ensemble/reference.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "core/look.h"
#include "experiment/experiment.h"

namespace mcdem::inline ensemble {
namespace {

namespace fs = std::filesystem;

Run run_of(const Experiment& experiment, int discard) {
    Run run;
    run.name = experiment.name;
    run.recordings = {experiment.recording};
    if (run.recordings.front().label.empty()) run.recordings.front().label = experiment.name;
    run.recordings.front().parameters["protocol.discard"] = std::to_string(discard);
    return run;
}

}  // namespace

Run read_reference(const fs::path& path, int discard, ReadWhat what) {
    if (is_there(path / "experiment.toml")) return run_of(read_experiment(path), discard);
    return read_run(path, what);
}

Setting chosen_setting(const Run& run, const std::string& label, const std::string& where,
                       const std::string& option) {
    const auto settings = group_by_setting(run);
    std::string known;
    for (const auto& setting : settings) {
        if (setting.label == label) return setting;
        known += (known.empty() ? "" : ", ") + setting.label;
    }
    if (!label.empty())
        throw InputError(fmt::format("{}: must be one of {}'s: {}; got {}", option, where,
                                     known.empty() ? "it has one, without a label" : known, label));
    if (settings.size() == 1) return settings.front();
    for (const auto& setting : settings)
        if (model_of(setting.replicas) == ContactModel::mc_dem) return setting;
    throw InputError(
        fmt::format("{}: holds several settings; choose one with {}, of {}", where, option, known));
}

}  // namespace mcdem::ensemble
