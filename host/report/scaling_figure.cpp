#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/scaling.h"
#include "report/figure_parts.h"
#include "report/gnuplot.h"

namespace mcdem {
namespace {

using gnuplot::csv_field;
using gnuplot::csv_number;

constexpr double mN_m = 1e-3;

Rows scaling_rows(const Series& series, const std::vector<ScalingPoint>& points, Phase phase) {
    Rows rows;
    for (const auto& p : points)
        if (p.phase == phase)
            rows.push_back({csv_number(p.product.value / mN_m), csv_number(p.top_force.value),
                            csv_number(p.product.standard_error / mN_m),
                            csv_number(p.top_force.standard_error), csv_number(p.displacement * 1e3),
                            std::string(name(phase)), csv_field(series.setting.label)});
    return rows;
}

double largest_product(const std::vector<ScalingPoint>& points) {
    double largest = 0;
    for (const auto& p : points) largest = std::fmax(largest, p.product.value);
    return largest;
}

/// About a fourteenth of the axis, rounded to 1, 2 or 5 times a power of ten [mN m].
double shift_between_series(double largest) {
    const double wanted = largest / mN_m / 14, power = std::pow(10, std::floor(std::log10(wanted)));
    return power * (wanted < 2 * power ? 1 : wanted < 5 * power ? 2 : 5);
}

void draw_series(PlotScript& script, const Series& series, const std::vector<ScalingPoint>& points,
                 double shift) {
    const auto colour = fmt::format("linecolor rgb '{}'", series.style.colour);
    const auto fit = fit_scaling(points);
    const double end = largest_product(points);
    const int line = script.add_block({{"0", "0", "", "", "", "fit", csv_field(series.setting.label)},
                                       {csv_number(end / mN_m), csv_number(fit.coefficient * end), "", "", "",
                                        "fit", csv_field(series.setting.label)}});
    script.plot(line, fmt::format("using ($1+{}):2 with lines linewidth 1 {}", shift, colour));
    for (Phase phase : {Phase::load, Phase::unload}) {
        const auto rows = scaling_rows(series, points, phase);
        if (rows.empty()) continue;
        const int shape = phase == Phase::load ? series.style.filled_point : series.style.open_point;
        script.plot(
            script.add_block(rows),
            fmt::format("using ($1+{}):2 with points {} pointtype {} pointsize 0.7", shift, colour, shape));
    }
    script.key(fmt::format("{}, {:.0f} /m", series.words, fit.coefficient),
               fmt::format("with points {} pointtype {} pointsize 0.9", colour, series.style.filled_point));
}

}  // namespace

std::optional<Figure> scaling_figure(const Cast& cast) {
    PlotScript script("scaling", "Scaling law: force on the plate against averages over the packing.",
                      "product_mN_m,top_force_N,product_standard_error_mN_m,top_force_standard_error_N,"
                      "displacement_mm,phase,setting");
    script.title("Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩, slopes of the lines through zero");
    script.set("ylabel 'top force F [N]'");
    script.set("xrange [0:*]");
    script.set("yrange [0:*]");
    std::vector<std::pair<const Series*, std::vector<ScalingPoint>>> known;
    double largest = 0;
    const auto look_at = [&](const Series& series) {
        auto points = scaling_points(series.levels);
        if (!(largest_product(points) > 0)) return;
        largest = std::max(largest, largest_product(points));
        known.emplace_back(&series, std::move(points));
    };
    if (cast.reference) look_at(*cast.reference);
    for (const auto& series : cast.simulated) look_at(series);
    if (known.empty()) return std::nullopt;
    const double shift = known.size() > 1 ? shift_between_series(largest) : 0;
    const auto shifted = shift > 0 ? fmt::format(", each series {:g} further right", shift) : "";
    script.set(fmt::format("xlabel '⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩ [mN m]{}'", shifted));
    for (std::size_t s = 0; s < known.size(); ++s)
        draw_series(script, *known[s].first, known[s].second, shift * static_cast<double>(s));
    script.key(" ", "with lines linecolor rgb 'white'");
    script.key("loading", "with points linecolor rgb '#666666' pointtype 7 pointsize 0.9");
    script.key("unloading", "with points linecolor rgb '#666666' pointtype 6 pointsize 0.9");
    return script.figure();
}

}  // namespace mcdem
