// Loads runs and experiments to which a scene is fitted.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "io/results.h"
#include "metrics/replicas.h"

namespace mcdem::inline cli {

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

}  // namespace mcdem::cli
