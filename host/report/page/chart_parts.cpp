#include "report/page/chart_parts.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline report {
namespace {

/// "#rrggbb" as a light fill; the colour of text is not changed.
std::string faint(const std::string& colour) {
    return colour.starts_with('#') ? colour + "2e" : "var(--grid)";
}

/// Outline of the band. On logarithmic axes it must not reach zero, so the lower edge is limited to a third
/// of the value.
Json band(const Series& series, const std::string& colour, const std::vector<FigurePoint>& points) {
    Json x = Json::array(), y = Json::array();
    for (const auto& p : points) x.push_back(p.x), y.push_back(p.y + p.error);
    for (auto p = points.rbegin(); p != points.rend(); ++p)
        x.push_back(p->x), y.push_back(p->y > 0 ? std::fmax(p->y - p->error, p->y / 3) : p->y - p->error);
    return {{"type", "scatter"},
            {"mode", "lines"},
            {"name", plot_text(series.words) + " ± standard error"},
            {"x", x},
            {"y", y},
            {"fill", "toself"},
            {"fillcolor", faint(colour)},
            {"line", {{"width", 0}}},
            {"hoverinfo", "skip"},
            {"legendgroup", plot_text(series.words)},
            {"showlegend", false}};
}

bool has_errors(const std::vector<FigurePoint>& points) {
    return points.size() > 1 && std::all_of(points.begin(), points.end(),
                                            [](const FigurePoint& p) { return std::isfinite(p.error); });
}

}  // namespace

void append(Json& traces, const Json& more) {
    for (const auto& trace : more) traces.push_back(trace);
}

std::string chart_colour(const Cast& cast, const Series& series) {
    return cast.is_reference(series) ? "var(--ink)" : series.style.colour;
}

Json curve_traces(const Series& series, const std::string& colour, const std::vector<FigurePoint>& points,
                  CurveLook look, const PointWords& words, bool in_key) {
    Json traces = Json::array();
    if (points.empty()) return traces;
    const bool lines = look == CurveLook::line || look == CurveLook::dashed, errors = has_errors(points);
    if (errors && lines) traces.push_back(band(series, colour, points));
    Json x = Json::array(), y = Json::array(), error = Json::array();
    for (const auto& p : points) x.push_back(p.x), y.push_back(p.y), error.push_back(p.error);
    Json trace{{"type", "scatter"},
               {"mode", lines ? "lines+markers" : "markers"},
               {"name", plot_text(series.words)},
               {"x", x},
               {"y", y},
               {"legendgroup", plot_text(series.words)},
               {"showlegend", in_key},
               {"hovertemplate", words.x + "<br>" + words.y + (errors ? words.error : "")}};
    if (errors) trace["customdata"] = error;
    if (errors && !lines)
        trace["error_y"] = {{"type", "data"}, {"array", error}, {"width", 2}, {"thickness", 1}};
    if (lines)
        trace["line"] = {
            {"color", colour}, {"width", 2}, {"dash", look == CurveLook::line ? "solid" : "dash"}};
    trace["marker"] = {{"color", colour},
                       {"size", lines ? 4 : 7},
                       {"symbol", look == CurveLook::open_points ? "circle-open" : "circle"}};
    traces.push_back(trace);
    return traces;
}

}  // namespace mcdem::report
