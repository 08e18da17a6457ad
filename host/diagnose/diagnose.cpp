#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/errors.h"
#include "diagnose/detection_limits.h"
#include "diagnose/location.h"

namespace mcdem {
namespace {

constexpr std::size_t fewest_cells = 4;

std::string unit_of(const Evidence& evidence, const std::string& name) {
    for (const CandidateRange& c : evidence.candidates)
        if (c.name == name) return c.unit;
    for (const NuisancePrior& n : evidence.nuisances)
        if (n.name == name) return n.unit;
    return "";
}

Cause cause_of(const Evidence& evidence, const Setting& setting, const Identification& id, const GapStatistics& s,
               std::size_t candidate) {
    const EffectFit& fit = s.fits[candidate];
    Cause cause;
    cause.effect = setting.name(candidate);
    cause.amplitude = fit.amplitude;
    cause.amplitude_error = fit.error;
    cause.unit = unit_of(evidence, cause.effect);
    cause.confidence = id.confidence[candidate];
    cause.explained = s.omnibus > 0 ? 2 * fit.score / s.omnibus : 0;
    cause.score = fit.score;
    cause.group = {cause.effect};
    return cause;
}

/// The leader with its group, then the second effect where there is one.
std::vector<Cause> causes_of(const Evidence& evidence, const Setting& setting, const Identification& id,
                             const GapStatistics& s) {
    std::vector<Cause> causes;
    for (std::size_t k = 0; k < id.best.candidates.size(); ++k) {
        Cause cause = cause_of(evidence, setting, id, s, id.best.candidates[k]);
        cause.amplitude = id.best.fits[k].amplitude;
        cause.amplitude_error = id.best.fits[k].error;
        causes.push_back(cause);
    }
    for (const std::size_t member : id.group) {
        if (member == id.best.candidates[0]) continue;
        causes[0].group.push_back(setting.name(member));
        if (id.best.candidates.size() == 1) causes.push_back(cause_of(evidence, setting, id, s, member));
    }
    for (std::size_t k = id.best.candidates.size(); k < causes.size(); ++k) causes[k].group = causes[0].group;
    return causes;
}

std::vector<NuisanceFit> nuisance_fits(const Evidence& evidence, const Comparison& comparison, const Eigen::VectorXd& gap) {
    const Eigen::VectorXd values = comparison.fit_nuisances(gap), errors = comparison.nuisance_errors();
    std::vector<NuisanceFit> fits;
    for (std::size_t k = 0; k < evidence.nuisances.size(); ++k) {
        const NuisancePrior& prior = evidence.nuisances[k];
        const auto i = static_cast<Eigen::Index>(k);
        fits.push_back({prior.name, values[i], errors[i], prior.sigma, prior.unit, std::abs(values[i]) > 2.5 * prior.sigma});
    }
    return fits;
}

/// What is missing in the data, and what it could have told.
std::vector<std::string> not_measured(const Evidence& evidence) {
    std::set<Needs> seen, missing;
    const auto cells = cells_of(evidence.library.grid);
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const Needs needs = observables()[static_cast<std::size_t>(cells[k].observable)].needs;
        (std::isfinite(evidence.observed[static_cast<Eigen::Index>(k)]) ? seen : missing).insert(needs);
    }
    std::vector<std::string> texts;
    if (!seen.count(Needs::contacts) && missing.count(Needs::contacts))
        texts.push_back("contacts.csv: forces of contacts would tell the force distribution, the floor's and the walls' share, "
                        "the plate's couple and biases of the force measurement");
    if (!seen.count(Needs::positions) && missing.count(Needs::positions))
        texts.push_back("grains.csv beyond frame 0 (with contacts.csv): positions would tell the overlaps that forces should "
                        "imply, hence cross-contact effects, stiffening, adhesion, friction and errors of sizes");
    return texts;
}

}  // namespace

Draft draft_diagnosis(const Evidence& evidence, const Limits& limits) {
    Draft draft;
    draft.setting = setting_of(evidence);
    const Setting& setting = draft.setting;
    if (setting.cells.size() < fewest_cells)
        throw InputError(fmt::format("the experiment and the simulations have {} observations in common, and {} are needed: "
                                     "the plate must press the packing within its stroke in both",
                                     setting.cells.size(), fewest_cells));
    draft.mean_of = static_cast<int>(evidence.baseline.rows());
    const Comparison comparison(setting.noise, draft.mean_of, setting.cells, setting.free);
    const NullDistribution null(setting, draft.mean_of, evidence.seed);
    Diagnosis& d = draft.diagnosis;
    d.detection_limits = detection_limits(comparison, setting, null, evidence, limits);
    const GapStatistics s = gap_statistics(comparison, setting, setting.gap);
    d.p_omnibus = null.p_value(&GapStatistics::omnibus, s.omnibus);
    d.p_directed = null.p_value(&GapStatistics::directed, s.directed);
    d.p_value = std::min(1.0, 2 * std::min(d.p_omnibus, d.p_directed));
    d.detected = d.p_value < limits.false_alarm;
    const Location location = locate(comparison, setting, null, setting.gap, evidence.library.grid, limits);
    d.cells = location.cells;
    if (d.detected) d.where = location.entries;
    draft.identification = identify(comparison, setting, null, s, setting.gap, limits);
    const Identification& id = draft.identification;
    d.verdict = verdict_of(id, setting, d.detected);
    for (const std::size_t candidate : id.order) d.ranking.push_back(cause_of(evidence, setting, id, s, candidate));
    if (d.detected) d.causes = causes_of(evidence, setting, id, s);
    d.nuisances = nuisance_fits(evidence, comparison, setting.gap);
    d.not_measured = not_measured(evidence);
    draft.worth_confirming = d.detected && s.directed > 0;
    if (draft.worth_confirming) {
        const Split split = split_cells(setting.cells, evidence.library.grid);
        d.shrink = measure_shrink(setting, split, id.best, draft.mean_of, evidence.seed);
        draft.whole = fit_part(setting, setting.cells, setting.gap, id.best.candidates, draft.mean_of);
        draft.part = split.fitted.empty() ? draft.whole
                                          : fit_part(setting, split.fitted, setting.gap, id.best.candidates, draft.mean_of);
    }
    return draft;
}

Diagnosis confirm(const Evidence& evidence, Draft draft, const Confirmation& confirmation, const Limits&) {
    const Setting& setting = draft.setting;
    const int runs = static_cast<int>(confirmation.whole.rows());
    const Eigen::VectorXd left = evidence.observed - confirmation.whole.colwise().mean().transpose();
    const Eigen::VectorXd left_part = evidence.observed - confirmation.part.colwise().mean().transpose();
    Diagnosis& d = draft.diagnosis;
    if (!pick(left, setting.cells).allFinite() || !pick(left_part, setting.cells).allFinite()) return d;
    const Comparison before(setting.noise, draft.mean_of, setting.cells, setting.free);
    const Comparison after(setting.noise, runs, setting.cells, setting.free);
    if (!d.causes.empty())
        d.causes[0].confirmed_score =
            0.5 * (before.whiten(setting.gap).squaredNorm() - after.whiten(left).squaredNorm());
    const Split split = split_cells(setting.cells, evidence.library.grid);
    if (d.shrink && d.shrink->before > 0)
        d.shrink->confirmed =
            std::clamp(1 - gap_size(setting, split.held_out, left_part, runs) / d.shrink->before, -1.0, 1.0);
    return d;
}

}  // namespace mcdem
