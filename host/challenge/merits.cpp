#include "challenge/merits.h"

#include <algorithm>

namespace mcdem::inline challenge {
namespace {

bool is_true(const ChallengeCase& truth, const std::string& effect) {
    return std::ranges::find(truth.effects, effect, &Hidden::name) != truth.effects.end();
}

/// Sums for means.
struct Sums {
    double group = 0, sharpness = 0, brier = 0;
    int groups = 0;
};

void add_effect(Merits& m, Sums& sums, const ScoredCase& scored) {
    const ChallengeCase& truth = *scored.truth;
    const Answer& answer = scored.answer;
    const std::string& effect = truth.effects.front().name;
    const bool leads = leads_rightly(scored);
    const bool in_group = answer.names() && std::ranges::count(answer.group, effect) > 0;
    m.detected.add(answer.detected());
    m.detected_by_effect[effect].add(answer.detected());
    m.named.add(leads);
    m.named_by_effect[effect].add(leads);
    if (scored.over_limit < clear) return;
    m.detected_clear.add(answer.detected());
    sums.sharpness += in_group ? 1.0 / static_cast<double>(answer.group.size()) : 0;
    if (!answer.detected()) return;
    m.led_by_truth.add(leads);
    m.truth_in_group.add(in_group);
    if (!answer.names()) return;
    sums.group += static_cast<double>(answer.group.size());
    ++sums.groups;
}

void add_pair(Merits& m, const ScoredCase& scored) {
    const auto& group = scored.answer.group;
    m.pair_led.add(leads_rightly(scored));
    m.pair_found.add(scored.answer.names() && group.size() == 2 && is_true(*scored.truth, group[0]) &&
                     is_true(*scored.truth, group[1]));
}

}  // namespace

bool leader_is_true(const ScoredCase& scored) {
    return scored.answer.leads() && is_true(*scored.truth, scored.answer.group.front());
}

bool leads_rightly(const ScoredCase& scored) { return scored.answer.names() && leader_is_true(scored); }

std::string unknown_name(const ChallengeCase& truth) {
    return truth.struck.empty() ? truth.effects.front().name : "struck";
}

Merits merits_of(std::span<const ScoredCase> cases) {
    Merits m;
    Sums sums;
    for (const ScoredCase& scored : cases) {
        const Answer& answer = scored.answer;
        if (answer.leads()) {
            const bool right = leader_is_true(scored);
            m.right_leaders.add(right);
            sums.brier += (answer.confidence - right) * (answer.confidence - right);
        }
        switch (scored.truth->kind) {
            case CaseKind::none:
                m.false_alarms.add(answer.detected());
                break;
            case CaseKind::effect:
                add_effect(m, sums, scored);
                break;
            case CaseKind::pair:
                add_pair(m, scored);
                break;
            case CaseKind::unknown:
                m.named_unknown.add(answer.names());
                m.named_by_unknown[unknown_name(*scored.truth)].add(answer.names());
                break;
            case CaseKind::outside_prior:
                m.named_outside_prior.add(answer.names());
                m.suspected.add(answer.verdict == Verdict::calibration_suspect);
                break;
        }
    }
    m.group_size = sums.groups > 0 ? sums.group / sums.groups : 0;
    m.sharpness = m.detected_clear.of > 0 ? sums.sharpness / m.detected_clear.of : 0;
    m.brier = m.right_leaders.of > 0 ? sums.brier / m.right_leaders.of : 0;
    return m;
}

Answer answer_of(const Findings& findings, const Limits& limits) {
    const Decision decision = decide(findings, limits);
    Answer answer{decision.verdict, {}, 0};
    for (const std::size_t candidate : decision.group) answer.group.push_back(findings.names[candidate]);
    if (answer.leads()) answer.confidence = decision.confidence[decision.group.front()];
    return answer;
}

}  // namespace mcdem::challenge
