#include "diagnose/decide/next_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/median.h"
#include "diagnose/infer/effects.h"
#include "diagnose/infer/library.h"
#include "diagnose/observe/needed_to_diagnose.h"

namespace mcdem::inline diagnose {
namespace {

constexpr double times_better = 5;  ///< factor by which a parameter is measured better
constexpr int more_packings = 3;
constexpr double worth_saying = 0.9;  ///< ratio to the present error or limit; larger ones are not reported
constexpr std::size_t max_steps = 4;

/// A possible measurement and the space that results from it.
struct Measurement {
    std::string what;
    GapSpace space;
};

std::string key_of(const std::string& nuisance) {
    if (nuisance == "modulus") return "grains.youngs_modulus";
    if (nuisance == "strain_offset") return "the zero of the plate's displacement";
    if (nuisance == "gamma") return "contact.gamma";
    return nuisance == "wall_friction" ? "walls.friction" : "grains.friction";
}

/// Runs of one scene minus their mean, scaled to the variance of one run.
Eigen::MatrixXd scatter_of(const Eigen::MatrixXd& runs) {
    return apart_from_mean(runs, std::vector<int>(static_cast<std::size_t>(runs.rows()), 0));
}

/// Noise if positions were measured twice as accurately: that of the diagnosis, scaled cell by cell as the
/// scatter of the replicates.
Eigen::MatrixXd finer_noise(const Evidence& evidence, Eigen::MatrixXd noise) {
    const auto sigma = [](const Eigen::MatrixXd& runs) -> Eigen::ArrayXd {
        return scatter_of(runs).colwise().norm().transpose() / std::sqrt(static_cast<double>(runs.rows()));
    };
    const Eigen::ArrayXd ratio = sigma(evidence.finer_baseline) / sigma(evidence.baseline);
    for (Eigen::Index cell = 0; cell < noise.cols(); ++cell)
        if (std::isfinite(ratio[cell])) noise.col(cell) *= ratio[cell];
    return noise;
}

std::vector<Measurement> measurements_of(const Evidence& evidence, const GapData& data) {
    const int mean_of = static_cast<int>(evidence.baseline.rows());
    std::vector<Measurement> list;
    for (std::size_t k = 0; k < data.free.size(); ++k) {
        std::vector<FreeParameter> free = data.free;
        free[k].sigma /= times_better;
        list.push_back({fmt::format("determine {} {:g} times more accurately",
                                    key_of(evidence.nuisances[k].name), times_better),
                        GapSpace(data.noise, mean_of, data.cells, free)});
    }
    const double times_more = 1 + static_cast<double>(more_packings) / data.packings;
    list.push_back({fmt::format("measure {} more packings and diagnose them together (--experiment for each)",
                                more_packings),
                    GapSpace(data.noise / std::sqrt(times_more), mean_of, data.cells, data.free)});
    if (evidence.finer_baseline.rows() > 1)
        list.push_back({"measure positions twice as accurately",
                        GapSpace(finer_noise(evidence, data.noise), mean_of, data.cells, data.free)});
    if (!not_measured(evidence.observed, evidence.library.grid).empty()) {
        const auto all = usable_cells(evidence.library.baseline, parameters_of(evidence),
                                      Eigen::VectorXd::Zero(data.mean.size()));
        if (all.size() > data.cells.size())
            list.push_back({"measure contact forces, with the positions of grains in the same frames",
                            GapSpace(data.noise, mean_of, all, data.free)});
    }
    return list;
}

/// Squared distance, in sigmas, of a signature from the closest one of another candidate.
double distance(const GapSpace& whole, const Candidate& a, double amplitude, const Candidate& b) {
    const GapSpace& space = whole.lacking(lacking_cells({a, b}));
    const Eigen::VectorXd gap = a.signature->at(amplitude);
    return std::max(0.0, space.whiten(gap).squaredNorm() - 2 * fit_effect(space, b, gap).score);
}

/// Probability that the likelihoods of two explanations differ by more than the margin of a group.
double power_to_tell(double squared_distance, double margin) {
    if (!(squared_distance > 0)) return 0;
    const double sigma = std::sqrt(squared_distance);
    return std::erfc(-(0.5 * squared_distance - margin) / sigma / std::numbers::sqrt2) /
           2;  // normal distribution
}

/// The amplitude of a candidate in the decision.
double amplitude_of(const Findings& findings, const Decision& decision, std::size_t candidate) {
    const Proposal& decided = chosen_proposal(findings, decision);
    const auto place = std::ranges::find(decided.candidates, candidate) - decided.candidates.begin();
    return place < std::ssize(decided.candidates) ? decided.amplitudes[place] : 0;
}

/// Measurements that distinguish the leading effect from the others in its group.
std::vector<NextStep> telling_apart(const std::vector<Measurement>& measurements, const GapData& data,
                                    const Findings& findings, const Decision& decision,
                                    const Limits& limits) {
    const Proposal& decided = chosen_proposal(findings, decision);
    const std::size_t leader = decided.candidates.front();
    const double amplitude = amplitude_of(findings, decision, leader);
    const auto rival = std::ranges::find_if(decision.group, [&](std::size_t c) { return c != leader; });
    std::vector<NextStep> steps;
    for (const Measurement& m : measurements) {
        const double squared = distance(m.space, data.candidates[leader], amplitude, data.candidates[*rival]);
        const double gain = 0.5 * m.space.lacking(data.candidates[leader].lacking)
                                      .whiten(data.candidates[leader].signature->at(amplitude))
                                      .squaredNorm();
        steps.push_back(
            {fmt::format("{}, to distinguish {} from {}", m.what, data.name(leader), data.name(*rival)),
             power_to_tell(squared, limits.group_margin(gain))});
    }
    return steps;
}

/// Information on a candidate's amplitude after a measurement, over the present one.
double more_information(const GapSpace& then, const GapSpace& now, const Candidate& candidate,
                        double amplitude) {
    const Eigen::VectorXd slope = candidate.signature->slope(amplitude);
    const double known = now.lacking(candidate.lacking).whiten(slope).squaredNorm();
    return known > 0 ? then.lacking(candidate.lacking).whiten(slope).squaredNorm() / known : 1;
}

/// Without rivals: resulting errors of the amplitude, or without a gap resulting detection limits.
std::vector<NextStep> sharpening(const std::vector<Measurement>& measurements, const Evidence& evidence,
                                 const GapData& data, const Findings& findings, const Decision& decision) {
    const GapSpace now(data.noise, static_cast<int>(evidence.baseline.rows()), data.cells, data.free);
    const bool named = decision.verdict == Verdict::effect;
    std::vector<std::pair<double, std::string>> found;
    for (const Measurement& m : measurements) {
        std::vector<double> parts;
        for (std::size_t c = 0; c < static_cast<std::size_t>(data.effects); ++c) {
            if (named && c != decision.group.front()) continue;
            const double amplitude = named ? amplitude_of(findings, decision, c) : 0;
            parts.push_back(1 / std::sqrt(more_information(m.space, now, data.candidates[c], amplitude)));
        }
        if (const double part = median(parts); part <= worth_saying)
            found.push_back(
                {part, fmt::format("{}: {} to {:.0f} % of the present value", m.what,
                                   named ? "the amplitude's error falls" : "the median detection limit falls",
                                   100 * part)});
    }
    std::ranges::sort(found);
    std::vector<NextStep> steps;
    for (const auto& [part, what] : found) steps.push_back({what, {}});
    return steps;
}

/// The cells of the diagnosis that the runs have too, and those that no run of the baseline has.
CellChoice cells_of_protocol(const ProtocolRuns& runs, const Eigen::MatrixXd& baseline,
                             const CellChoice& known) {
    CellChoice cells;
    for (Eigen::Index cell = 0; cell < baseline.cols(); ++cell) {
        const bool is_new = !baseline.col(cell).array().isFinite().any();
        if (!is_new && !std::ranges::binary_search(known, cell)) continue;
        if (runs.leader.col(cell).allFinite() && runs.rival.col(cell).allFinite()) cells.push_back(cell);
    }
    return cells;
}

/// Replaces NaN in columns of `cells` by the scatter of the runs.
Eigen::MatrixXd with_noise_of_new_cells(Eigen::MatrixXd noise, const Eigen::MatrixXd& runs,
                                        const CellChoice& cells) {
    const Eigen::MatrixXd scatter = scatter_of(runs);
    for (const Eigen::Index cell : cells) {
        if (noise.col(cell).allFinite()) continue;
        for (Eigen::Index row = 0; row < noise.rows(); ++row)
            noise(row, cell) = scatter(row % scatter.rows(), cell);
    }
    return noise;
}

/// NaN, where a cell does not know a parameter, becomes zero.
Eigen::VectorXd or_zero(const Eigen::VectorXd& values) {
    return values.unaryExpr([](double value) { return std::isfinite(value) ? value : 0; });
}

/// Whether several single effects explain the gap, which a measurement might distinguish.
bool has_rivals(const Findings& findings, const Decision& decision) {
    return decision.verdict != Verdict::no_gap && decision.proposal >= 0 && decision.group.size() > 1 &&
           !chosen_proposal(findings, decision).is_pair();
}

}  // namespace

std::optional<NextStep> check_of(const Diagnosis& diagnosis) {
    if (diagnosis.check_first.empty()) return std::nullopt;
    std::string keys;
    for (const NuisanceFit& fit : diagnosis.check_first)
        keys += (keys.empty() ? "" : ", ") + key_of(fit.name);
    return NextStep{
        fmt::format("check {}: measure again what the experiment states, correct the scene or the "
                    "data, and diagnose again before anything else is changed",
                    keys),
        {}};
}

std::optional<std::size_t> proposal_of_rival(const Findings& findings, const Decision& decision) {
    if (!has_rivals(findings, decision)) return std::nullopt;
    const std::size_t leader = chosen_proposal(findings, decision).candidates.front();
    for (const std::size_t candidate : decision.group)
        for (std::size_t k = 0; k < findings.proposals.size(); ++k)
            if (candidate != leader && findings.proposals[k].candidates == std::vector{candidate}) return k;
    return std::nullopt;
}

double power_of_protocol(const ProtocolRuns& runs, const Evidence& evidence, const GapData& data,
                         const Findings& findings, const Decision& decision, const Limits& limits) {
    const CellChoice cells = cells_of_protocol(runs, evidence.baseline, data.cells);
    if (cells.empty()) return 0;
    const Proposal& rival = findings.proposals[*proposal_of_rival(findings, decision)];
    std::vector<FreeParameter> free = data.free;
    // The rival's amplitude is fitted to the new data as well.
    free.push_back({data.candidates[rival.candidates.front()].signature->slope(rival.amplitudes.front()),
                    std::abs(rival.amplitudes.front())});
    for (FreeParameter& parameter : free) parameter.direction = or_zero(parameter.direction);
    const GapSpace space(with_noise_of_new_cells(data.noise, runs.leader, cells),
                         static_cast<int>(evidence.baseline.rows()), cells, free);
    // The product of the means of both halves of the runs has no bias by their noise.
    const Eigen::MatrixXd apart = runs.leader - runs.rival;
    const Eigen::Index half = apart.rows() / 2;
    const double squared =
        space.whiten(apart.topRows(half).colwise().mean().transpose())
            .dot(space.whiten(apart.bottomRows(apart.rows() - half).colwise().mean().transpose()));
    return power_to_tell(squared, limits.group_margin(chosen_proposal(findings, decision).best_gain()));
}

std::vector<NextStep> next_measurements(const Evidence& evidence, const GapData& data,
                                        const Findings& findings, const Decision& decision,
                                        const Limits& limits) {
    const std::vector<Measurement> measurements = measurements_of(evidence, data);
    std::vector<NextStep> steps = has_rivals(findings, decision)
                                      ? telling_apart(measurements, data, findings, decision, limits)
                                      : sharpening(measurements, evidence, data, findings, decision);
    std::ranges::stable_sort(steps, std::greater(), [](const NextStep& s) { return s.power.value_or(0); });
    if (steps.size() > max_steps) steps.resize(max_steps);
    if (decision.verdict != Verdict::no_gap && !has_rivals(findings, decision) &&
        std::ranges::any_of(decision.group, [&](std::size_t c) { return depends_on_speed(data.name(c)); }))
        steps.push_back(
            {"repeat the experiment at another plate speed: a difference that changes with speed is not "
             "caused by geometry or elasticity",
             {}});
    if (decision.verdict == Verdict::unknown_effect)
        steps.insert(
            steps.begin(),
            NextStep{
                "see Where for the observables that differ, and check the data (`mcdem experiment check`), "
                "the stated parameters and units, and the numerics (`mcdem converge`)",
                {}});
    return steps;
}

}  // namespace mcdem::diagnose
