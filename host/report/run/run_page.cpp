#include "report/run/run_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/sha256.h"
#include "metrics/programmes.h"
#include "report/run/run_charts.h"
#include "report/run/run_words.h"
#include "report/run/scan_tables.h"
#include "report/run/tables.h"

namespace mcdem::inline report {
namespace {

std::string listed_names(const std::vector<RunOrigin>& origins) {
    std::string names;
    for (const auto& origin : origins) {
        const auto& name = origin.run->name.empty() ? origin.path : origin.run->name;
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

/// " Grains of gel, rubber." if a run has species.
std::string species_of(const RunsOnPage& runs) {
    std::vector<std::string> names;
    for (const RunOrigin& origin : runs.origins)
        for (const Recording& recording : origin.run->recordings)
            for (const std::string& name : recording.species_names)
                if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names.empty() ? "" : fmt::format(" Grains of {}.", fmt::join(names, ", "));
}

/// Sentences at the head of the page.
std::string head_of(const RunsOnPage& runs) {
    std::string words = what_was_simulated(runs.settings) + species_of(runs);
    if (runs.reference) words += " Held against " + runs.reference->label + ".";
    const auto result = main_result(runs.settings, runs.figures.compare.levels);
    return result.empty() ? words : words + " " + result;
}

void add_tables(Page& page, const RunsOnPage& runs, const std::vector<Comparison>& comparisons) {
    page.section("Metrics");
    if (!comparisons.empty())
        page.table("Against " + runs.reference->label, table_of_comparisons(comparisons));
    for (const TextTable& table : tables_of_scans(with_programme(runs.settings, true)))
        page.table("Scans", table);
    const auto strokes = with_programme(runs.settings, false);
    if (strokes.empty()) return;
    page.table("Top force", table_of_models(model_table(strokes, runs.figures.compare.levels)));
    page.table("Scaling law", table_of_scaling(strokes, runs.figures.compare.levels));
}

void add_charts(Page& page, const RunsOnPage& runs, const FigureOptions& options) {
    const auto cell = [](const Setting& setting) { return are_cells(setting.replicas); };
    page.section(std::ranges::all_of(runs.settings, cell) ? "Stresses and contacts" : "Forces and contacts");
    const auto made = run_charts(runs.settings, runs.reference, options);
    for (const auto& chart : made.charts) page.chart(chart);
    for (const auto& note : made.notes) page.paragraph(note);
}

void add_packing(Page& page, const RunsOnPage& runs) {
    page.section("In space");
    const auto view = packing_view(runs.packings, runs.limits);
    if (!view) {
        page.paragraph("No positions recorded: run with output.positions = true to see the packing here.");
        return;
    }
    std::string caption =
        "Colours: force. A line is a contact, from centre to centre; the stronger, the thicker. Drag to "
        "turn, "
        "scroll to come near, point to read.";
    for (const auto& note : runs.left_out) caption += " " + note;
    page.packing(*view, caption);
}

/// Seeds of the packings, shortened if there are many.
std::string seeds_of_run(const Run& run) {
    constexpr std::size_t most = 12;
    std::vector<std::string> seeds;
    for (const auto& recording : run.recordings)
        if (const auto seed = seed_of(recording);
            !seed.empty() && std::find(seeds.begin(), seeds.end(), seed) == seeds.end())
            seeds.push_back(seed);
    std::string text;
    for (std::size_t s = 0; s < std::min(most, seeds.size()); ++s) text += (s ? ", " : "") + seeds[s];
    if (seeds.size() > most) text += fmt::format(" and {} more", seeds.size() - most);
    return text.empty() ? "not known" : text;
}

void add_origin(Page& page, const RunOrigin& origin) {
    const Run& run = *origin.run;
    page.subheading(run.name.empty() ? origin.path : run.name);
    std::vector<std::pair<std::string, std::string>> lines{
        {"results", origin.path},
        {"program", run.program},
        {"device", run.device},
        {"precision", run.precision},
        {"replicas", std::to_string(run.recordings.size())},
        {"packing seeds", seeds_of_run(run)},
        {"SHA-256 of the scene", Sha256().add(run.scene).hex()}};
    for (const auto& [file, digest] : origin.digests) lines.emplace_back("SHA-256 of " + file, digest);
    page.definitions(lines);
    std::vector<std::string> failures;
    for (const auto& recording : run.recordings)
        if (recording.failure)
            failures.push_back(fmt::format("{} stopped at step {}: {}", recording.label,
                                           recording.failure->step, recording.failure->cause));
    page.list(failures);
    page.folded("The scene, as it was run", run.scene);
}

}  // namespace

void add_runs(Page& page, const RunsOnPage& runs) {
    page.lead("Simulation", listed_names(runs.origins), head_of(runs));
    auto options = runs.figures;
    if (runs.reference && options.comparisons.empty())
        for (const auto& setting : runs.settings)
            options.comparisons.push_back(compare(setting, runs.reference->replicas, options.compare));
    add_charts(page, runs, options);
    add_packing(page, runs);
    add_tables(page, runs, options.comparisons);
    page.section("Where this comes from");
    for (const auto& origin : runs.origins) add_origin(page, origin);
}

}  // namespace mcdem::report
