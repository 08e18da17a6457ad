#include "metrics/compare.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "metrics/coordination.h"
#include "metrics/force_distribution.h"
#include "metrics/top_force.h"

namespace mcdem::inline metrics {
namespace {

constexpr double mm = 1e-3;

void note_failures(const Setting& setting, Comparison& comparison) {
    int failed = 0;
    const Failure* first = nullptr;
    for (const auto* recording : setting.replicas)
        if (recording->failure && ++failed == 1) first = &*recording->failure;
    if (!first) return;
    comparison.notes.push_back(
        fmt::format("{} of {} replicas stopped early (first: {}); their scans until "
                    "then count, except in Rtop where they did not get there",
                    failed, setting.replicas.size(), first->text()));
}

void note_levels(const Levels& simulated, const Levels& reference, const std::vector<LevelMatch>& matches,
                 Comparison& comparison) {
    int interpolated = 0, missing = 0;
    for (const auto& match : matches) {
        missing += !match.found();
        interpolated += match.below != match.above;
    }
    if (interpolated)
        comparison.notes.push_back(
            fmt::format("{} of {} levels of the reference lie between levels of the "
                        "simulation: interpolated",
                        interpolated, reference.size()));
    if (missing && !simulated.empty())
        comparison.notes.push_back(
            fmt::format("{} of {} levels of the reference are outside the simulated ones: "
                        "left out",
                        missing, reference.size()));
}

void note_stroke(const TopForceRatio& ratio, Comparison& comparison) {
    if (std::isnan(ratio.displacement))
        comparison.notes.push_back("Rtop: no replica came to the end of its protocol");
    else if (ratio.displacement < ratio.reference_end - level_tolerance)
        comparison.notes.push_back(
            fmt::format("Rtop is taken at {:.2f} mm, where the simulation ends; the "
                        "reference goes to {:.2f} mm",
                        ratio.displacement / mm, ratio.reference_end / mm));
}

void note_contacts(Comparison& comparison) {
    if (comparison.levels_errZ == 0)
        comparison.notes.push_back("errZ: Z is not known on both sides at any level");
    else if (!comparison.tau.available())
        comparison.notes.push_back("errZ is without threshold: the simulation has no contacts recorded");
    if (comparison.levels_bhat == 0)
        comparison.notes.push_back("bhat: contacts are not recorded on both sides at any level");
    else if (comparison.levels_bhat < comparison.levels_errf)
        comparison.notes.push_back(
            fmt::format("bhat rests on the {} levels with contacts on both sides", comparison.levels_bhat));
}

Levels levels_or_error(const Replicas& replicas, const std::string& whose) {
    auto levels = group_levels(replicas);
    if (levels.empty())
        throw InputError(
            fmt::format("{}: must have scans after its discarded cycles, got none: record more "
                        "cycles or discard fewer",
                        whose));
    return levels;
}

}  // namespace

Comparison compare(const Setting& simulated, const Replicas& reference, std::optional<double> touch_force) {
    const auto measured = levels_or_error(reference, "reference");
    const auto levels = group_levels(simulated.replicas);
    const auto matches = match_levels(levels, measured);
    const Jackknife jackknife(seeds_of(simulated.replicas), seeds_of(reference));

    Comparison comparison;
    comparison.setting = simulated.label;
    comparison.replicas = static_cast<int>(simulated.replicas.size());
    comparison.reference_levels = static_cast<int>(measured.size());
    note_failures(simulated, comparison);
    if (levels.empty()) {
        comparison.notes.push_back("no scans after the discarded cycles");
        return comparison;
    }
    note_levels(levels, measured, matches, comparison);

    const auto ratio = top_force_ratio(levels, simulated.replicas, measured, reference);
    comparison.Rtop = ratio.Rtop;
    note_stroke(ratio, comparison);

    const auto errf = top_force_error(levels, measured, matches, jackknife.omissions(), touch_force);
    comparison.errf = jackknife.estimate(errf.by_omission);
    comparison.levels_errf = errf.levels_used;

    const auto z = coordination_error(levels, simulated.replicas, reference_coordination(measured, reference),
                                      matches, jackknife);
    comparison.errZ = z.errZ;
    comparison.tau = z.tau;
    comparison.levels_errZ = z.levels_used;

    const auto distance = distribution_distance(levels, measured, matches, jackknife);
    comparison.bhat = distance.bhat;
    comparison.levels_bhat = distance.levels_used;
    note_contacts(comparison);
    return comparison;
}

}  // namespace mcdem::metrics
