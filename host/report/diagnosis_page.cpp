#include "report/diagnosis_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/atomic_file.h"
#include "diagnose/effects.h"
#include "diagnose/scan_observables.h"
#include "report/diagnosis_figures.h"
#include "report/diagnosis_page_style.h"
#include "report/diagnosis_tables.h"
#include "report/diagnosis_text.h"
#include "report/diagnosis_words.h"
#include "report/draw_figure.h"
#include "report/html.h"

namespace mcdem {
namespace {

std::string headline(Verdict verdict) {
    switch (verdict) {
        case Verdict::no_gap:
            return "No detectable gap";
        case Verdict::effect:
            return "A gap, consistent with one effect";
        case Verdict::group:
            return "A gap, consistent with a group of effects";
        case Verdict::unknown_effect:
            return "A gap that no known effect explains";
        case Verdict::calibration_suspect:
            break;
    }
    return "A stated parameter is suspect";
}

std::string heading(const std::string& text) { return "<h2>" + html_text(text) + "</h2>\n"; }
std::string subheading(const std::string& text) { return "<h3>" + html_text(text) + "</h3>\n"; }
std::string paragraph(const std::string& text) { return "<p>" + html_text(text) + "</p>\n"; }

/// A table under its heading; nothing where it has no rows.
std::string titled(const std::string& title, const TextTable& table) {
    return table.rows.empty() ? "" : subheading(title) + html_table(table);
}

std::string picture(const std::string& svg, const std::string& name, const std::string& about,
                    const std::string& caption) {
    if (svg.empty()) return "";
    return "<figure><div>" + inline_svg(svg, name, about) + "</div>\n<figcaption>" + html_text(caption) +
           "</figcaption></figure>\n";
}

std::string top_of(const Diagnosis& diagnosis) {
    std::string html =
        "<p class=\"kicker\">Diagnosis of the gap between simulation and experiment</p>\n<h1>" +
        html_text(headline(diagnosis.verdict)) + "</h1>\n<p class=\"lead\">" +
        html_text(verdict_sentence(diagnosis)) + "</p>\n<dl>\n";
    for (const auto& [about, says] : verdict_lines(diagnosis))
        html += "<dt>" + html_text(about) + "</dt><dd>" + html_text(says) + "</dd>\n";
    return html + "</dl>\n";
}

std::string gap_section(const Diagnosis& diagnosis) {
    return heading("Gap") +
           paragraph(fmt::format(
               "Two tests, each ranked against simulated experiments without any gap: one of all "
               "differences together ({}), one along the known effects ({}). Corrected for there "
               "being two: {}.",
               p_words(diagnosis.p_omnibus), p_words(diagnosis.p_directed), p_words(diagnosis.p_value)));
}

/// What the rows of the picture mean, of those in it.
TextTable table_of_observables(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"observable", Align::left}, {"what it is", Align::left}};
    for (const auto& observable : observables()) {
        const auto is_it = [&](const WhereCell& cell) { return cell.observable == observable.name; };
        if (std::any_of(diagnosis.cells.begin(), diagnosis.cells.end(), is_it))
            table.rows.push_back({words_of(std::string(observable.name)), std::string(observable.meaning)});
    }
    return table;
}

/// What the amplitudes of the candidates mean.
TextTable table_of_effects(const Diagnosis& diagnosis) {
    TextTable table;
    table.columns = {{"effect", Align::left}, {"amplitude", Align::left}, {"source", Align::left}};
    for (const auto& cause : diagnosis.ranking)
        if (const auto* effect = find_effect(cause.effect))
            table.rows.push_back(
                {words_of(cause.effect), std::string(effect->formula), std::string(effect->source)});
    return table;
}

std::string where_section(const Diagnosis& diagnosis, const std::string& svg) {
    auto caption = std::string(
        "Orange: the experiment lies above the simulation, blue: below. Time runs from left to right. "
        "Left: parameters as stated; right: after they were fitted within their uncertainty.");
    if (diagnosis.where_threshold > 0)
        caption += fmt::format(" Framed: beyond {:.1f} sigma, which noise alone seldom reaches in any cell.",
                               diagnosis.where_threshold);
    return heading("Where") +
           picture(svg, "where", "Gap by observable and plate displacement, before and after recalibration",
                   caption) +
           titled("What stands out", table_of_where(diagnosis));
}

std::string which_section(const Diagnosis& diagnosis, const std::string& svg) {
    return heading("Which") +
           picture(
               svg, "which", "Candidate effects by score with their amplitudes",
               "Left: how much better the data are explained with each effect, parameters fitted again in "
               "both "
               "cases; diamonds: simulated in full at the fitted amplitude; candidates that share a letter "
               "cannot be told apart by these data. Middle: amplitudes with 90 % intervals, over the "
               "smallest "
               "that these data can detect (dashed line); without a dot: never shows. Right: amplitude with "
               "one "
               "standard error, probability among the candidates.") +
           titled(diagnosis.verdict == Verdict::unknown_effect ? "What comes nearest"
                                                               : "Effects consistent with the gap",
                  table_of_causes(diagnosis)) +
           titled("What these data can show", table_of_detection_limits(diagnosis));
}

std::string how_far_section(const Diagnosis& diagnosis, const std::string& svg) {
    if (!diagnosis.shrink) return heading("How far") + paragraph(verdict_lines(diagnosis)[3].says);
    return heading("How far") +
           picture(svg, "how_far", "Top force and gap before and after",
                   "Left: force on the plate; shaded: where the effect was fitted. Right: the gap that is "
                   "left on data "
                   "held out (" +
                       diagnosis.shrink->held_out +
                       "), with its 90 % interval; placebo: the best of many made-up effects.") +
           titled("Before and after", table_of_shrink(diagnosis));
}

std::string section(const std::string& title, const std::string& content) {
    return content.empty() ? "" : heading(title) + content;
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Draws the figure, keeps its PNG and returns its SVG.
std::string drawn(const std::optional<Figure>& figure, const std::filesystem::path& folder,
                  std::vector<std::filesystem::path>& files) {
    if (!figure) return "";
    std::string svg;
    for (const auto& file : draw_figure(*figure, folder))
        if (file.extension() == ".svg")
            svg = text_of(file);
        else
            files.push_back(file);
    return svg;
}

}  // namespace

std::string diagnosis_page(const Diagnosis& diagnosis, const DiagnosisPictures& pictures) {
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           html_text("Diagnosis: " + headline(diagnosis.verdict)) + "</title>\n<style>" +
           diagnosis_page_style + "</style>\n</head>\n<body>\n<main>\n" + top_of(diagnosis) +
           gap_section(diagnosis) + where_section(diagnosis, pictures.where) +
           which_section(diagnosis, pictures.which) + how_far_section(diagnosis, pictures.how_far) +
           section("Parameters known only roughly", html_table(table_of_nuisances(diagnosis))) +
           section("What was not measured", html_list(diagnosis.not_measured)) +
           section("What cannot be tested", html_list(diagnosis.not_testable)) +
           section("What the effects are", html_table(table_of_effects(diagnosis))) +
           section("What the observables are", html_table(table_of_observables(diagnosis))) +
           section("Where this comes from", html_table(table_of_provenance(diagnosis))) +
           "</main>\n</body>\n</html>\n";
}

std::vector<std::filesystem::path> write_diagnosis_page(const Diagnosis& diagnosis,
                                                        const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files{folder / "diagnosis.html"};
    DiagnosisPictures pictures;
    pictures.where = drawn(where_figure(diagnosis), folder, files);
    pictures.which = drawn(which_figure(diagnosis), folder, files);
    pictures.how_far = drawn(how_far_figure(diagnosis), folder, files);
    replace_file(files.front(), diagnosis_page(diagnosis, pictures));
    return files;
}

}  // namespace mcdem
