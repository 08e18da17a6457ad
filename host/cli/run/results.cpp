#include "cli/run/results.h"

#include "cli/shell/commands.h"
#include "core/look.h"
#include "ensemble/reference.h"

namespace mcdem::inline cli {

LoadedReference load_reference(const ReferenceOptions& options, ReadWhat what) {
    LoadedReference loaded;
    for (const auto& path : options.paths) loaded.runs.push_back(read_reference(path, options.discard, what));
    for (std::size_t k = 0; k < options.paths.size(); ++k) {
        const bool measured = is_there(std::filesystem::path(options.paths[k]) / "experiment.toml");
        const auto setting =
            measured ? Setting{loaded.runs[k].name, replicas_of(loaded.runs[k].recordings)}
                     : chosen_setting(loaded.runs[k], options.setting, options.paths[k], "--setting");
        loaded.setting.label += (k ? ", " : "") + setting.label;
        for (const auto* replica : setting.replicas) loaded.setting.replicas.push_back(replica);
    }
    return loaded;
}

void add_reference_options(CLI::App& command, ReferenceOptions& options, const std::string& name,
                           const std::string& help) {
    command.add_option(name, options.paths, help)->type_name("DIR")->allow_extra_args(false);
    command
        .add_option("--setting", options.setting,
                    "Setting of the reference run to compare with, if it has several (default: mc_dem)")
        ->type_name("LABEL");
    command
        .add_option(
            "--discard", options.discard,
            "Number of first cycles of the experiment to leave out; runs state their own as protocol.discard")
        ->type_name("CYCLES")
        ->check(at_least_zero());
}

}  // namespace mcdem::cli
