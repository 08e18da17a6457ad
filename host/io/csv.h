// Summaries as CSV, for spreadsheets and gnuplot.
#pragma once
#include <filesystem>

#include "core/recording.h"

namespace mcdem {

/// Writes `<folder>/plate.csv`: one row per replica and scan, without positions and contacts.
/// Wall forces are the components that press the wall outwards; what is not known is `nan`.
void write_csv(const Run& run, const std::filesystem::path& folder);

}  // namespace mcdem
