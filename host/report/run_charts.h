// The paper's four figures as charts of a page.
#pragma once
#include "report/figure_parts.h"
#include "report/page.h"

namespace mcdem {

/// Those that can be drawn; `notes` says which cannot, and why.
struct RunCharts {
    std::vector<Chart> charts;
    std::vector<std::string> notes;
};
RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options = {});

}  // namespace mcdem
