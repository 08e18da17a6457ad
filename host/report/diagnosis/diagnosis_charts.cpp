#include "report/diagnosis/diagnosis_charts.h"

#include <fmt/format.h>

#include "report/diagnosis/diagnosis_values.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

// [pixels]
constexpr int where_height = 120, where_row = 22, where_width = 300, where_column = 60;
constexpr int which_height = 100, which_row = 26, gap_height = 110, gap_row = 36;

int count(const Json& list) { return static_cast<int>(list.size()); }

Chart where_chart(const Diagnosis& diagnosis, const Json& values) {
    std::string caption =
        "Orange: the experiment lies above the simulation, blue: below. Time runs from left to right. Left: "
        "parameters as stated; right: after they were fitted within their uncertainty.";
    if (diagnosis.where_threshold > 0)
        caption += fmt::format(" Framed: beyond {:.1f} sigma, which noise alone seldom reaches in any cell.",
                               diagnosis.where_threshold);
    return {.name = "where",
            .title = "Where simulation and experiment differ",
            .caption = caption,
            .values = values,
            .height = where_height + where_row * count(values["observables"]),
            .min_width = where_width + where_column * count(values["columns"])};
}

Chart which_chart(const Diagnosis& diagnosis, Json values) {
    for (std::size_t i = 0; i < diagnosis.ranking.size(); ++i)
        values["rows"][i]["explained"] = percent(diagnosis.ranking[i].explained);
    return {.name = "which",
            .title = "Candidate effects",
            .caption =
                "Left: how much better the data are explained with each effect, parameters fitted again in "
                "both cases; diamonds: simulated in full at the fitted amplitude; candidates that share a "
                "letter cannot be told apart by these data. Middle: amplitudes with 90 % intervals, over the "
                "smallest that these data can detect (dashed line); without a dot: never shows. Right: "
                "amplitude with one standard error, probability among the candidates.",
            .values = values,
            .height = which_height + which_row * count(values["rows"]),
            .min_width = 760};
}

}  // namespace

std::vector<Chart> diagnosis_charts(const Diagnosis& diagnosis) {
    const Json values = diagnosis_figure_values(diagnosis);
    std::vector<Chart> charts;
    if (values.contains("where")) charts.push_back(where_chart(diagnosis, values["where"]));
    if (values.contains("which")) charts.push_back(which_chart(diagnosis, values["which"]));
    if (!values.contains("how_far")) return charts;
    const Json& how_far = values["how_far"];
    if (!how_far["forces"].is_null())
        charts.push_back({.name = "how_far",
                          .title = "Force on the plate, before and after",
                          .caption = "Shaded: where the effect was fitted.",
                          .values = how_far["forces"],
                          .log_axes = "y",
                          .height = 400});
    charts.push_back({.name = "gap_left",
                      .title = "Gap that is left",
                      .caption = "On data held out (" + diagnosis.gap_reduction->held_out +
                                 "), with its 90 % interval; placebo: the best of many made-up effects.",
                      .values = {{"gap_label", how_far["gap_label"]}, {"bars", how_far["bars"]}},
                      .height = gap_height + gap_row * count(how_far["bars"])});
    return charts;
}

}  // namespace mcdem::report
