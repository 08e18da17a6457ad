#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/diagnosis_figures.h"
#include "report/diagnosis_parts.h"
#include "report/diagnosis_words.h"
#include "report/gnuplot.h"

namespace mcdem {
namespace {

using gnuplot::csv_field, gnuplot::csv_number;
using Rows = std::vector<std::vector<std::string>>;

constexpr int width = 1000, top = 84, bottom = 62, row_height = 24;  // [pixels]
constexpr double interval_90 = 1.6449;                               // sigmas on either side

struct Axes {
    double left, right;  ///< of the width
};
constexpr Axes scores{0.245, 0.50}, amplitudes{0.54, 0.75};
constexpr double amount_x = 0.765, probability_x = 0.985;

/// Score and amplitude are drawn in the same rows.
void set_rows(PlotScript& script, const Axes& axes, std::size_t rows, int height) {
    for (const char* setting : {"border 1", "ytics scale 0 ('' 0)", "grid xtics noytics", "key off",
                                "offsets 0, 0, 0, 0", "xtics nomirror font ',10' autofreq", "format x '%g'"})
        script.set(setting);
    script.set(fmt::format("yrange [{}:0.6]", 0.4 - static_cast<double>(rows)));
    script.set(fmt::format("lmargin at screen {}", axes.left));
    script.set(fmt::format("rmargin at screen {}", axes.right));
    script.set(fmt::format("tmargin at screen {}", 1 - double(top) / height));
    script.set(fmt::format("bmargin at screen {}", double(bottom) / height));
}

Rows score_rows(const Diagnosis& diagnosis, bool named) {
    const auto all_named = named_effects(diagnosis);
    const auto& ranking = diagnosis.ranking;
    Rows rows;
    for (std::size_t i = 0; i < ranking.size(); ++i) {
        const auto& cause = ranking[i];
        if (all_named.contains(cause.effect) != named || !std::isfinite(cause.score)) continue;
        const double y = -double(i);
        rows.push_back({csv_number(cause.score), csv_number(y), "0", csv_number(cause.score),
                        csv_number(y - 0.34), csv_number(y + 0.34), fmt::format("{:.1f}", cause.score),
                        csv_field(cause.effect)});
    }
    return rows;
}

Rows confirmed_rows(const std::vector<Cause>& ranking) {
    Rows rows;
    for (std::size_t i = 0; i < ranking.size(); ++i)
        if (ranking[i].confirmed_score && std::isfinite(*ranking[i].confirmed_score))
            rows.push_back({csv_number(*ranking[i].confirmed_score), csv_number(-double(i))});
    return rows;
}

/// A point out of sight: axes appear also where there is nothing to draw.
void plot_nothing(PlotScript& script) { script.plot(script.add_block({{"0", "5"}}), "using 1:2 with dots"); }

void draw_scores(PlotScript& script, const Diagnosis& diagnosis) {
    const auto& ranking = diagnosis.ranking;
    double largest = 1, smallest = 0;
    for (const auto& cause : ranking) {
        for (const double score : {cause.score, cause.confirmed_score.value_or(0)})
            if (std::isfinite(score))
                largest = std::max(largest, score), smallest = std::min(smallest, score);
    }
    script.set(
        fmt::format("xrange [{}:{}]", smallest, largest + 0.16 * (largest - smallest)));  // room for numbers
    script.set("xlabel 'gain in log likelihood' font ',10' textcolor rgb '#222222'");
    for (const bool named : {true, false}) {
        const auto rows = score_rows(diagnosis, named);
        if (rows.empty()) continue;
        const int block = script.add_block(rows);
        script.plot(
            block,
            fmt::format("using 1:2:3:4:5:6 with boxxyerror fillcolor rgb '{}' fillstyle solid 1 noborder",
                        named ? diagnosis_colour::named : diagnosis_colour::other));
        script.plot(
            block,
            "using (($1 > 0) ? $1 : 0):2:7 with labels left offset 0.4,0 font ',9' textcolor rgb '#222222'");
    }
    plot_nothing(script);
    const auto confirmed = confirmed_rows(ranking);
    if (!confirmed.empty())
        script.plot(script.add_block(confirmed),
                    "using 1:2 with points pointtype 12 pointsize 1.1 linecolor rgb '#222222'");
}

Rows amplitude_rows(const Diagnosis& diagnosis, bool named) {
    const auto all_named = named_effects(diagnosis);
    Rows rows;
    for (const auto& [place, over, half] : shown_amplitudes(diagnosis))
        if (all_named.contains(diagnosis.ranking[place].effect) == named)
            rows.push_back({csv_number(over), csv_number(-double(place)), csv_number(over - half),
                            csv_number(over + half)});
    return rows;
}

void draw_amplitudes(PlotScript& script, const Diagnosis& diagnosis) {
    script.set("xlabel 'fitted amplitude / detection limit' font ',10' textcolor rgb '#222222'");
    script.set("xrange [*<0:1.2<*]");
    script.set("offsets graph 0.04, graph 0.04, 0, 0");
    script.set("arrow from 1, graph 0 to 1, graph 1 nohead dashtype 2 linecolor rgb '#222222'");
    script.set("arrow from 0, graph 0 to 0, graph 1 nohead linewidth 0.6 linecolor rgb '#444444'");
    for (const bool named : {true, false}) {
        const auto rows = amplitude_rows(diagnosis, named);
        if (rows.empty()) continue;
        const auto* colour = named ? diagnosis_colour::named : diagnosis_colour::other;
        const int block = script.add_block(rows);
        script.plot(block,
                    fmt::format("using 1:2:3:4 with xerrorbars pointtype 7 pointsize 0.7 linecolor rgb '{}'",
                                colour));
    }
    plot_nothing(script);
}

void label_rows(PlotScript& script, const std::vector<Cause>& ranking) {
    const auto letters = group_letters(ranking);
    const auto at = [&](double x, std::size_t row, const char* how) {
        return fmt::format("at screen {}, first {} {} font ',10'", x, -double(row), how);
    };
    for (std::size_t i = 0; i < ranking.size(); ++i) {
        script.label(words_of(ranking[i].effect), at(scores.left - 0.035, i, "right"));
        script.label(letters[i], at(scores.left - 0.008, i, "right"));
        script.label(amount(ranking[i].amplitude, ranking[i].amplitude_error, ranking[i].unit),
                     at(amount_x, i, "left"));
        script.label(percent(ranking[i].confidence), at(probability_x, i, "right"));
    }
    const auto heading = [&](const char* words, double x, const char* how) {
        script.label(words, fmt::format("at screen {}, graph 1 offset 0,0.6 {} font ',10'", x, how));
    };
    heading("group", scores.left - 0.008, "right");
    heading("amplitude", amount_x, "left");
    heading("probability", probability_x, "right");
}

}  // namespace

std::set<std::string> named_effects(const Diagnosis& diagnosis) {
    if (diagnosis.verdict != Verdict::effect && diagnosis.verdict != Verdict::group) return {};
    const auto& leader = diagnosis.ranking.front();
    std::set<std::string> named(leader.group.begin(), leader.group.end());
    named.insert(leader.effect);
    return named;
}

std::vector<ShownAmplitude> shown_amplitudes(const Diagnosis& diagnosis) {
    std::vector<ShownAmplitude> shown;
    const auto& ranking = diagnosis.ranking;
    for (std::size_t i = 0; i < ranking.size(); ++i) {
        const auto limit =
            std::find_if(diagnosis.detection_limits.begin(), diagnosis.detection_limits.end(),
                         [&](const DetectionLimit& l) { return l.effect == ranking[i].effect; });
        if (limit == diagnosis.detection_limits.end() || !std::isfinite(limit->minimum_amplitude) ||
            !(limit->minimum_amplitude > 0))
            continue;
        shown.push_back({i, ranking[i].amplitude / limit->minimum_amplitude,
                         interval_90 * ranking[i].amplitude_error / limit->minimum_amplitude});
    }
    return shown;
}

std::vector<std::string> group_letters(const std::vector<Cause>& ranking) {
    std::vector<std::set<std::string>> groups;
    for (const auto& cause : ranking) {
        const std::set<std::string> group(cause.group.begin(), cause.group.end());
        if (group.size() > 1 && std::find(groups.begin(), groups.end(), group) == groups.end())
            groups.push_back(group);
    }
    const auto part_of_another = [&](const std::set<std::string>& group) {
        return std::any_of(groups.begin(), groups.end(), [&](const std::set<std::string>& other) {
            return other.size() > group.size() &&
                   std::includes(other.begin(), other.end(), group.begin(), group.end());
        });
    };
    std::vector<std::string> letters(ranking.size());
    char letter = 'A';
    for (const auto& group : groups) {
        if (part_of_another(group)) continue;
        for (std::size_t i = 0; i < ranking.size(); ++i)
            if (group.contains(ranking[i].effect)) letters[i] += letter;
        letter = letter == 'Z' ? 'a' : static_cast<char>(letter + 1);
    }
    return letters;
}

std::optional<Figure> which_figure(const Diagnosis& diagnosis) {
    const auto& ranking = diagnosis.ranking;
    if (ranking.empty()) return std::nullopt;
    const int height = top + bottom + row_height * static_cast<int>(ranking.size());
    PlotScript script("which",
                      "Candidate effects by score, and their amplitudes over the smallest detectable ones.",
                      "value,row,from,to,row_from,row_to,text,effect");
    script.size(width, height);
    set_rows(script, scores, ranking.size(), height);
    script.label("Candidate effects",
                 fmt::format("at screen 0.5, screen {} center font ',14'", 1 - 22.0 / height));
    label_rows(script, ranking);
    draw_scores(script, diagnosis);
    script.panel();
    set_rows(script, amplitudes, ranking.size(), height);
    draw_amplitudes(script, diagnosis);
    return script.figure();
}

}  // namespace mcdem
