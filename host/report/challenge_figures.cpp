#include "report/challenge_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "report/diagnosis_words.h"
#include "report/gnuplot.h"

namespace mcdem {
namespace {

using gnuplot::csv_field, gnuplot::csv_number;
using Rows = std::vector<std::vector<std::string>>;

constexpr double normal_quantile_975 = 1.959964;
constexpr const char* point_colour = "#0072B2";

/// Proportions with their intervals: x, part, low, high, cases.
Rows proportion_row(double x, int successes, int trials) {
    const auto [low, high] = wilson_interval(successes, trials);
    return {{csv_number(x), csv_number(double(successes) / trials), csv_number(low), csv_number(high),
             std::to_string(trials)}};
}

void draw_proportions(PlotScript& script, const Rows& rows) {
    const int block = script.add_block(rows);
    const auto points = fmt::format("linewidth 1.2 pointtype 7 linecolor rgb '{}'", point_colour);
    script.plot(block, "using 1:2:3:4 with yerrorbars " + points);
    script.plot(block, "using 1:2:5 with labels left offset 0.7,-0.6 font ',9' textcolor rgb '#222222'");
    script.key("measured, 95 % interval, cases", "with points " + points);
}

void set_proportions(PlotScript& script) {
    for (const char* setting : {"yrange [-0.02:1.04]", "format x '%g'", "format y '%g'", "offsets 0, 0, 0, 0",
                                "key inside right bottom", "rmargin 4"})
        script.set(setting);
}

// confusion matrix: geometry in pixels
constexpr int left = 230, right = 130, top = 160, bottom = 24, cell_width = 60, cell_height = 26;

/// Darker with the part of the row; the number is what counts.
Rows confusion_rows(const ConfusionMatrix& matrix, bool dark) {
    Rows rows;
    for (std::size_t t = 0; t < matrix.truths.size(); ++t) {
        int total = 0;
        for (const int count : matrix.counts[t]) total += count;
        for (std::size_t v = 0; v < matrix.verdicts.size(); ++v) {
            const int count = matrix.counts[t][v];
            const double part = total > 0 ? double(count) / total : 0;
            if ((part > 0.55) != dark) continue;
            const double x = double(v), y = -double(t);
            rows.push_back({csv_number(x), csv_number(y), csv_number(x - 0.49), csv_number(x + 0.49),
                            csv_number(y - 0.47), csv_number(y + 0.47), csv_number(part),
                            count > 0 ? std::to_string(count) : "", csv_field(matrix.truths[t]),
                            csv_field(matrix.verdicts[v])});
        }
    }
    return rows;
}

Rows right_answers(const ConfusionMatrix& matrix) {
    Rows rows;
    for (std::size_t t = 0; t < matrix.truths.size(); ++t)
        for (std::size_t v = 0; v < matrix.verdicts.size(); ++v)
            if (matrix.truths[t] == matrix.verdicts[v])
                rows.push_back({csv_number(double(v)), csv_number(-double(t)), csv_number(v - 0.47),
                                csv_number(v + 0.47), csv_number(-double(t) - 0.43),
                                csv_number(0.43 - double(t))});
    return rows;
}

void set_matrix(PlotScript& script, const ConfusionMatrix& matrix) {
    const auto columns = static_cast<int>(matrix.verdicts.size()),
               rows = static_cast<int>(matrix.truths.size());
    const int width = left + right + cell_width * columns, height = top + bottom + cell_height * rows;
    script.size(width, height);
    for (const char* setting :
         {"border 0", "tics scale 0", "xtics ('' 0)", "ytics ('' 0)", "grid noxtics noytics", "key off",
          "offsets 0, 0, 0, 0", "style fill solid 1 noborder", "cbrange [0:1]"})
        script.set(setting);
    script.set("palette defined (0 '#F1F4F7', 0.25 '#C3DAEC', 0.6 '#3F86BF', 1 '#053B78')");
    script.set(fmt::format("xrange [-0.5:{}]", columns - 0.5));
    script.set(fmt::format("yrange [{}:0.5]", 0.5 - rows));
    script.set(fmt::format("lmargin at screen {}", double(left) / width));
    script.set(fmt::format("rmargin at screen {}", 1 - double(right) / width));
    script.set(fmt::format("tmargin at screen {}", 1 - double(top) / height));
    script.set(fmt::format("bmargin at screen {}", double(bottom) / height));
    script.label("Truth (rows) and verdict (columns), cases",
                 fmt::format("at screen 0.5, screen {} center font ',13'", 1 - 20.0 / height));
    for (int t = 0; t < rows; ++t)
        script.label(words_of(matrix.truths[static_cast<std::size_t>(t)]),
                     fmt::format("at first -0.6, first {} right font ',10'", -t));
    for (int v = 0; v < columns; ++v)
        script.label(words_of(matrix.verdicts[static_cast<std::size_t>(v)]),
                     fmt::format("at first {}, graph 1 offset 0,0.7 left rotate by 35 font ',10'", v));
    script.unset("colorbox");
}

}  // namespace

std::array<double, 2> wilson_interval(int successes, int trials) {
    if (trials <= 0) return {0, 1};
    const double n = trials, part = successes / n, z2 = normal_quantile_975 * normal_quantile_975;
    const double middle = (part + z2 / (2 * n)) / (1 + z2 / n);
    const double half =
        normal_quantile_975 / (1 + z2 / n) * std::sqrt(part * (1 - part) / n + z2 / (4 * n * n));
    return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

double ideal_power(const PowerCurve& curve, double over_limit) {
    const boost::math::normal normal;
    const double threshold = boost::math::quantile(normal, 1 - curve.false_alarm / 2);  // either sign
    const double at_limit = threshold + boost::math::quantile(normal, curve.power_at_limit);
    const double mean = over_limit * at_limit;
    return boost::math::cdf(normal, mean - threshold) + boost::math::cdf(normal, -mean - threshold);
}

Figure confusion_figure(const ConfusionMatrix& matrix) {
    PlotScript script("confusion", "What was called what: cases by truth and verdict.",
                      "column,row,x_from,x_to,y_from,y_to,part_of_row,cases,truth,verdict");
    set_matrix(script, matrix);
    for (const bool dark : {false, true}) {
        const auto rows = confusion_rows(matrix, dark);
        if (rows.empty()) continue;
        const int block = script.add_block(rows);
        script.plot(block,
                    "using 1:2:3:4:5:6:7 with boxxyerror fillcolor palette fillstyle solid 1 noborder");
        script.plot(block, fmt::format("using 1:2:8 with labels font ',10' textcolor rgb '{}'",
                                       dark ? "#fefefe" : "#111111"));
    }
    const auto right = right_answers(matrix);
    if (!right.empty())
        script.plot(
            script.add_block(right),
            "using 1:2:3:4:5:6 with boxxyerror linecolor rgb '#D55E00' linewidth 1.5 fillstyle empty border");
    return script.figure();
}

Figure power_figure(const PowerCurve& curve) {
    PlotScript script(
        "power", "Part of the cases that were detected, by amplitude over the predicted detection limit.",
        "amplitude_over_limit,detected,low,high,cases");
    script.title("How small an effect is seen");
    set_proportions(script);
    script.set("xlabel 'amplitude / predicted detection limit' textcolor rgb '#222222'");
    script.set("ylabel 'part that is detected' textcolor rgb '#222222'");
    double smallest = 0.5, largest = 2;
    Rows measured, ideal;
    for (const auto& point : curve.points) {
        if (point.cases <= 0) continue;
        measured.push_back(proportion_row(point.over_limit, point.detected, point.cases).front());
        smallest = std::min(smallest, point.over_limit);
        largest = std::max(largest, point.over_limit);
    }
    smallest /= 1.2, largest *= 1.2;
    for (int i = 0; i <= 100; ++i) {
        const double x = smallest * std::pow(largest / smallest, i / 100.0);
        ideal.push_back({csv_number(x), csv_number(ideal_power(curve, x))});
    }
    script.set("logscale x");
    script.set(fmt::format("xrange [{}:{}]", smallest, largest));
    const std::string line = "with lines linewidth 1.5 linecolor rgb '#666666'";
    script.plot(script.add_block(ideal), "using 1:2 " + line);
    script.key(fmt::format("as predicted: {:.2g} without an effect, {:.2g} at the limit", curve.false_alarm,
                           curve.power_at_limit),
               line);
    draw_proportions(script, measured);
    return script.figure();
}

Figure confidence_figure(const std::vector<ConfidenceBin>& bins) {
    PlotScript script("confidence",
                      "Part of the verdicts that were right, by the probability they were given with.",
                      "stated,right,low,high,cases");
    script.title("Whether stated probabilities hold");
    set_proportions(script);
    script.set("xlabel 'probability stated' textcolor rgb '#222222'");
    script.set("ylabel 'part that is right' textcolor rgb '#222222'");
    script.set("xrange [-0.02:1.04]");
    Rows measured;
    for (const auto& bin : bins)
        if (bin.cases > 0) measured.push_back(proportion_row(bin.stated, bin.right, bin.cases).front());
    const std::string line = "with lines linewidth 1.5 linecolor rgb '#666666'";
    script.plot(script.add_block({{"0", "0"}, {"1", "1"}}), "using 1:2 " + line);
    script.key("as stated", line);
    draw_proportions(script, measured);
    return script.figure();
}

}  // namespace mcdem
