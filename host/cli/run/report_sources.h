// Data of a report in addition to the scans: provenance, and packings for the 3D view.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/run/results.h"
#include "diagnose/decide/diagnosis.h"
#include "report/run/run_page.h"

namespace mcdem::inline cli {

/// diagnosis.json in the folder of a diagnosis, or the file itself; otherwise nothing.
std::optional<std::filesystem::path> diagnosis_file(const std::filesystem::path& path);
Diagnosis read_diagnosis(const std::filesystem::path& file);

/// Provenance of the runs in order, with the SHA-256 of every result file.
std::vector<RunOrigin> origins_of(const std::vector<std::string>& paths, const LoadedRuns& loaded);

/// Adds the first replica of every setting with as many scans as fit, and lists what is left out. Reads scan
/// by scan.
void add_packings(const std::vector<std::string>& paths, const LoadedRuns& loaded, RunsOnPage& runs);

}  // namespace mcdem::cli
