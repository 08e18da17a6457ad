// Summaries as CSV, for spreadsheets.
#pragma once
#include <filesystem>
#include <string>

#include "core/recording.h"

namespace mcdem::inline io {

/// The text of `plate.csv`: one row per replica and scan, without positions and contacts.
/// A column for each scene key that is not the same in all replicas comes last.
/// Wall forces are the components that press the wall outwards; what is not known is `nan`.
std::string csv_text(const Run& run);

/// Writes it to `<folder>/plate.csv`.
void write_csv(const Run& run, const std::filesystem::path& folder);

}  // namespace mcdem::io
