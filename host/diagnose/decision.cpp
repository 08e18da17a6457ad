#include "diagnose/decision.h"

#include <algorithm>
#include <cmath>

namespace mcdem {
namespace {

/// Gain by candidate: from real runs where there are some, else as far behind the leader as by signatures.
std::vector<double> known_gains(const Findings& findings, const Proposal& leader) {
    std::vector<double> gains = findings.gain;
    for (double& gain : gains)
        if (gain > 0) gain += leader.best_gain() - leader.gain;
    for (const Proposal& proposal : findings.proposals)
        if (proposal.candidates.size() == 1 && proposal.confirmed_gain)
            gains[proposal.candidates[0]] = *proposal.confirmed_gain;
    return gains;
}

/// Index of the best single effect, -1 where there is none.
int best_single(const Findings& findings) {
    int best = -1;
    for (std::size_t k = 0; k < findings.proposals.size(); ++k) {
        const Proposal& proposal = findings.proposals[k];
        if (proposal.candidates.size() != 1) continue;
        if (best < 0 || proposal.best_gain() > findings.proposals[static_cast<std::size_t>(best)].best_gain())
            best = static_cast<int>(k);
    }
    return best;
}

/// Index of a pair that explains what no single effect does and is worth its second effect, -1 where there is
/// none.
int worthy_pair(const Findings& findings, double single_gain, const Limits& limits) {
    for (std::size_t k = 0; k < findings.proposals.size(); ++k) {
        const Proposal& pair = findings.proposals[k];
        if (pair.candidates.size() == 2 && pair.best_misfit() >= limits.pair_misfit &&
            pair.best_gain() - single_gain > std::max(limits.second_gain, limits.second_share * single_gain))
            return static_cast<int>(k);
    }
    return -1;
}

/// Probability that an explanation is the whole one. What speaks for it at most is -e p ln p, the smallest
/// Bayes factor that the p-value of what it leaves allows (Sellke, Bayarri & Berger 2001).
double trust(double misfit_p, double unknown_odds) {
    const double p = std::max(misfit_p, 1e-300);
    const double factor = p < std::exp(-1.0) ? -std::exp(1.0) * p * std::log(p) : 1;
    return factor / (factor + unknown_odds);
}

/// Each candidate's share of the likelihood, gains that differ by the group's margin weighing as
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

/// The leader, and who is within the margin behind it, by gain.
std::vector<std::size_t> group_of(std::size_t leader, const std::vector<double>& gains, double best,
                                  double margin) {
    std::vector<std::size_t> group{leader};
    for (std::size_t c = 0; c < gains.size(); ++c)
        if (c != leader && gains[c] > 0 && best - gains[c] <= margin) group.push_back(c);
    std::sort(group.begin() + 1, group.end(), [&](auto a, auto b) { return gains[a] > gains[b]; });
    return group;
}

/// Index of the proposal of one candidate alone, -1 where there is none.
int proposal_of(std::size_t candidate, const Findings& findings) {
    const auto found = std::ranges::find(findings.proposals, std::vector{candidate}, &Proposal::candidates);
    return found == findings.proposals.end() ? -1 : static_cast<int>(found - findings.proposals.begin());
}

/// A stated parameter that may be wrong comes before any effect that it cannot be told from.
void suspect_calibration(Decision& decision, const Findings& findings) {
    const auto nuisance = [&](std::size_t c) { return findings.is_nuisance(c); };
    std::stable_partition(decision.group.begin(), decision.group.end(), nuisance);
    if (const int proposal = proposal_of(decision.group[0], findings); proposal >= 0)
        decision.proposal = proposal;
    decision.verdict = Verdict::calibration_suspect;
}

/// Verdict, proposal and group.
Decision chosen(const Findings& findings, int single, std::vector<std::size_t> group, double best,
                const Limits& limits) {
    Decision decision;
    decision.proposal = single;
    decision.group = std::move(group);
    if (findings.p_value >= limits.false_alarm) return decision;
    // An explanation that gains nothing in real runs is none, however little it leaves.
    if (best <= 0 || findings.proposals[static_cast<std::size_t>(single)].best_misfit() < limits.misfit) {
        const int pair = worthy_pair(findings, best, limits);
        decision.verdict = pair < 0 ? Verdict::unknown_effect : Verdict::effect;
        if (pair >= 0) {
            decision.proposal = pair;
            decision.group = findings.proposals[static_cast<std::size_t>(pair)].candidates;
        }
    } else if (findings.is_nuisance(std::ranges::max(decision.group))) {
        suspect_calibration(decision, findings);
    } else {
        decision.verdict = decision.group.size() > 1 ? Verdict::group : Verdict::effect;
    }
    return decision;
}

}  // namespace

Decision decide(const Findings& findings, const Limits& limits) {
    const int single = best_single(findings);
    if (single < 0) return {Verdict::no_gap, -1, {}, std::vector<double>(findings.gain.size(), 0.0)};
    const Proposal& leader = findings.proposals[static_cast<std::size_t>(single)];
    const std::vector<double> gains = known_gains(findings, leader);
    const double best = leader.best_gain(), margin = std::max(limits.group, limits.group_share * best);
    Decision decision =
        chosen(findings, single, group_of(leader.candidates[0], gains, best, margin), best, limits);
    const double left = findings.proposals[static_cast<std::size_t>(decision.proposal)].best_misfit();
    decision.confidence = shares(gains, best, margin, limits);
    for (double& p : decision.confidence) p *= trust(left, limits.unknown_odds);
    return decision;
}

}  // namespace mcdem
