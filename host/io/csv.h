// Summaries as CSV.
#pragma once
#include <filesystem>
#include <string>

#include "core/recording.h"

namespace mcdem::inline io {

/// The text of `plate.csv`: one row per replica and scan, without positions and contacts. The last columns
/// are the scene keys that differ between replicas. Wall forces are the components that press the wall
/// outwards; unknown values are `nan`.
std::string csv_text(const Run& run);

/// Writes it to `<folder>/plate.csv`.
void write_csv(const Run& run, const std::filesystem::path& folder);

}  // namespace mcdem::io
