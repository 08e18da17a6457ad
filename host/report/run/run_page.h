// Runs on a page: tables, the paper's figures, the packing in space, and where it all comes from.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/page/packing_view.h"
#include "report/page/page.h"
#include "report/run/run_figures.h"

namespace mcdem::inline report {

/// Where a run's results come from.
struct RunOrigin {
    std::string path;                                          ///< of its folder or file
    const Run* run = nullptr;                                  ///< observables suffice
    std::vector<std::pair<std::string, std::string>> digests;  ///< file and the SHA-256 of it
};

struct RunsOnPage {
    std::vector<RunOrigin> origins;
    std::vector<Setting> settings;     ///< of all runs, with contacts where recorded
    std::optional<Setting> reference;  ///< what they are held against
    FigureOptions figures;
    std::vector<ShownPacking> packings;
    std::vector<std::string> left_out;  ///< of the packings: which scans and grains are not shown
    PackingLimits limits;
};

void add_runs(Page& page, const RunsOnPage& runs);

}  // namespace mcdem::report
