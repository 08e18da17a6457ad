#include "report/run/run_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <set>
#include <span>

#include "core/container.h"
#include "core/parameters.h"
#include "core/sha256.h"
#include "metrics/model_table.h"
#include "metrics/programmes.h"
#include "report/page/labels.h"
#include "report/run/energy_table.h"
#include "report/run/figure_values.h"
#include "report/run/tables.h"

namespace mcdem::inline report {
namespace {

constexpr std::size_t max_listed =
    4;  ///< maximum number of settings; if there are more, the smallest and the largest ones

void add_new(std::vector<std::string>& words, const std::string& word) {
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
}

std::string counted(std::size_t count, const std::string& what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// "60", or "60 to 240".
std::string range_of(const std::set<std::size_t>& numbers) {
    return numbers.size() == 1 ? std::to_string(*numbers.begin())
                               : fmt::format("{} to {}", *numbers.begin(), *numbers.rbegin());
}

std::string container_words(const Box& box) {
    switch (box.shape) {
        case ContainerShape::box:
            return "in a box";
        case ContainerShape::cylinder:
            return "in a cylinder";
        case ContainerShape::periodic:
            return "between floor and plate without side walls";
        case ContainerShape::cell:
            return "in a cell that repeats in all directions";
    }
    return "";
}

std::size_t stage_count(const Recording& recording) {
    return static_cast<std::size_t>(std::ranges::count_if(recording.parameters, [](const auto& parameter) {
        return parameter.first.starts_with("programme.") && parameter.first.ends_with(".stage");
    }));
}

std::string protocol_words(const Recording& recording) {
    if (const auto stages = stage_count(recording))
        return (is_cell(recording.box) ? "deformed in " : "loaded by a plate in ") + counted(stages, "stage");
    const auto cycles = value_of(recording.parameters, "protocol.cycles");
    return "compressed by a plate" + (cycles.empty() || cycles == "1" ? "" : ", " + cycles + " cycles");
}

struct Reached {
    std::string setting;
    double value;
    std::string words;
};

/// "Force: A 1 N, B 2 N."
std::string listed(const std::string& quantity, std::vector<Reached> reached) {
    std::erase_if(reached, [](const Reached& one) { return !std::isfinite(one.value); });
    if (reached.empty()) return "";
    std::vector<std::string> words;
    if (reached.size() > max_listed) {
        const auto [least, most] = std::ranges::minmax_element(reached, {}, &Reached::value);
        return fmt::format(" {}: from {} ({}) to {} ({}).", quantity, least->words, words_for(least->setting),
                           most->words, words_for(most->setting));
    }
    for (const Reached& one : reached) words.push_back(words_for(one.setting) + " " + one.words);
    return fmt::format(" {}: {}.", quantity, fmt::join(words, ", "));
}

std::string of_strokes(const std::vector<Setting>& settings) {
    const auto table = model_table(settings);
    std::vector<Reached> reached;
    for (const ModelRow& row : table.rows)
        reached.push_back({row.setting, row.top_force.value,
                           with_error(row.top_force, 2) + " N" +
                               (row.reached ? fmt::format(" at {:.2f} mm", *row.reached * 1e3) : "")});
    const bool all_reach =
        std::ranges::none_of(table.rows, [](const ModelRow& row) { return bool(row.reached); });
    return listed(std::isfinite(table.displacement)
                      ? fmt::format("Force on the plate at {:.2f} mm{}", table.displacement * 1e3,
                                    all_reach ? "" : ", or as far as a replica came")
                      : "Force on the plate",
                  reached);
}

/// The scan with the largest mean of a quantity.
Reached strongest(const Setting& setting, Estimate MeanScan::*quantity,
                  const std::function<std::string(const MeanScan&)>& words) {
    const MeanScan* most = nullptr;
    const auto scans = mean_scans(setting.replicas);
    for (const MeanScan& scan : scans)
        if ((scan.*quantity).available() && (!most || (scan.*quantity).value > (most->*quantity).value))
            most = &scan;
    if (!most) return {setting.label, not_available, ""};
    return {setting.label, (most->*quantity).value, words(*most)};
}

std::string of_programmes(const std::vector<Setting>& settings) {
    std::vector<Reached> plates, cells;
    for (const Setting& setting : settings)
        if (are_cells(setting.replicas))
            cells.push_back(strongest(setting, &MeanScan::p, [](const MeanScan& scan) {
                const StressUnit unit = stress_unit(scan.p.value);
                return fmt::format("{} {} at φ = {:.3f}", three_digits(scan.p.value / unit.size), unit.name,
                                   scan.packing_fraction.value);
            }));
        else
            plates.push_back(strongest(setting, &MeanScan::top_force, [](const MeanScan& scan) {
                return fmt::format("{} N at {:.2f} mm", three_digits(scan.top_force.value),
                                   scan.displacement.value * 1e3);
            }));
    return listed("Largest force on the plate", plates) + listed("Largest mean stress", cells);
}

bool several_replicas(const RunFigure& figure) {
    return std::ranges::any_of(
        figure.series, [](const FigureSeries& shown) { return shown.series->setting.replicas.size() > 1; });
}

std::string bands_words(const RunFigure& figure) {
    return several_replicas(figure) ? " Bands: one standard error over replicas." : "";
}

/// Meaning of lines, points and bands.
std::string phases_words(const FigureData& data, const RunFigure& figure) {
    return std::string("Solid lines: loading, dashed: unloading.") +
           (data.reference ? " Points: the reference, filled: loading, open: unloading." : "") +
           (several_replicas(figure) ? " Bands and bars: one standard error over replicas." : "");
}

std::string axes_words(const RunFigure& figure) {
    std::string words;
    const auto has = [&](const char* quantity) {
        return figure.x_label.starts_with(quantity) || figure.y_label.starts_with(quantity);
    };
    if (has("mean stress")) words += " p: a third of the stress tensor's trace, compression positive.";
    if (has("deviatoric stress")) words += " q = √(3/2 s:s) of its deviator s.";
    if (has("volume strain")) words += " Volume strain: decrease of the volume over the initial volume.";
    if (has("deviatoric strain"))
        words += " Deviatoric strain: √(2/3 e:e), e the deviator of the logarithmic strain.";
    return words;
}

/// Title, caption and axes that can be made logarithmic.
Chart chart_of(const RunFigure& figure, const FigureData& data, const FigureOptions& options) {
    const std::string& name = figure.name;
    if (name == "top_force") return {name, "Force on the plate", phases_words(data, figure), {}, "xy"};
    if (name == "force_distribution")
        return {name,
                fmt::format("Contact forces at {:.1f} mm, {}ing", *figure.displacement,
                            mcdem::name(figure.series.front().curves.front().phase)),
                "Probability density of the contact forces between grains, at one plate displacement." +
                    bands_words(figure),
                {}};
    if (name == "coordination")
        return {
            name,
            is_thresholded(data, options) ? "Contacts per grain, weak forces left out" : "Contacts per grain",
            phases_words(data, figure),
            {}};
    if (name == "scaling")
        return {name,
                "Scaling law F ∝ ⟨Z⟩⟨φ⟩⟨b⟩⟨f⟩",
                "Filled points: loading, open: unloading; lines through the origin are fitted to both.",
                {},
                "xy"};
    return {name,
            figure.title,
            "Scans in order of time." + axes_words(figure) + bands_words(figure),
            {},
            name == "pressure_strain" ? "y" : ""};
}

std::string name_of(const RunOrigin& origin) {
    return origin.run->name.empty() ? origin.path : origin.run->name;
}

std::string listed_names(const std::vector<RunOrigin>& origins) {
    std::vector<std::string> names;
    for (const auto& origin : origins) names.push_back(name_of(origin));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// " Grains of gel, rubber." if a run has species.
std::string species_of(const RunsOnPage& runs) {
    std::vector<std::string> names;
    for (const RunOrigin& origin : runs.origins)
        for (const Recording& recording : origin.run->recordings)
            for (const std::string& name : recording.species_names) add_new(names, name);
    return names.empty() ? "" : fmt::format(" Grains of {}.", fmt::join(names, ", "));
}

std::string head_of(const RunsOnPage& runs) {
    std::string words = what_was_simulated(runs.settings) + species_of(runs);
    if (runs.reference) words += " Compared with " + runs.reference->label + ".";
    const auto result = main_result(runs.settings);
    return result.empty() ? words : words + " " + result;
}

void add_tables(Page& page, const RunsOnPage& runs, const std::vector<Comparison>& comparisons) {
    page.section("Metrics");
    if (!comparisons.empty())
        page.table("Against " + runs.reference->label, table_of_comparisons(comparisons));
    for (const TextTable& table : tables_of_scans(with_programme(runs.settings, true)))
        page.table("Scans", table);
    if (const TextTable energies = table_of_energies(runs.settings); !energies.rows.empty())
        page.table("Energy budget", energies);
    const auto strokes = with_programme(runs.settings, false);
    if (strokes.empty()) return;
    page.table("Top force", table_of_models(model_table(strokes)));
    page.table("Scaling law", table_of_scaling(strokes));
}

void add_charts(Page& page, const RunsOnPage& runs, const FigureOptions& options) {
    const auto cell = [](const Setting& setting) { return are_cells(setting.replicas); };
    page.section(std::ranges::all_of(runs.settings, cell) ? "Stresses and contacts" : "Forces and contacts");
    const auto made = run_charts(runs.settings, runs.reference, options);
    for (const auto& chart : made.charts) page.chart(chart);
    for (const auto& note : made.notes) page.paragraph(note);
}

void add_packing(Page& page, const RunsOnPage& runs) {
    page.section("The packing in 3D");
    const auto view = packing_view(runs.packings, runs.limits);
    if (!view) {
        page.paragraph("No positions recorded: run with output.positions = true to see the packing here.");
        return;
    }
    std::string caption =
        "Colour: force. Each line is a contact between two centres; its thickness grows with the force. Drag "
        "to rotate, scroll to zoom, hover for values.";
    for (const auto& note : runs.left_out) caption += " " + note;
    page.packing(*view, caption);
}

/// Seeds of the packings, shortened if there are many.
std::string seeds_of_run(const Run& run) {
    constexpr std::size_t most = 12;
    std::vector<std::string> seeds;
    for (const auto& recording : run.recordings)
        if (const auto seed = seed_of(recording); !seed.empty()) add_new(seeds, seed);
    if (seeds.empty()) return "not known";
    const auto text =
        fmt::format("{}", fmt::join(std::span(seeds).first(std::min(most, seeds.size())), ", "));
    return seeds.size() > most ? fmt::format("{} and {} more", text, seeds.size() - most) : text;
}

void add_origin(Page& page, const RunOrigin& origin) {
    const Run& run = *origin.run;
    page.subheading(name_of(origin));
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
            failures.push_back((recording.label.empty() ? "replica 1" : recording.label) + " stopped at " +
                               recording.failure->text());
    page.list(failures);
    page.folded("The scene, as it was run", run.scene);
}

}  // namespace

std::string what_was_simulated(const std::vector<Setting>& settings) {
    std::set<std::size_t> grains, packings;
    std::vector<std::string> containers, protocols;
    for (const Setting& setting : settings) {
        packings.insert(setting.replicas.size());
        for (const Recording* recording : setting.replicas) {
            grains.insert(recording->diameter.size());
            add_new(containers, container_words(recording->box));
            add_new(protocols, protocol_words(*recording));
        }
    }
    if (grains.empty()) return "";
    return fmt::format("{} grain{} {}, {}; {}, {} packing{} each.", range_of(grains),
                       *grains.rbegin() == 1 ? "" : "s", fmt::join(containers, " or "),
                       fmt::join(protocols, " or "), counted(settings.size(), "setting"), range_of(packings),
                       *packings.rbegin() == 1 ? "" : "s");
}

std::string main_result(const std::vector<Setting>& settings) {
    const auto strokes = with_programme(settings, false);
    std::size_t replicas = 0, failed = 0;
    for (const Setting& setting : settings) {
        replicas += setting.replicas.size();
        failed += static_cast<std::size_t>(std::ranges::count_if(
            setting.replicas, [](const Recording* recording) { return recording->failure.has_value(); }));
    }
    std::string words =
        (strokes.empty() ? "" : of_strokes(strokes)) + of_programmes(with_programme(settings, true));
    if (failed) words += fmt::format(" {} of {} replicas stopped early.", failed, replicas);
    return words.empty() ? words : words.substr(1);
}

RunCharts run_charts(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                     const FigureOptions& options) {
    const auto data = figure_data(settings, reference, options);
    const auto prepared = run_figures(data, options);
    const Json values = figure_values(prepared, data);
    RunCharts made;
    for (const auto& missing : prepared.missing) made.notes.push_back("No chart of " + missing + ".");
    for (const auto& figure : prepared.figures) {
        made.charts.push_back(chart_of(figure, data, options));
        made.charts.back().values = values.at(figure.name);
    }
    return made;
}

void add_runs(Page& page, const RunsOnPage& runs) {
    page.lead("Simulation", listed_names(runs.origins), head_of(runs));
    auto options = runs.figures;
    if (runs.reference && options.comparisons.empty())
        for (const auto& setting : runs.settings)
            options.comparisons.push_back(compare(setting, runs.reference->replicas, options.touch_force));
    add_charts(page, runs, options);
    add_packing(page, runs);
    add_tables(page, runs, options.comparisons);
    page.section("Provenance");
    for (const auto& origin : runs.origins) add_origin(page, origin);
}

}  // namespace mcdem::report
