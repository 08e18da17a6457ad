// Loads runs and experiments for comparisons.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "io/results.h"
#include "metrics/replicas.h"

namespace mcdem::inline cli {

/// Several runs and their settings. Settings point into the runs, so the object can be moved but not copied.
struct LoadedRuns {
    LoadedRuns() = default;
    LoadedRuns(LoadedRuns&&) = default;
    LoadedRuns& operator=(LoadedRuns&&) = default;
    std::vector<Run> runs;
    std::vector<Setting> settings;
};

/// Each path is a result folder or file. If there are several runs, the label of every setting begins with
/// that of its run.
LoadedRuns load_runs(const std::vector<std::string>& paths, ReadWhat what);

struct ReferenceOptions {
    std::vector<std::string> paths;  ///< experiment folders, result folders or files
    std::string setting;             ///< of a run with several settings; default: mc_dem, if it exists
    int discard = 0;                 ///< number of first cycles of an experiment that are ignored
};
void add_reference_options(CLI::App& command, ReferenceOptions& options, const std::string& name,
                           const std::string& help);

/// All replicas of the reference as one setting for comparisons.
struct LoadedReference {
    LoadedReference() = default;
    LoadedReference(LoadedReference&&) = default;
    LoadedReference& operator=(LoadedReference&&) = default;
    std::vector<Run> runs;
    Setting setting;
};
LoadedReference load_reference(const ReferenceOptions& options, ReadWhat what);

void add_runs_option(CLI::App& command, std::vector<std::string>& paths);

}  // namespace mcdem::cli
