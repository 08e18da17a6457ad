// What a report needs of runs beyond their scans: where they come from, and packings to be seen in space.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/run/results.h"
#include "diagnose/decide/diagnosis.h"
#include "report/run/run_page.h"

namespace mcdem::inline cli {

/// diagnosis.json of a diagnosis' folder, or the file itself; nothing where the path is none of these.
std::optional<std::filesystem::path> diagnosis_file(const std::filesystem::path& path);
Diagnosis read_diagnosis(const std::filesystem::path& file);

/// Of the runs in their order, with the SHA-256 of every result file.
std::vector<RunOrigin> origins_of(const std::vector<std::string>& paths, const LoadedRuns& loaded);

/// Adds the first replica of every setting with the scans that there is room for, and says what is left out.
/// Reads scan by scan.
void add_packings(const std::vector<std::string>& paths, const LoadedRuns& loaded, RunsOnPage& runs);

}  // namespace mcdem::cli
