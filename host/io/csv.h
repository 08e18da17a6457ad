// Summaries as CSV.
#pragma once
#include <filesystem>
#include <string>

#include "core/recording.h"
#include "core/stop.h"

namespace mcdem::inline io {

/// The text of `plate.csv`: one row per replica and scan, without positions and contacts. The last columns
/// are the scene keys that differ between replicas. Wall forces are the components that press the wall
/// outwards; unknown values are `nan`. Throws Interrupted if `stop_wanted` becomes true meanwhile.
std::string csv_text(const Run& run, const StopWanted& stop_wanted = never_stop);

/// Reads the run in `folder` and writes its `plate.csv` there. Throws Interrupted, and leaves the file as it
/// is, if `stop_wanted` becomes true meanwhile.
void write_csv(const std::filesystem::path& folder, const StopWanted& stop_wanted = never_stop);

}  // namespace mcdem::io
