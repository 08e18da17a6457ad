#include "diagnose/decision.h"

#include <algorithm>
#include <cmath>

namespace mcdem {
namespace {

/// Gain by candidate: from real runs where there are some.
std::vector<double> known_gains(const Findings& findings) {
    std::vector<double> gains = findings.gain;
    for (const Proposal& proposal : findings.proposals)
        if (proposal.candidates.size() == 1) gains[proposal.candidates[0]] = proposal.best_gain();
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

}  // namespace

Decision decide(const Findings& findings, const Limits& limits) {
    Decision decision;
    const std::vector<double> gains = known_gains(findings);
    const int single = best_single(findings);
    decision.confidence.assign(gains.size(), 0);
    if (single < 0) return decision;
    const double best = findings.proposals[static_cast<std::size_t>(single)].best_gain();
    const double margin = std::max(limits.group, limits.group_share * best);
    double sum = 0;
    for (std::size_t c = 0; c < gains.size(); ++c)
        sum += decision.confidence[c] = std::exp(std::min(0.0, gains[c] - best) * limits.group / margin);
    const double whole =
        trust(findings.proposals[static_cast<std::size_t>(single)].best_misfit(), limits.unknown_odds);
    for (double& p : decision.confidence) p *= whole / sum;
    decision.group = findings.proposals[static_cast<std::size_t>(single)].candidates;
    for (std::size_t c = 0; c < gains.size(); ++c)
        if (c != decision.group[0] && gains[c] > 0 && best - gains[c] <= margin) decision.group.push_back(c);
    std::sort(decision.group.begin() + 1, decision.group.end(),
              [&](auto a, auto b) { return gains[a] > gains[b]; });
    decision.proposal = single;
    if (findings.p_value >= limits.false_alarm) return decision;
    if (findings.proposals[static_cast<std::size_t>(single)].best_misfit() < limits.misfit) {
        const int pair = worthy_pair(findings, best, limits);
        decision.verdict = pair < 0 ? Verdict::unknown_effect : Verdict::effect;
        if (pair >= 0) {
            decision.proposal = pair;
            decision.group = findings.proposals[static_cast<std::size_t>(pair)].candidates;
        }
        return decision;
    }
    const auto is_effect = [&](std::size_t c) { return static_cast<int>(c) < findings.effects; };
    if (!is_effect(decision.group[0]))
        decision.verdict = Verdict::calibration_suspect;
    else
        decision.verdict = decision.group.size() > 1 ? Verdict::group : Verdict::effect;
    return decision;
}

}  // namespace mcdem
