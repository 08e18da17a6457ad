// The paper's four figures as charts of a page.
#pragma once
#include "report/page/page.h"
#include "report/run/run_figures.h"

namespace mcdem::inline report {

/// Those that can be drawn; `notes` says which cannot, and why.
struct RunCharts {
    std::vector<Chart> charts;
    std::vector<std::string> notes;
};
RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options = {});

}  // namespace mcdem::report
