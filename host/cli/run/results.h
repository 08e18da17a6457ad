// Runs and experiments read for comparison.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/results.h"
#include "metrics/replicas.h"

namespace mcdem::inline cli {

/// Some runs, and their settings side by side. Settings point into the runs: moving keeps them, copying
/// would not.
struct LoadedRuns {
    LoadedRuns() = default;
    LoadedRuns(LoadedRuns&&) = default;
    LoadedRuns& operator=(LoadedRuns&&) = default;
    std::vector<Run> runs;
    std::vector<Setting> settings;
};

/// Each path is a result folder or file. Of several runs, every setting's label begins with the run's.
LoadedRuns load_runs(const std::vector<std::string>& paths, ReadWhat what);

/// What the user says about a reference.
struct ReferenceOptions {
    std::vector<std::string> paths;  ///< experiment folders, result folders or files
    std::string setting;             ///< of a run with several; empty: mc_dem, where there is one
    int discard = 0;                 ///< first cycles of an experiment to leave out
};
void add_reference_options(CLI::App& command, ReferenceOptions& options, const std::string& name,
                           const std::string& help);

/// All replicas of the reference together: the one setting that others are held against.
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
