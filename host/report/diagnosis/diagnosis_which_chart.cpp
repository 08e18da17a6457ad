#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/diagnosis/diagnosis_charts.h"
#include "report/diagnosis/diagnosis_parts.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

constexpr int which_row_height = 26, which_above_rows = 44, which_below_rows = 56;  // [pixels]

std::string colour_of(const Diagnosis& diagnosis, const Cause& cause) {
    return named_effects(diagnosis).contains(cause.effect) ? diagnosis_colour::named
                                                           : diagnosis_colour::other;
}

std::string hover_words(const Cause& cause) {
    return plot_text(words_of(cause.effect)) + "<br>" +
           plot_text(amount(cause.amplitude, cause.amplitude_error, cause.unit)) +
           fmt::format("<br>gain {:.2f}, probability {}, {} of chi-square", cause.score,
                       percent(cause.confidence), percent(cause.explained));
}

Json scores(const Diagnosis& diagnosis) {
    Json x = Json::array(), y = Json::array(), text = Json::array(), colours = Json::array(),
         bars = Json::array();
    for (std::size_t i = 0; i < diagnosis.ranking.size(); ++i) {
        const auto& cause = diagnosis.ranking[i];
        if (!std::isfinite(cause.score)) continue;
        x.push_back(cause.score), y.push_back(i), text.push_back(hover_words(cause));
        colours.push_back(colour_of(diagnosis, cause)), bars.push_back(fmt::format("{:.1f}", cause.score));
    }
    return {{"type", "bar"},
            {"name", "gain in log likelihood"},
            {"orientation", "h"},
            {"x", x},
            {"y", y},
            {"hovertext", text},
            {"hoverinfo", "text"},
            {"text", bars},
            {"textposition", "auto"},
            {"insidetextfont", {{"color", "#111111"}}},
            {"insidetextanchor", "start"},
            {"cliponaxis", false},
            {"marker", {{"color", colours}}},
            {"showlegend", false}};
}

Json confirmations(const std::vector<Cause>& ranking) {
    Json x = Json::array(), y = Json::array();
    for (std::size_t i = 0; i < ranking.size(); ++i)
        if (ranking[i].confirmed_score && std::isfinite(*ranking[i].confirmed_score))
            x.push_back(*ranking[i].confirmed_score), y.push_back(i);
    return {{"type", "scatter"},
            {"mode", "markers"},
            {"name", "simulated in full"},
            {"x", x},
            {"y", y},
            {"marker",
             {{"symbol", "diamond-open"}, {"size", 10}, {"color", "var(--ink)"}, {"line", {{"width", 1.5}}}}},
            {"hovertemplate", "simulated in full: gain %{x:.2f}<extra></extra>"},
            {"showlegend", false}};
}

Json amplitudes(const Diagnosis& diagnosis) {
    Json x = Json::array(), y = Json::array(), half = Json::array(), text = Json::array(),
         colours = Json::array();
    for (const auto& [place, over, interval] : shown_amplitudes(diagnosis)) {
        x.push_back(over), y.push_back(place), half.push_back(interval);
        text.push_back(hover_words(diagnosis.ranking[place]));
        colours.push_back(colour_of(diagnosis, diagnosis.ranking[place]));
    }
    return {{"type", "scatter"},
            {"mode", "markers"},
            {"name", "fitted amplitude over detection limit"},
            {"x", x},
            {"y", y},
            {"xaxis", "x2"},
            {"error_x",
             {{"type", "data"}, {"array", half}, {"color", "var(--soft)"}, {"width", 3}, {"thickness", 1.2}}},
            {"marker", {{"color", colours}, {"size", 8}}},
            {"text", text},
            {"hoverinfo", "text"},
            {"showlegend", false}};
}

/// A column of text next to the axes, one text per row.
Json column(const std::string& heading, const std::vector<std::string>& words, double x, const char* anchor) {
    Json annotations = Json::array();
    const auto add = [&](const std::string& text, const Json& y, const char* yref, int shift) {
        annotations.push_back({{"text", text},
                               {"xref", "paper"},
                               {"x", x},
                               {"xanchor", anchor},
                               {"yref", yref},
                               {"y", y},
                               {"yshift", shift},
                               {"showarrow", false},
                               {"font", {{"size", 12}}}});
    };
    add(heading, 1, "paper", 12);
    for (std::size_t i = 0; i < words.size(); ++i) add(plot_text(words[i]), i, "y", 0);
    return annotations;
}

Json annotations_of(const std::vector<Cause>& ranking) {
    std::vector<std::string> amounts, probabilities;
    for (const auto& cause : ranking) {
        amounts.push_back(amount(cause.amplitude, cause.amplitude_error, cause.unit));
        probabilities.push_back(percent(cause.confidence));
    }
    auto all = column("group", group_letters(ranking), -0.005, "right");
    for (const auto& more :
         {column("amplitude", amounts, 0.61, "left"), column("probability", probabilities, 1, "right")})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

Json axis(const std::string& title, double from, double to) {
    return {
        {"domain", {from, to}}, {"title", {{"text", title}, {"font", {{"size", 12}}}}}, {"showline", false}};
}

}  // namespace

std::optional<Chart> which_chart(const Diagnosis& diagnosis) {
    const auto& ranking = diagnosis.ranking;
    if (ranking.empty()) return std::nullopt;
    const int rows = static_cast<int>(ranking.size());
    Chart chart{
        .name = "which",
        .title = "Candidate effects",
        .caption =
            "Left: how much better the data are explained with each effect, parameters fitted again in both "
            "cases; diamonds: simulated in full at the fitted amplitude; candidates that share a letter "
            "cannot be told apart by these data. Middle: amplitudes with 90 % intervals, over the smallest "
            "that these data can detect (dashed line); without a dot: never shows. Right: amplitude with one "
            "standard error, probability among the candidates.",
        .height = which_above_rows + which_below_rows + which_row_height * rows,
        .min_width = 760};
    Json names = Json::array(), places = Json::array();
    for (int i = 0; i < rows; ++i) {
        names.push_back(plot_text(words_of(ranking[static_cast<std::size_t>(i)].effect)) + "        ");
        places.push_back(i);
    }
    chart.data = {scores(diagnosis), confirmations(ranking), amplitudes(diagnosis)};
    chart.layout = {{"margin", {{"l", 60}, {"r", 16}, {"t", which_above_rows}, {"b", which_below_rows}}},
                    {"bargap", 0.3},
                    {"annotations", annotations_of(ranking)},
                    {"xaxis", axis("gain in log likelihood", 0, 0.3)},
                    {"xaxis2", axis("amplitude / limit", 0.37, 0.58)},
                    {"yaxis",
                     {{"tickvals", places},
                      {"ticktext", names},
                      {"range", {rows - 0.4, -0.6}},
                      {"showgrid", false},
                      {"showline", false},
                      {"ticks", ""}}},
                    {"shapes", Json::array()}};
    for (const auto& [at, dash] : {std::pair{0, "solid"}, std::pair{1, "dash"}})
        chart.layout["shapes"].push_back(
            {{"type", "line"},
             {"xref", "x2"},
             {"yref", "paper"},
             {"x0", at},
             {"x1", at},
             {"y0", 0},
             {"y1", 1},
             {"line", {{"width", 1}, {"dash", dash}, {"color", "var(--axis)"}}}});
    return chart;
}

}  // namespace mcdem::report
