#include "report/diagnosis/diagnosis_parts.h"

#include <algorithm>
#include <cmath>

#include "report/diagnosis/diagnosis_words.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

constexpr double phase_gap = 0.35;      ///< between loading and unloading [columns]
constexpr double interval_90 = 1.6449;  ///< sigmas on either side

/// Displacements with a smaller difference are one column [m].
constexpr double same_displacement = 1e-5;

int phase_order(const std::string& phase) { return phase == "load" ? 0 : phase == "unload" ? 1 : 2; }

using Column = HeatMap::Column;

bool same(const Column& a, const Column& b) {
    return a.phase == b.phase && std::fabs(a.displacement - b.displacement) < same_displacement;
}

bool earlier(const Column& a, const Column& b) {
    if (a.phase != b.phase)
        return std::pair(phase_order(a.phase), a.phase) < std::pair(phase_order(b.phase), b.phase);
    return a.phase == "unload" ? a.displacement > b.displacement : a.displacement < b.displacement;
}

bool within(const WhereCell& cell, const WhereEntry& entry) {
    return cell.observable == entry.observable && (entry.phase.empty() || entry.phase == cell.phase) &&
           cell.displacement >= entry.displacement[0] - same_displacement &&
           cell.displacement <= entry.displacement[1] + same_displacement;
}

}  // namespace

int HeatMap::row(const WhereCell& cell) const {
    return std::find(observables.begin(), observables.end(), cell.observable) - observables.begin();
}

const HeatMap::Column& HeatMap::column(const WhereCell& cell) const {
    return *std::find_if(columns.begin(), columns.end(), [&](const Column& c) {
        return same(c, {cell.phase, cell.displacement});
    });
}

HeatMap heat_map_of(const std::vector<WhereCell>& cells) {
    HeatMap map;
    for (const auto& cell : cells) {
        if (map.row(cell) == static_cast<int>(map.observables.size()))
            map.observables.push_back(cell.observable);
        map.columns.push_back({cell.phase, cell.displacement});
    }
    std::sort(map.columns.begin(), map.columns.end(), earlier);
    map.columns.erase(std::unique(map.columns.begin(), map.columns.end(), same), map.columns.end());
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
        if (c > 0 && map.columns[c].phase != map.columns[c - 1].phase) map.width += phase_gap;
        map.columns[c].x = map.width + 0.5;
        map.width += 1;
    }
    return map;
}

bool has_cells(const Diagnosis& diagnosis) {
    return std::any_of(diagnosis.cells.begin(), diagnosis.cells.end(),
                       [](const WhereCell& cell) { return std::isfinite(cell.z_score); });
}

bool stands_out(const Diagnosis& diagnosis, const WhereCell& cell, bool refitted) {
    if (diagnosis.where_threshold > 0)
        return std::fabs(refitted ? cell.z_score_refitted : cell.z_score) >= diagnosis.where_threshold;
    return !refitted && std::any_of(diagnosis.where.begin(), diagnosis.where.end(),
                                    [&](const WhereEntry& entry) { return within(cell, entry); });
}

double colour_range(const std::vector<WhereCell>& cells) {
    double largest = 0;
    for (const auto& cell : cells) largest = std::max(largest, std::fabs(cell.z_score));
    return std::clamp(std::ceil(largest), 6.0, 8.0);
}

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

std::vector<std::array<double, 4>> known_forces(const GapReduction& gap_reduction) {
    auto rows = gap_reduction.top_force;
    std::erase_if(rows, [](const auto& row) {
        return !std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
    });
    return rows;
}

std::string words_after(const Diagnosis& diagnosis) {
    if (diagnosis.verdict == Verdict::calibration_suspect) return "simulated, recalibrated";
    if (diagnosis.verdict == Verdict::not_converged) return "simulated, refined";
    const auto added = diagnosis.causes.empty() ? "the effect" : words_of(diagnosis.causes.front().effect);
    return shortened("simulated with " + added, 40);
}

std::vector<GapBar> gap_bars(const GapReduction& gap_reduction) {
    std::vector<GapBar> bars{{"before", diagnosis_colour::before, 1, {}},
                             {gap_reduction.confirmed ? "after, predicted" : "after",
                              diagnosis_colour::after,
                              1 - gap_reduction.fraction,
                              {{1 - gap_reduction.interval[1], 1 - gap_reduction.interval[0]}}}};
    if (gap_reduction.confirmed)
        bars.push_back({"after, simulated", diagnosis_colour::after, 1 - *gap_reduction.confirmed, {}});
    bars.push_back({"placebo", diagnosis_colour::faint, 1 - gap_reduction.placebo, {}});
    return bars;
}

}  // namespace mcdem::report
