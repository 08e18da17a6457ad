// The paper's four figures as charts of a page.
#pragma once
#include "report/page.h"
#include "report/run_figures.h"

namespace mcdem {

/// Those that can be drawn; `notes` says which cannot, and why.
struct RunCharts {
    std::vector<Chart> charts;
    std::vector<std::string> notes;
};
RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options = {});

}  // namespace mcdem
