#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/diagnosis_figures.h"
#include "report/diagnosis_parts.h"
#include "report/diagnosis_words.h"
#include "report/gnuplot.h"
#include "report/labels.h"

namespace mcdem {
namespace {

using gnuplot::csv_number;
using Rows = std::vector<std::vector<std::string>>;

struct Axes {
    double left, right;  ///< of the width
};
constexpr Axes forces{0.075, 0.56}, beside_forces{0.72, 0.95}, alone{0.2, 0.9};

Rows force_rows(const Shrink& shrink) {
    Rows rows;
    for (const auto& [displacement, experiment, before, after] : known_forces(shrink))
        rows.push_back(
            {csv_number(displacement * 1e3), csv_number(experiment), csv_number(before), csv_number(after)});
    return rows;
}

void shade_fitted(PlotScript& script, const Shrink& shrink) {
    const auto [from, to] = shrink.fitted_displacement;
    if (from == to) return;
    script.set(
        fmt::format("object 1 rectangle from first {}, graph 0 to first {}, graph 1 fillcolor rgb '{}' "
                    "fillstyle solid 0.18 noborder behind",
                    from * 1e3, to * 1e3, diagnosis_colour::faint));
    script.label("fitted here",
                 fmt::format("at first {}, graph 0.04 right offset -0.6,0 font ',10'", to * 1e3));
}

void draw_forces(PlotScript& script, const Shrink& shrink, const std::string& after) {
    script.set(fmt::format("lmargin at screen {}", forces.left));
    script.set(fmt::format("rmargin at screen {}", forces.right));
    script.set("xlabel 'plate displacement [mm]' textcolor rgb '#222222'");
    script.set("ylabel 'top force [N]' textcolor rgb '#222222'");
    script.set("yrange [*<0:*]");
    script.set("key inside left top");
    script.set("format x '%g'");
    script.set("offsets 0, graph 0.02, graph 0.04, 0");
    shade_fitted(script, shrink);
    const int block = script.add_block(force_rows(shrink));
    const auto line = [](const char* colour, int dash) {
        return fmt::format("with lines linewidth 2 dashtype {} linecolor rgb '{}'", dash, colour);
    };
    script.plot(block, "using 1:3 " + line(diagnosis_colour::before, 2));
    script.plot(block, "using 1:4 " + line(diagnosis_colour::after, 1));
    const std::string points = "with points pointtype 7 pointsize 0.7 linecolor rgb '#222222'";
    script.plot(block, "using 1:2 " + points);
    script.key("experiment", points);
    script.key("simulated before", line(diagnosis_colour::before, 2));
    script.key(after, line(diagnosis_colour::after, 1));
}

void draw_gap(PlotScript& script, const Shrink& shrink, const Axes& axes) {
    const auto bars = gap_bars(shrink);
    for (const char* setting : {"border 1", "ytics scale 0 ('' 0)", "format x '%g'", "grid xtics noytics",
                                "key off", "offsets 0, 0, 0, 0", "xtics nomirror 25", "xrange [*<0:110<*]",
                                "xlabel 'gap left on data held out [%]' textcolor rgb '#222222'"})
        script.set(setting);
    script.set(fmt::format("lmargin at screen {}", axes.left));
    script.set(fmt::format("rmargin at screen {}", axes.right));
    script.set(fmt::format("yrange [{}:0.6]", 0.4 - double(bars.size())));
    script.set("arrow from 0, graph 0 to 0, graph 1 nohead linewidth 0.6 linecolor rgb '#444444'");
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const auto& [words, colour, value, interval] = bars[i];
        const double y = -double(i), percent_left = value * 100;
        script.label(words, fmt::format("at graph -0.03, first {} right", y));
        const auto [low, high] = interval.value_or(std::array{value, value});
        const int block =
            script.add_block({{csv_number(percent_left), csv_number(y), "0", csv_number(percent_left),
                               csv_number(y - 0.3), csv_number(y + 0.3), csv_number(low * 100),
                               csv_number(high * 100), fmt::format(" {:.0f} %", percent_left + 0.0)}});
        script.plot(
            block,
            fmt::format("using 1:2:3:4:5:6 with boxxyerror fillcolor rgb '{}' fillstyle solid 0.85 noborder",
                        colour));
        if (interval)
            script.plot(block,
                        "using 1:2:7:8 with xerrorbars pointtype 0 linewidth 1.5 linecolor rgb '#222222'");
        script.plot(block, "using 8:2:9 with labels left offset 0.3,0 textcolor rgb '#222222'");
    }
}

}  // namespace

std::vector<std::array<double, 4>> known_forces(const Shrink& shrink) {
    auto rows = shrink.top_force;
    std::erase_if(rows, [](const auto& row) {
        return !std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
    });
    return rows;
}

std::string words_after(const Diagnosis& diagnosis) {
    if (diagnosis.verdict == Verdict::calibration_suspect) return "simulated, recalibrated";
    if (diagnosis.verdict == Verdict::not_converged) return "simulated, refined";
    const auto added = diagnosis.causes.empty() ? "the effect" : words_of(diagnosis.causes.front().effect);
    return shortened("simulated with " + added, 40);
}

std::vector<GapBar> gap_bars(const Shrink& shrink) {
    std::vector<GapBar> bars{{"before", diagnosis_colour::before, 1, {}},
                             {shrink.confirmed ? "after, predicted" : "after",
                              diagnosis_colour::after,
                              1 - shrink.fraction,
                              {{1 - shrink.interval[1], 1 - shrink.interval[0]}}}};
    if (shrink.confirmed)
        bars.push_back({"after, simulated", diagnosis_colour::after, 1 - *shrink.confirmed, {}});
    bars.push_back({"placebo", diagnosis_colour::faint, 1 - shrink.placebo, {}});
    return bars;
}

std::optional<Figure> how_far_figure(const Diagnosis& diagnosis) {
    if (!diagnosis.shrink || !(diagnosis.shrink->before > 0)) return std::nullopt;
    const auto& shrink = *diagnosis.shrink;
    PlotScript script("how_far", "Top force and gap, before and after the effect is added.",
                      "displacement_mm,experiment_N,before_N,after_N; then "
                      "value,row,from,to,row_from,row_to,low,high,text");
    script.size(1000, 460);
    const bool with_forces = force_rows(shrink).size() > 1;
    if (with_forces) {
        script.title("Force on the top plate");
        draw_forces(script, shrink, words_after(diagnosis));
        script.panel();
    }
    script.title("Gap that is left");
    draw_gap(script, shrink, with_forces ? beside_forces : alone);
    return script.figure();
}

}  // namespace mcdem
