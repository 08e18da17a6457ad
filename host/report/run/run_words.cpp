#include "report/run/run_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/container.h"
#include "core/parameters.h"
#include "metrics/model_table.h"
#include "metrics/programmes.h"
#include "report/page/labels.h"
#include "report/run/tables.h"

namespace mcdem::inline report {
namespace {

constexpr std::size_t max_listed =
    4;  ///< maximum number of settings; if there are more, the smallest and the largest ones

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

/// Result of a setting.
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

std::string of_strokes(const std::vector<Setting>& settings, const LevelOptions& options) {
    const auto table = model_table(settings, options);
    std::vector<Reached> reached;
    for (const ModelRow& row : table.rows)
        reached.push_back({row.setting, row.top_force.value,
                           with_error(row.top_force, 2) + " N" +
                               (row.reached ? fmt::format(" at {:.2f} mm", *row.reached * 1e3) : "")});
    return listed(std::isfinite(table.displacement)
                      ? fmt::format("Force on the plate at {:.2f} mm", table.displacement * 1e3)
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
                return fmt::format("{:.3g} {} at φ = {:.3f}", scan.p.value / unit.size, unit.name,
                                   scan.packing_fraction.value);
            }));
        else
            plates.push_back(strongest(setting, &MeanScan::top_force, [](const MeanScan& scan) {
                return fmt::format("{:.3g} N at {:.2f} mm", scan.top_force.value,
                                   scan.displacement.value * 1e3);
            }));
    return listed("Largest force on the plate", plates) + listed("Largest mean stress", cells);
}

}  // namespace

std::string what_was_simulated(const std::vector<Setting>& settings) {
    std::set<std::size_t> grains, packings;
    std::vector<std::string> containers, protocols;
    const auto add_new = [](std::vector<std::string>& words, const std::string& word) {
        if (std::ranges::find(words, word) == words.end()) words.push_back(word);
    };
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

std::string main_result(const std::vector<Setting>& settings, const LevelOptions& options) {
    const auto strokes = with_programme(settings, false);
    std::size_t replicas = 0, failed = 0;
    for (const Setting& setting : settings) {
        replicas += setting.replicas.size();
        failed += static_cast<std::size_t>(std::ranges::count_if(
            setting.replicas, [](const Recording* recording) { return recording->failure.has_value(); }));
    }
    std::string words =
        (strokes.empty() ? "" : of_strokes(strokes, options)) + of_programmes(with_programme(settings, true));
    if (failed) words += fmt::format(" {} of {} replicas stopped early.", failed, replicas);
    return words.empty() ? words : words.substr(1);
}

}  // namespace mcdem::report
