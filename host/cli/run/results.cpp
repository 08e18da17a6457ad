#include "cli/run/results.h"

#include <algorithm>

#include "cli/shell/commands.h"
#include "core/look.h"
#include "ensemble/reference.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

/// The folder's name, also for "out/first/" and "out/first/run.h5".
std::string short_name(const std::string& path) {
    fs::path p = fs::path(path).lexically_normal();
    if (p.filename() == "run.h5") p = p.parent_path();
    if (!p.has_filename()) p = p.parent_path();
    return p.filename().string();
}

/// Unique names of the runs: the folders' names, or whole paths if those are not unique.
std::vector<std::string> names_of(const std::vector<std::string>& paths) {
    std::vector<std::string> names;
    for (const auto& path : paths) {
        const auto name = short_name(path);
        const bool taken = std::count_if(paths.begin(), paths.end(),
                                         [&](const auto& other) { return short_name(other) == name; }) > 1;
        names.push_back(taken ? path : name);
    }
    return names;
}

}  // namespace

LoadedRuns load_runs(const std::vector<std::string>& paths, ReadWhat what) {
    LoadedRuns loaded;
    for (const auto& path : paths) loaded.runs.push_back(read_run(path, what));
    const auto names = names_of(paths);
    for (std::size_t k = 0; k < paths.size(); ++k)
        for (auto setting : group_by_setting(loaded.runs[k])) {
            if (paths.size() > 1) setting.label = names[k] + ": " + setting.label;
            loaded.settings.push_back(std::move(setting));
        }
    return loaded;
}

LoadedReference load_reference(const ReferenceOptions& options, ReadWhat what) {
    LoadedReference loaded;
    for (const auto& path : options.paths) loaded.runs.push_back(read_reference(path, options.discard, what));
    for (std::size_t k = 0; k < options.paths.size(); ++k) {
        const bool measured = is_there(fs::path(options.paths[k]) / "experiment.toml");
        const auto setting =
            measured ? Setting{loaded.runs[k].name, replicas_of(loaded.runs[k].recordings)}
                     : chosen_setting(loaded.runs[k], options.setting, options.paths[k], "--setting");
        loaded.setting.label += (k ? ", " : "") + setting.label;
        for (const auto* replica : setting.replicas) loaded.setting.replicas.push_back(replica);
    }
    return loaded;
}

void add_runs_option(CLI::App& command, std::vector<std::string>& paths) {
    command.add_option("RUN", paths, "Result folders or files, of finished or running simulations")
        ->required();
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
