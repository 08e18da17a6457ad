#include "diagnose/decide/decision.h"

#include <cmath>

namespace mcdem::inline diagnose {
namespace {

/// Gain by candidate: from real runs if there are any, otherwise as far behind the leading one as by
/// signatures.
std::vector<double> known_gains(const Findings& findings, const Proposal& leader) {
    std::vector<double> gains = findings.gain;
    for (double& gain : gains)
        if (gain > 0) gain += leader.best_gain() - leader.gain;
    for (const Proposal& proposal : findings.proposals)
        if (proposal.candidates.size() == 1 && proposal.confirmed_gain)
            gains[proposal.candidates[0]] = *proposal.confirmed_gain;
    return gains;
}

/// Index of the best single effect; -1 if there is none.
int best_single(const Findings& findings) {
    int best = -1;
    for (std::size_t k = 0; k < findings.proposals.size(); ++k) {
        const Proposal& proposal = findings.proposals[k];
        if (proposal.candidates.size() != 1) continue;
        if (best < 0 || proposal.best_gain() > findings.proposals[best].best_gain())
            best = static_cast<int>(k);
    }
    return best;
}

/// Index of a pair with a sufficient gain from its second effect; -1 if there is none.
int gaining_pair(const Findings& findings, double single_gain, const Limits& limits) {
    for (std::size_t k = 0; k < findings.proposals.size(); ++k) {
        const Proposal& pair = findings.proposals[k];
        if (pair.is_pair() && pair.best_gain() - single_gain > limits.second_margin(single_gain))
            return static_cast<int>(k);
    }
    return -1;
}

/// Reduction required to name an effect: most of the gap, and clearly more than the placebo. A small gap in
/// held-out data is measured badly: if one effect leaves only noise in all data, it may take away less by the
/// noise of the reduction.
double needed_reduction(const Proposal& proposal, const Findings& findings, const Limits& limits) {
    const bool only_noise = !proposal.is_pair() && proposal.best_misfit() >= limits.only_noise;
    double known = proposal.is_pair() ? limits.pair_reduction : limits.reduction;
    if (only_noise) known = std::max(known - findings.held_out_noise, limits.min_reduction);
    return std::max(known, findings.placebo + limits.over_placebo);
}

bool takes_the_gap_away(const Proposal& proposal, const Findings& findings, const Limits& limits) {
    return proposal.best_reduction() >= needed_reduction(proposal, findings, limits);
}

/// Largest fraction of the gap that a named effect may leave: the less probable it is that the remainder is
/// noise, the more probable is another cause.
double allowed_remainder(const Proposal& proposal, const Limits& limits) {
    const double p = proposal.best_misfit();
    return p < limits.another_form ? limits.form_remainder : p < limits.misfit ? limits.remainder : 1.0;
}

bool leaves_too_much(const Proposal& proposal, const Limits& limits) {
    return 1 - proposal.best_reduction() > allowed_remainder(proposal, limits);
}

/// Whether a pair is better than a single effect: one leaves more than noise, or is much less likely, and
/// two leave only noise. Two free amplitudes take away most of many gaps with another cause, so a pair
/// that leaves more is not named. If a place is left out for the pair, one may be left out for the single
/// effect as well.
bool is_better(const Proposal& pair, const Proposal& single, const Limits& limits) {
    if (pair.best_misfit() < limits.pair_misfit) return false;
    if (pair.left_out) return single.best_misfit() < limits.misfit;
    return single.whole_misfit() < limits.misfit ||
           pair.best_gain() - single.best_gain() > limits.second_certain;
}

/// Probability that an explanation with this reduction is right, as in 343 gaps of five challenges
/// (tests/external/results.md).
double trust(const Proposal& proposal, const Findings& findings, const Limits& limits) {
    const double low = needed_reduction(proposal, findings, limits) - limits.doubt_below;
    const double rise = limits.doubt_below + limits.certain_above;
    const double above = std::clamp((proposal.best_reduction() - low) / rise, 0.0, 1.0);
    const double most = proposal.best_misfit() < limits.another_form ? limits.right_form : limits.right_above;
    const double right = limits.right_below + above * (most - limits.right_below);
    const bool refused = !takes_the_gap_away(proposal, findings, limits) || leaves_too_much(proposal, limits);
    return refused ? std::min(right, limits.right_refused) : right;
}

/// Share of each candidate in the likelihood; gains are scaled so that the group's margin corresponds to
/// `limits.group`.
std::vector<double> shares(const std::vector<double>& gains, double best, double margin,
                           const Limits& limits) {
    std::vector<double> parts;
    double sum = 0;
    for (const double gain : gains)
        sum += parts.emplace_back(std::exp(std::min(0.0, gain - best) * limits.group / margin));
    for (double& part : parts) part /= sum;
    return parts;
}

/// The leading candidate, and those within the margin, by gain.
std::vector<std::size_t> group_of(std::size_t leader, const std::vector<double>& gains, double best,
                                  double margin) {
    std::vector<std::size_t> group{leader};
    for (std::size_t c = 0; c < gains.size(); ++c)
        if (c != leader && gains[c] > 0 && best - gains[c] <= margin) group.push_back(c);
    std::sort(group.begin() + 1, group.end(), [&](auto a, auto b) { return gains[a] > gains[b]; });
    return group;
}

/// Index of the proposal with only this candidate; -1 if there is none.
int proposal_of(std::size_t candidate, const Findings& findings) {
    const auto found = std::ranges::find(findings.proposals, std::vector{candidate}, &Proposal::candidates);
    return found == findings.proposals.end() ? -1 : static_cast<int>(found - findings.proposals.begin());
}

/// Removes members of the group that were tried and take away too little of the gap, even if their likelihood
/// is close.
void keep_those_that_do(std::vector<std::size_t>& group, const Findings& findings, const Limits& limits) {
    const auto fails = [&](std::size_t candidate) {
        const int k = proposal_of(candidate, findings);
        return k >= 0 && !takes_the_gap_away(findings.proposals[k], findings, limits);
    };
    group.erase(std::remove_if(group.begin() + 1, group.end(), fails), group.end());
}

/// Suspects take precedence over effects from which they cannot be distinguished: first the simulation's own
/// numerics, then stated parameters.
template <class IsSuspect>
bool suspected(Decision& decision, const Findings& findings, Verdict verdict, IsSuspect is_suspect) {
    if (std::ranges::none_of(decision.group, is_suspect)) return false;
    std::stable_partition(decision.group.begin(), decision.group.end(), is_suspect);
    decision.verdict = verdict;
    const auto& decided = chosen_proposal(findings, decision);
    if (const int proposal = proposal_of(decision.group[0], findings);
        proposal >= 0 && decided.candidates.size() == 1)
        decision.proposal = proposal;
    return true;
}

void name_it(Decision& decision, const Findings& findings, const Limits& limits) {
    const bool pair = chosen_proposal(findings, decision).is_pair();
    if (suspected(decision, findings, Verdict::not_converged,
                  [&](std::size_t c) { return findings.is_numerical(c); }))
        return;
    if (!pair && suspected(decision, findings, Verdict::calibration_suspect,
                           [&](std::size_t c) { return findings.is_nuisance(c); }))
        return;
    if (leaves_too_much(chosen_proposal(findings, decision), limits))
        decision.verdict = Verdict::unknown_effect;
    else
        decision.verdict = !pair && decision.group.size() > 1 ? Verdict::group : Verdict::effect;
}

/// Selects verdict, proposal and group.
Decision chosen(const Findings& findings, int single, std::vector<std::size_t> group, const Limits& limits) {
    Decision decision;
    decision.proposal = single;
    decision.group = std::move(group);
    if (findings.p_value >= limits.false_alarm) return decision;
    const Proposal& leader = findings.proposals[single];
    const int pair = gaining_pair(findings, leader.best_gain(), limits);
    if (pair >= 0) {
        const Proposal& two = findings.proposals[pair];
        if (takes_the_gap_away(two, findings, limits) && is_better(two, leader, limits)) {
            decision.proposal = pair;
            decision.group = two.candidates;
            name_it(decision, findings, limits);
            return decision;
        }
    }
    if (!takes_the_gap_away(leader, findings, limits)) {
        decision.verdict = Verdict::unknown_effect;
        return decision;
    }
    keep_those_that_do(decision.group, findings, limits);
    name_it(decision, findings, limits);
    return decision;
}

}  // namespace

Decision decide(const Findings& findings, const Limits& limits) {
    const int single = best_single(findings);
    if (single < 0) {  // no effect gains anything, or none could be tested
        const bool gap = findings.p_value < limits.false_alarm;
        return {gap ? Verdict::unknown_effect : Verdict::no_gap,
                -1,
                {},
                std::vector<double>(findings.gain.size(), 0.0)};
    }
    const Proposal& leader = findings.proposals[single];
    const std::vector<double> gains = known_gains(findings, leader);
    const double best = leader.best_gain(), margin = limits.group_margin(best);
    Decision decision = chosen(findings, single, group_of(leader.candidates[0], gains, best, margin), limits);
    const Proposal& decided = chosen_proposal(findings, decision);
    const double right = trust(decided, findings, limits);
    if (decided.is_pair()) {  // a pair: gains of single effects are not compared
        decision.confidence.assign(findings.gain.size(), 0.0);
        for (const std::size_t c : decided.candidates) decision.confidence[c] = right;
        return decision;
    }
    decision.confidence = shares(gains, best, margin, limits);
    for (double& p : decision.confidence) p *= right;
    return decision;
}

std::vector<std::size_t> contenders(const Findings& findings, const Limits& limits) {
    std::vector<std::size_t> list;
    if (const int single = best_single(findings); single >= 0) {
        list.push_back(static_cast<std::size_t>(single));
        const int pair = gaining_pair(findings, findings.proposals[list[0]].best_gain(), limits);
        if (pair >= 0) list.push_back(static_cast<std::size_t>(pair));
    }
    return list;
}

std::optional<Explanation> explanation_of(const Findings& findings, const Decision& decision,
                                          const Limits& limits) {
    if (decision.verdict == Verdict::no_gap || decision.proposal < 0) return std::nullopt;
    const Proposal& decided = chosen_proposal(findings, decision);
    const bool more_than_noise = decided.best_misfit() < limits.misfit;
    const bool suspect =
        decision.verdict == Verdict::not_converged || decision.verdict == Verdict::calibration_suspect;
    const double needed = needed_reduction(decided, findings, limits);
    return Explanation{.reduction = decided.best_reduction(),
                       .simulated = decided.confirmed_reduction.has_value(),
                       .held_out = findings.held_out,
                       .placebo = findings.placebo,
                       .needed = suspect ? needed : std::max(needed, 1 - allowed_remainder(decided, limits)),
                       .remainder_p = decided.best_misfit(),
                       .leaves_more_than_noise = more_than_noise};
}

}  // namespace mcdem::diagnose
