// What a report needs of runs beyond their scans: where they come from, and packings to be seen in space.
#pragma once
#include <string>
#include <vector>

#include "cli/results.h"
#include "report/run_page.h"

namespace mcdem {

/// Of the runs in their order, with the SHA-256 of every result file.
std::vector<RunOrigin> origins_of(const std::vector<std::string>& paths, const LoadedRuns& loaded);

/// Adds the first replica of every setting with the scans that there is room for, and says what is left out.
/// Reads scan by scan.
void add_packings(const std::vector<std::string>& paths, const LoadedRuns& loaded, RunsOnPage& runs);

}  // namespace mcdem
