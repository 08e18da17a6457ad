// What the charts of runs have in common: series as traces of plotly.js.
#pragma once
#include "report/page/page.h"
#include "report/run/run_figures.h"

namespace mcdem::inline report {

/// What a point says when pointed at: x and y with their formats and units.
struct PointWords {
    std::string x, y;  ///< "%{x:.2f} mm": in the terms of plotly.js; " ± error" is put behind y
    std::string error = "";
};

/// Traces of one curve: a band of one standard error where it is known, and the line or points over it.
/// `in_key`: whether it has an entry there; all curves of a series come and go with that.
enum class CurveLook { line, dashed, points, open_points };
Json curve_traces(const Series& series, const std::string& colour, const std::vector<FigurePoint>& points,
                  CurveLook look, const PointWords& words, bool in_key);

/// The series' colour; the page's ink for the reference.
std::string chart_colour(const Cast& cast, const Series& series);

void append(Json& traces, const Json& more);

}  // namespace mcdem::report
