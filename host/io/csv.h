// Summaries as CSV.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "core/recording.h"

namespace mcdem::inline io {

/// The text of `plate.csv`: one row per replica and scan, without positions and contacts. The last columns
/// are the scene keys that differ between replicas. Wall forces are the components that press the wall
/// outwards; unknown values are `nan`. Throws Interrupted if `stop_wanted` becomes true meanwhile.
std::string csv_text(
    const Run& run, const std::function<bool()>& stop_wanted = [] { return false; });

/// Reads the run in `folder` and writes its `plate.csv` there. Throws Interrupted, and leaves the file as it
/// is, if `stop_wanted` becomes true meanwhile.
void write_csv(
    const std::filesystem::path& folder, const std::function<bool()>& stop_wanted = [] { return false; });

}  // namespace mcdem::io
