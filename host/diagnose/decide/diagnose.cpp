#include "diagnose/decide/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/errors.h"
#include "diagnose/decide/location.h"
#include "diagnose/decide/packings.h"
#include "diagnose/infer/detection_limits.h"
#include "diagnose/infer/effects.h"
#include "diagnose/observe/needed_to_diagnose.h"

namespace mcdem::inline diagnose {
namespace {

/// A parameter this far from its stated value, in sigmas of its prior, is outside its uncertainty.
constexpr double far_out = 2.5;
constexpr double worth_another_run =
    0.01;  ///< another run is worthwhile if the p of the remainder is smaller

GapData checked_data(const Evidence& evidence) {
    GapData data = gap_data(evidence);
    if (data.cells.size() < min_cells)
        throw InputError(fmt::format(
            "the experiment and the simulations have {} observations in common, and {} are needed: "
            "the plate must press the packing within its stroke in both",
            data.cells.size(), min_cells));
    return data;
}

/// The range of a candidate; null for a parameter.
const CandidateRange* range_of(const Evidence& evidence, const std::string& name) {
    const auto found = std::ranges::find(evidence.candidates, name, &CandidateRange::name);
    return found == evidence.candidates.end() ? nullptr : &*found;
}

std::string unit_of(const Evidence& evidence, const std::string& name) {
    if (const CandidateRange* range = range_of(evidence, name)) return range->unit;
    for (const NuisancePrior& n : evidence.nuisances)
        if (n.name == name) return n.unit;
    return "";
}

bool at_limit(const Evidence& evidence, const Cause& cause) {
    const CandidateRange* range = range_of(evidence, cause.effect);
    return range && ((range->high > 0 && cause.amplitude + cause.amplitude_error >= range->high) ||
                     (range->low < 0 && cause.amplitude - cause.amplitude_error <= range->low));
}

std::vector<NuisanceFit> nuisance_fits(const Evidence& evidence, const GapSpace& space,
                                       const Eigen::VectorXd& gap) {
    const Eigen::VectorXd values = space.fit_nuisances(gap), errors = space.nuisance_errors();
    std::vector<NuisanceFit> fits;
    for (std::size_t k = 0; k < evidence.nuisances.size(); ++k) {
        const NuisancePrior& prior = evidence.nuisances[k];
        fits.push_back({prior.name, values[k], errors[k], prior.sigma, prior.unit,
                        std::abs(values[k]) > far_out * prior.sigma});
    }
    return fits;
}

/// The candidates as causes of the output.
class Causes {
public:
    Causes(const Evidence& evidence, const Findings& findings, const Decision& decision,
           const GapStatistics& statistics)
        : evidence_(evidence), findings_(findings), decision_(decision), statistics_(statistics) {}

    Cause of(std::size_t candidate) const {
        Cause cause;
        cause.effect = findings_.names[candidate];
        cause.amplitude = statistics_.fits[candidate].amplitude;
        cause.amplitude_error = statistics_.fits[candidate].error;
        cause.unit = unit_of(evidence_, cause.effect);
        cause.confidence = decision_.confidence[candidate];
        cause.score = findings_.gain[candidate];
        cause.explained = statistics_.omnibus > 0 ? 2 * cause.score / statistics_.omnibus : 0;
        cause.group = {cause.effect};
        for (const Proposal& proposal : findings_.proposals)
            if (proposal.candidates == std::vector{candidate}) {
                cause.confirmed_score = proposal.confirmed_gain;
                if (proposal.confirmed_gain) take_amplitude(cause, candidate, proposal);
            }
        if (decision_.verdict != Verdict::no_gap && decision_.proposal >= 0) {
            const Proposal& chosen = chosen_proposal(findings_, decision_);
            take_amplitude(cause, candidate, chosen);  // a named effect has only that of the explanation
            if (!chosen.is_pair() && std::ranges::count(decision_.group, candidate) > 0)
                cause.group = names_of(decision_.group);
        }
        cause.at_limit = at_limit(evidence_, cause);
        return cause;
    }

    std::vector<Cause> ranking() const {
        std::vector<std::size_t> order(findings_.names.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order,
                                 [&](auto a, auto b) { return findings_.gain[a] > findings_.gain[b]; });
        std::vector<Cause> list;
        for (const std::size_t candidate : order) list.push_back(of(candidate));
        return list;
    }

    /// The leading effect and its group, or both effects of a pair.
    std::vector<Cause> leading() const {
        std::vector<Cause> list;
        for (const std::size_t candidate : decision_.group) list.push_back(of(candidate));
        return list;
    }

private:
    static void take_amplitude(Cause& cause, std::size_t candidate, const Proposal& proposal) {
        const auto place = std::ranges::find(proposal.candidates, candidate) - proposal.candidates.begin();
        if (place == std::ssize(proposal.candidates)) return;
        cause.amplitude = proposal.amplitudes[place];
        cause.amplitude_error = proposal.errors[place];
    }

    std::vector<std::string> names_of(const std::vector<std::size_t>& candidates) const {
        std::vector<std::string> names;
        for (const std::size_t c : candidates) names.push_back(findings_.names[c]);
        return names;
    }
    const Evidence& evidence_;
    const Findings& findings_;
    const Decision& decision_;
    const GapStatistics& statistics_;
};

}  // namespace

DiagnosisBuilder::DiagnosisBuilder(const Evidence& evidence, const Limits& limits)
    : evidence_(evidence),
      limits_(limits),
      data_(checked_data(evidence)),
      mean_of_(static_cast<int>(evidence.baseline.rows())),
      space_(data_.noise, mean_of_, data_.cells, data_.free),
      null_(data_, mean_of_, evidence.seed),
      statistics_(gap_statistics(space_, data_, data_.gap)),
      split_(split_cells(data_.cells, evidence.library.grid)) {
    findings_.p_value = p_of_gap(null_, statistics_);
    if (findings_.p_value < limits_.false_alarm) {
        places_ = places_left_out(data_, mean_of_, evidence.seed);
        findings_.p_value = std::max(findings_.p_value, p_without_one_place(places_, data_, mean_of_));
    }
    findings_.effects = data_.effects;
    for (std::size_t c = 0; c < data_.candidates.size(); ++c) {
        findings_.names.push_back(data_.name(c));
        findings_.gain.push_back(statistics_.fits[c].score);
        if (!findings_.is_nuisance(c) && is_numerical(data_.name(c))) findings_.numerics.push_back(c);
    }
    findings_.proposals = propose(space_, data_, null_, statistics_, mean_of_);
    for (const Proposal& p : findings_.proposals)
        whole_.push_back(
            {p.amplitudes, data_.in_range(space_.lacking(data_.lacking(p.candidates))
                                              .fit_nuisances(data_.gap - explained_by(p, data_)))});
    step_.resize(whole_.size());
    runs_.resize(whole_.size());
    held_out_done_.resize(whole_.size());
    measure_reductions();
    decision_ = decide(findings_, limits_);
}

void DiagnosisBuilder::measure_reductions() {
    const HeldOutGap held_out = held_out_gap(data_, split_, mean_of_);
    findings_.held_out = held_out.shows();
    findings_.held_out_noise = held_out.shows() ? held_out.noise / held_out.size : 0;
    excess_ =
        std::max(statistics_.directed, 0.5 * (statistics_.omnibus - null_.mean(&GapStatistics::omnibus)));
    if (!(excess_ > 0)) return;
    findings_.placebo = findings_.held_out ? held_out_placebo(data_, split_, mean_of_, evidence_.seed)
                                           : whole_placebo(space_, data_, excess_, evidence_.seed);
    for (Proposal& p : findings_.proposals)
        p.reduction = by_likelihood(p) ? likelihood_reduction(p.gain)
                                       : held_out_reduction(data_, split_, p.candidates, mean_of_);
}

bool DiagnosisBuilder::by_likelihood(const Proposal& proposal) const {
    return !findings_.held_out ||
           std::ranges::any_of(proposal.candidates, [&](std::size_t c) { return findings_.is_nuisance(c); });
}

double DiagnosisBuilder::likelihood_reduction(double gain) const {
    return std::clamp(gain / excess_, -1.0, 1.0);
}

void DiagnosisBuilder::confirm(std::size_t proposal, const Eigen::MatrixXd& runs) {
    Proposal tried = findings_.proposals[proposal];
    tried.amplitudes = whole_[proposal].amplitudes;
    step_[proposal] = mcdem::confirm(tried, data_, null_, places_, limits_.enough(tried.is_pair()),
                                     evidence_.observed, whole_[proposal].nuisances, runs);
    if (!step_[proposal]) return;
    const Eigen::MatrixXd whole = whole_runs(runs, without(data_.cells, data_.lacking(tried.candidates)));
    const Runs last{whole_[proposal], whole.colwise().mean().transpose(), static_cast<int>(whole.rows())};
    // If a signature is curved, its amplitude and that of the runs enclose the true one.
    for (std::size_t k = 0; k < tried.amplitudes.size(); ++k) {
        const double half =
            0.5 * (*step_[proposal])[whole_[proposal].nuisances.size() + static_cast<Eigen::Index>(k)];
        tried.amplitudes[k] += half;
        tried.errors[k] = std::hypot(tried.errors[k], half);
    }
    const auto& known = findings_.proposals[proposal].confirmed_gain;
    if (!known || *tried.confirmed_gain > *known) {
        if (by_likelihood(tried)) tried.confirmed_reduction = likelihood_reduction(*tried.confirmed_gain);
        findings_.proposals[proposal] = tried;
        runs_[proposal] = last;
    }
    decision_ = decide(findings_, limits_);
}

bool DiagnosisBuilder::may_gain(std::size_t proposal) const {
    const Proposal& p = findings_.proposals[proposal];
    return p.candidates.size() == 1 && findings_.is_nuisance(p.candidates[0]) &&
           decision_.proposal != static_cast<int>(proposal) &&
           std::abs((*step_[proposal])[whole_[proposal].nuisances.size()]) > p.errors[0];
}

bool DiagnosisBuilder::refit(std::size_t proposal) {
    const Proposal& p = findings_.proposals[proposal];
    PartialFit& fit = whole_[proposal];
    if (!step_[proposal]) {  // no run finished: signatures bend, and the amplitude is too large
        for (double& amplitude : fit.amplitudes) amplitude /= 2;
        return !p.confirmed_gain;
    }
    if (p.best_misfit() >= worth_another_run && !may_gain(proposal)) return false;
    const auto before = fit.amplitudes;
    fit = stepped(data_, p.candidates, std::move(fit), *step_[proposal]);
    return fit.amplitudes != before;
}

Split DiagnosisBuilder::split_of(const Proposal& proposal) const {
    if (!proposal.left_out) return split_;
    const auto rest = [&](const CellChoice& cells) {
        return without_place(cells, *proposal.left_out, data_.gap.size());
    };
    return {rest(split_.fitted), rest(split_.held_out)};
}

std::optional<std::size_t> DiagnosisBuilder::wants_held_out() const {
    if (!has_decided()) return std::nullopt;
    auto waiting = contenders(findings_, limits_);
    waiting.push_back(decided());
    const auto next = std::ranges::find_if(waiting, [&](std::size_t k) { return !held_out_done_[k]; });
    return next == waiting.end() ? std::nullopt : std::optional(*next);
}

PartialFit DiagnosisBuilder::part_fit(std::size_t proposal) const {
    const Proposal& p = findings_.proposals[proposal];
    const CellChoice& cells = split_.fitted.empty() ? data_.cells : split_.fitted;
    if (!runs_[proposal]) return fit_part(data_, cells, data_.gap, p.candidates, mean_of_);
    return refit_part(data_, cells, evidence_.observed - runs_[proposal]->mean, p.candidates,
                      runs_[proposal]->fit, runs_[proposal]->count);
}

void DiagnosisBuilder::confirm_held_out(std::size_t proposal, const Eigen::MatrixXd& runs) {
    held_out_done_[proposal] = true;
    Proposal& p = findings_.proposals[proposal];
    if (!by_likelihood(p))
        p.confirmed_reduction = reduction_by_runs(data_, split_of(p), evidence_.observed, runs, mean_of_,
                                                  data_.lacking(p.candidates));
    decision_ = decide(findings_, limits_);
}

double DiagnosisBuilder::refining_factor(std::size_t candidate, double most) const {
    constexpr double unnoticed = 4;  // gain in log likelihood that also occurs by chance
    const Candidate& numerics = data_.candidates[candidate];
    double amplitude = statistics_.fits[candidate].amplitude + statistics_.fits[candidate].error;
    for (const Proposal& p : findings_.proposals)
        for (std::size_t k = 0; k < p.candidates.size(); ++k)
            if (p.candidates[k] == candidate && p.confirmed_gain) amplitude = p.amplitudes[k] + p.errors[k];
    amplitude = std::min(amplitude, numerics.high);
    for (double factor = 2; factor < most; factor *= 2) {
        const Eigen::VectorXd left =
            numerics.signature->at(amplitude) - numerics.signature->at(std::min(1 - 1 / factor, amplitude));
        if (0.5 * space_.lacking(numerics.lacking).whiten(left).squaredNorm() < unnoticed) return factor;
    }
    return most;
}

Eigen::VectorXd DiagnosisBuilder::shifts_of(std::size_t proposal) const {
    const Proposal& p = findings_.proposals[proposal];
    Eigen::VectorXd shifts = runs_[proposal]
                                 ? refit_part(data_, data_.cells, evidence_.observed - runs_[proposal]->mean,
                                              p.candidates, runs_[proposal]->fit, runs_[proposal]->count)
                                       .nuisances
                                 : whole_[proposal].nuisances;
    for (std::size_t k = 0; k < p.candidates.size(); ++k) {
        const auto same =
            std::ranges::find(evidence_.nuisances, findings_.names[p.candidates[k]], &NuisancePrior::name);
        if (findings_.is_nuisance(p.candidates[k]) && same != evidence_.nuisances.end())
            shifts[same - evidence_.nuisances.begin()] += p.amplitudes[k];
    }
    return data_.in_range(shifts);
}

std::vector<NuisanceFit> DiagnosisBuilder::check_first() const {
    std::vector<NuisanceFit> list;
    if (decision_.verdict == Verdict::no_gap) return list;
    const Eigen::VectorXd shifts =
        has_decided() ? shifts_of(decided()) : data_.in_range(space_.fit_nuisances(data_.gap));
    for (NuisanceFit fit : nuisance_fits(evidence_, space_, data_.gap)) {
        fit.value = shifts[std::ranges::find(evidence_.nuisances, fit.name, &NuisancePrior::name) -
                           evidence_.nuisances.begin()];
        fit.at_bound = data_.at_end_of_range(fit.value, fit.prior);
        if (std::abs(fit.sigmas()) > far_out) list.push_back(fit);
    }
    std::ranges::stable_sort(list, std::greater(), [](const auto& fit) { return std::abs(fit.sigmas()); });
    return list;
}

Diagnosis DiagnosisBuilder::diagnosis() const {
    Diagnosis d;
    d.verdict = decision_.verdict;
    d.detected = d.verdict != Verdict::no_gap;
    d.p_value = findings_.p_value;
    d.p_omnibus = null_.p_value(&GapStatistics::omnibus, statistics_.omnibus);
    d.p_directed = null_.p_value(&GapStatistics::directed, statistics_.directed);
    const Location location = locate(space_, data_, null_, data_.gap, evidence_.library.grid, limits_);
    d.cells = location.cells;
    d.where_threshold = location.threshold;
    if (d.detected) d.where = location.entries;
    const Causes causes(evidence_, findings_, decision_, statistics_);
    d.ranking = causes.ranking();
    d.nuisances = nuisance_fits(evidence_, space_, data_.gap);
    d.check_first = check_first();
    d.detection_limits = detection_limits(space_, data_, null_, evidence_, limits_);
    d.missing_bins = data_.missing;
    d.not_measured = not_measured(evidence_.observed, evidence_.library.grid);
    d.next = next_measurements(evidence_, data_, findings_, decision_, limits_);
    d.packings = packing_agreements(evidence_, data_, null_,
                                    has_decided() ? &findings_.proposals[decided()] : nullptr, limits_);
    if (!has_decided()) return d;
    d.causes = causes.leading();
    d.explanation = explanation_of(findings_, decision_, limits_);
    const Proposal& explaining = findings_.proposals[decided()];
    if (explaining.left_out) {
        const Cell cell = cells_of(evidence_.library.grid)[*explaining.left_out];
        d.explanation->without = fmt::format("{:.4g} mm of {}ing", cell.displacement * 1e3, name(cell.phase));
    }
    d.gap_reduction = measure_reduction(data_, split_of(explaining), explaining, mean_of_, evidence_.seed);
    d.gap_reduction->placebo = findings_.placebo;
    d.gap_reduction->interval = {d.gap_reduction->interval[0] - limits_.reduction_margin,
                                 std::min(1.0, d.gap_reduction->interval[1] + limits_.reduction_margin)};
    d.gap_reduction->fitted_displacement = {0, fitted_part * evidence_.library.grid.stroke};
    if (!by_likelihood(explaining)) d.gap_reduction->confirmed = explaining.confirmed_reduction;
    return d;
}

}  // namespace mcdem::diagnose
