#include <fmt/format.h>

#include <algorithm>

#include "metrics/top_force.h"
#include "report/figure_parts.h"

namespace mcdem {
namespace {

double largest(const Series& series) {
    double force = 0;
    for (const auto& level : level_means(series.levels, top_force))
        force = std::fmax(force, level.mean.value);
    return force;
}

std::string words_with_ratio(const Series& series) {
    if (!series.comparison || !series.comparison->Rtop.available()) return series.words;
    return fmt::format("{}, Rtop {:.2f}", series.words, series.comparison->Rtop.value);
}

}  // namespace

Figure top_force_figure(const Cast& cast) {
    Cast ordered = cast;  // the key from top to bottom as the curves end
    std::stable_sort(ordered.simulated.begin(), ordered.simulated.end(),
                     [](const Series& a, const Series& b) { return largest(a) > largest(b); });
    PlotScript script("top_force", "Force on the plate against its displacement, mean over cycles.",
                      "displacement_mm,top_force_N,standard_error_N,phase,setting");
    script.title("Force on the top plate");
    script.set("xlabel 'plate displacement [mm]'");
    script.set("xrange [0:*]");
    script.set("ylabel 'top force [N]'");
    script.set("yrange [0:*]");
    draw_curves(script, ordered, [](const Series& series) { return level_means(series.levels, top_force); });
    draw_key(script, ordered, words_with_ratio);
    return script.figure();
}

}  // namespace mcdem
