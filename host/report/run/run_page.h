// A page of runs: tables, the figures of the paper, the packing in 3D, and provenance.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/page/packing_view.h"
#include "report/page/page.h"
#include "report/run/run_figures.h"

namespace mcdem::inline report {

struct RunOrigin {
    std::string path;                                          ///< of its folder or file
    const Run* run = nullptr;                                  ///< observables are sufficient
    std::vector<std::pair<std::string, std::string>> digests;  ///< file and its SHA-256
};

struct RunsOnPage {
    std::vector<RunOrigin> origins;
    std::vector<Setting> settings;     ///< of all runs, with contacts if recorded
    std::optional<Setting> reference;  ///< for comparison
    FigureOptions figures;
    std::vector<ShownPacking> packings;
    std::vector<std::string> left_out;  ///< scans and grains of the packings that are not shown
    PackingLimits limits;
};

void add_runs(Page& page, const RunsOnPage& runs);

// Its parts.

/// "514 grains in a box, compressed by a plate, 20 cycles; 7 settings, 32 packings each."
std::string what_was_simulated(const std::vector<Setting>& settings);

/// "Force on the plate at 30.13 mm: Independent contacts 7.19 N, MC-DEM 15.98 N." For a cell its largest mean
/// stress. Also states how many replicas stopped early.
std::string main_result(const std::vector<Setting>& settings);

/// The charts that can be drawn; `notes` lists the others with reasons.
struct RunCharts {
    std::vector<Chart> charts;
    std::vector<std::string> notes;
};
RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options = {});

}  // namespace mcdem::report
