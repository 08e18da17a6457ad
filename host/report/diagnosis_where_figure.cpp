#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/diagnosis_figures.h"
#include "report/diagnosis_parts.h"
#include "report/diagnosis_words.h"
#include "report/gnuplot.h"

namespace mcdem {
namespace {

constexpr int width = 1000, left = 235, right = 15, top = 98, bottom = 122, row_height = 20;  // [pixels]
constexpr double phase_gap = 0.35, panel_gap = 0.9;                                           // [columns]
constexpr int narrowest_number = 27;  // a cell with its z score written in [pixels]

/// Displacements that differ by less are one column [m].
constexpr double same_displacement = 1e-5;

int phase_order(const std::string& phase) { return phase == "load" ? 0 : phase == "unload" ? 1 : 2; }

using Column = HeatMap::Column;

bool same(const Column& a, const Column& b) {
    return a.phase == b.phase && std::fabs(a.displacement - b.displacement) < same_displacement;
}

bool earlier(const Column& a, const Column& b) {
    if (a.phase != b.phase)
        return std::pair(phase_order(a.phase), a.phase) < std::pair(phase_order(b.phase), b.phase);
    return a.phase == "unload" ? a.displacement > b.displacement : a.displacement < b.displacement;
}

bool within(const WhereCell& cell, const WhereEntry& entry) {
    return cell.observable == entry.observable && (entry.phase.empty() || entry.phase == cell.phase) &&
           cell.displacement >= entry.displacement[0] - same_displacement &&
           cell.displacement <= entry.displacement[1] + same_displacement;
}

}  // namespace

int HeatMap::row(const WhereCell& cell) const {
    return std::find(observables.begin(), observables.end(), cell.observable) - observables.begin();
}

const HeatMap::Column& HeatMap::column(const WhereCell& cell) const {
    return *std::find_if(columns.begin(), columns.end(), [&](const Column& c) {
        return same(c, {cell.phase, cell.displacement});
    });
}

HeatMap heat_map_of(const std::vector<WhereCell>& cells) {
    HeatMap map;
    for (const auto& cell : cells) {
        if (map.row(cell) == static_cast<int>(map.observables.size()))
            map.observables.push_back(cell.observable);
        map.columns.push_back({cell.phase, cell.displacement});
    }
    std::sort(map.columns.begin(), map.columns.end(), earlier);
    map.columns.erase(std::unique(map.columns.begin(), map.columns.end(), same), map.columns.end());
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
        if (c > 0 && map.columns[c].phase != map.columns[c - 1].phase) map.width += phase_gap;
        map.columns[c].x = map.width + 0.5;
        map.width += 1;
    }
    return map;
}

bool has_cells(const Diagnosis& diagnosis) {
    return std::any_of(diagnosis.cells.begin(), diagnosis.cells.end(),
                       [](const WhereCell& cell) { return std::isfinite(cell.z_score); });
}

bool stands_out(const Diagnosis& diagnosis, const WhereCell& cell, bool refitted) {
    if (diagnosis.where_threshold > 0)
        return std::fabs(refitted ? cell.z_score_refitted : cell.z_score) >= diagnosis.where_threshold;
    return !refitted && std::any_of(diagnosis.where.begin(), diagnosis.where.end(),
                                    [&](const WhereEntry& entry) { return within(cell, entry); });
}

double colour_range(const std::vector<WhereCell>& cells) {
    double largest = 0;
    for (const auto& cell : cells) largest = std::max(largest, std::fabs(cell.z_score));
    return std::clamp(std::ceil(largest), 6.0, 8.0);
}

namespace {

using Rows = std::vector<std::vector<std::string>>;

std::vector<std::string> box(double x, double y, double inset, const WhereCell& cell, double z) {
    using gnuplot::csv_field, gnuplot::csv_number;
    const double half = 0.5 - inset;
    return {csv_number(x),
            csv_number(y),
            csv_number(x - half),
            csv_number(x + half),
            csv_number(y - half),
            csv_number(y + half),
            csv_number(z),
            fmt::format("{:.1f}", z),
            csv_field(cell.observable),
            csv_field(cell.phase),
            csv_number(cell.displacement * 1e3)};
}

/// One panel's rows: all cells, those that stand out, and these again by the ink that is legible on them.
struct Boxes {
    Rows all, framed, dark, light;
};

Boxes boxes_of(const Diagnosis& diagnosis, const HeatMap& map, bool refitted, double range) {
    Boxes boxes;
    const double shift = refitted ? map.width + panel_gap : 0;
    for (const auto& cell : diagnosis.cells) {
        const double z = refitted ? cell.z_score_refitted : cell.z_score;
        if (!std::isfinite(z)) continue;
        const double x = map.column(cell).x + shift, y = -map.row(cell);
        boxes.all.push_back(box(x, y, 0.02, cell, z));
        if (!stands_out(diagnosis, cell, refitted)) continue;
        boxes.framed.push_back(box(x, y, 0.05, cell, z));
        (std::fabs(z) > 0.7 * range ? boxes.dark : boxes.light).push_back(boxes.framed.back());
    }
    return boxes;
}

void draw_boxes(PlotScript& script, const Boxes& boxes, bool numbers) {
    const auto draw = [&](const Rows& rows, const std::string& how) {
        if (!rows.empty()) script.plot(script.add_block(rows), how);
    };
    draw(boxes.all, "using 1:2:3:4:5:6:7 with boxxyerror fillcolor palette fillstyle solid 1 noborder");
    draw(boxes.framed,
         "using 1:2:3:4:5:6 with boxxyerror linecolor rgb '#111111' linewidth 1.3 fillstyle empty border");
    if (!numbers) return;
    draw(boxes.dark, "using 1:2:8 with labels font ',8' textcolor rgb '#fefefe'");
    draw(boxes.light, "using 1:2:8 with labels font ',8' textcolor rgb '#111111'");
}

void label_panel(PlotScript& script, const HeatMap& map, double shift, const std::string& heading) {
    script.label(heading,
                 fmt::format("at first {}, graph 1 offset 0,2.4 center font ',11'", shift + map.width / 2));
    for (auto first = map.columns.begin(); first != map.columns.end();) {
        const auto last = std::find_if(first, map.columns.end(),
                                       [&](const Column& column) { return column.phase != first->phase; });
        const auto words = first->phase.empty() ? "whole cycle" : first->phase + "ing →";
        script.label(words, fmt::format("at first {}, graph 1 offset 0,0.9 center font ',10'",
                                        shift + (first->x + std::prev(last)->x) / 2));
        first = last;
    }
    const auto every = map.columns.size() / 14 + 1;  // more would run into each other
    for (std::size_t c = 0; c < map.columns.size(); c += every)
        script.label(
            fmt::format("{:.3g}", map.columns[c].displacement * 1e3),
            fmt::format("at first {}, graph 0 offset 0,-0.8 center font ',9'", shift + map.columns[c].x));
    script.label("plate displacement [mm]",
                 fmt::format("at first {}, graph 0 offset 0,-2.1 center font ',10'", shift + map.width / 2));
}

void set_frame(PlotScript& script, const HeatMap& map, int height) {
    for (const char* setting :
         {"border 0", "tics scale 0", "xtics ('' 0)", "ytics ('' 0)", "grid noxtics noytics", "key off",
          "offsets 0, 0, 0, 0", "style fill solid 1 noborder"})
        script.set(setting);
    script.set(fmt::format("xrange [0:{}]", 2 * map.width + panel_gap));
    script.set(fmt::format("yrange [{}:0.5]", 0.5 - static_cast<double>(map.observables.size())));
    script.set(fmt::format("lmargin at screen {}", double(left) / width));
    script.set(fmt::format("rmargin at screen {}", 1 - double(right) / width));
    script.set(fmt::format("tmargin at screen {}", 1 - double(top) / height));
    script.set(fmt::format("bmargin at screen {}", double(bottom) / height));
}

void set_colours(PlotScript& script, double range, int height) {
    script.set(
        "palette defined (-1 '#053B78', -0.6 '#3F86BF', -0.25 '#B9D5EA', 0 '#F4F4F2', 0.25 '#F9D3AE', "
        "0.6 '#E08530', 1 '#8F3A04')");
    script.set(fmt::format("cbrange [{}:{}]", -range, range));
    script.set("cbtics 2 font ',9' textcolor rgb '#222222'");
    script.set(fmt::format(
        "colorbox horizontal user origin screen 0.4, screen {} size screen 0.42, screen {} noborder",
        52.0 / height, 10.0 / height));
    script.label("measured less simulated, over its noise [sigma]",
                 fmt::format("at screen 0.61, screen {} center font ',10'", 14.0 / height));
}

}  // namespace

std::optional<Figure> where_figure(const Diagnosis& diagnosis) {
    if (!has_cells(diagnosis)) return std::nullopt;
    const auto map = heat_map_of(diagnosis.cells);
    const int height = top + bottom + row_height * static_cast<int>(map.observables.size());
    const double range = colour_range(diagnosis.cells);
    PlotScript script("where", "Gap by observable and plate displacement, in sigmas of its noise.",
                      "x,y,x_from,x_to,y_from,y_to,z_score,z_score_text,observable,phase,displacement_mm");
    script.size(width, height);
    script.label("Where simulation and experiment differ",
                 fmt::format("at screen 0.5, screen {} center font ',14'", 1 - 22.0 / height));
    set_frame(script, map, height);
    set_colours(script, range, height);
    for (std::size_t r = 0; r < map.observables.size(); ++r)
        script.label(words_of(map.observables[r]),
                     fmt::format("at first -0.25, first {} right font ',10'", -double(r)));
    label_panel(script, map, 0, "as stated");
    label_panel(script, map, map.width + panel_gap, "after recalibration");
    const double cell_width = (width - left - right) / (2 * map.width + panel_gap);
    for (const bool refitted : {false, true})
        draw_boxes(script, boxes_of(diagnosis, map, refitted, range), cell_width >= narrowest_number);
    return script.figure();
}

}  // namespace mcdem
