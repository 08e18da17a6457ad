// The four figures of the paper as charts of a page.
#pragma once
#include "report/page/page.h"
#include "report/run/run_figures.h"

namespace mcdem::inline report {

/// The charts that can be drawn; `notes` lists the others with reasons.
struct RunCharts {
    std::vector<Chart> charts;
    std::vector<std::string> notes;
};
RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options = {});

}  // namespace mcdem::report
