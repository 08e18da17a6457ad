// What runs are compared with: an experiment, or one setting of another run.
#pragma once
#include <filesystem>
#include <string>

#include "io/results.h"
#include "metrics/replicas.h"

namespace mcdem::inline ensemble {

/// A result folder or file, or the folder of an experiment in the form of a run, whose first `discard` cycles
/// metrics leave out. Throws InputError where there is none.
Run read_reference(const std::filesystem::path& path, int discard, ReadWhat what);

/// The setting of this label; empty: the only one, or that of mc_dem. A view of the run. `where` the run is
/// and the `option` that gives the label stand in messages.
Setting chosen_setting(const Run& run, const std::string& label, const std::string& where,
                       const std::string& option);

}  // namespace mcdem::ensemble
