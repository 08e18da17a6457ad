// Shared code of the charts of runs: series as traces of plotly.js.
#pragma once
#include "report/page/page.h"
#include "report/run/run_figures.h"

namespace mcdem::inline report {

/// Hover text of a point: x and y with formats and units.
struct PointWords {
    std::string x, y;  ///< "%{x:.2f} mm", as in plotly.js; " ± error" is appended to y
    std::string error = "";
};

/// Traces of one curve: a band of one standard error if it is known, with the line or points on top.
/// `in_key`: whether it has a legend entry, which toggles all curves of a series.
enum class CurveLook { line, dashed, points, open_points };
Json curve_traces(const Series& series, const std::string& colour, const std::vector<FigurePoint>& points,
                  CurveLook look, const PointWords& words, bool in_key);

/// Colour of the series; that of text for the reference.
std::string chart_colour(const Cast& cast, const Series& series);

void append(Json& traces, const Json& more);

}  // namespace mcdem::report
