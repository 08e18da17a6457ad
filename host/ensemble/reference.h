// References for comparisons: an experiment, or one setting of another run.
#pragma once
#include <filesystem>
#include <string>

#include "io/results.h"
#include "metrics/replicas.h"

namespace mcdem::inline ensemble {

/// Reads a result folder or file, or the folder of an experiment in the form of a run whose first `discard`
/// cycles are ignored by metrics. Throws InputError if there is none.
Run read_reference(const std::filesystem::path& path, int discard, ReadWhat what);

/// The setting with this label; empty: the only one, or that of mc_dem. Points into the run. `where` and
/// `option` (which provides the label) are used in messages.
Setting chosen_setting(const Run& run, const std::string& label, const std::string& where,
                       const std::string& option);

}  // namespace mcdem::ensemble
