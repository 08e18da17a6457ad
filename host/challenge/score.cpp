#include "challenge/score.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "challenge/ablations.h"
#include "challenge/results.h"
#include "core/errors.h"
#include "core/in_parallel.h"

namespace mcdem::inline challenge {
namespace {

double over_limit(const ChallengeCase& truth, const CaseResult& result) {
    if (truth.kind != CaseKind::effect) return 0;
    const auto limit = result.detection_limits.find(truth.effects.front().name);
    if (limit == result.detection_limits.end()) return 0;
    return std::abs(truth.effects.front().amplitude) / limit->second;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t half = values.size() / 2;
    return values.empty() ? 0 : values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

GapReductionScore score_gap_reduction(const std::vector<CaseResult>& results) {
    GapReductionScore score;
    std::vector<double> errors;
    for (const CaseResult& result : results) {
        if (!result.gap_reduction) continue;
        const PredictedReduction& gap_reduction = *result.gap_reduction;
        errors.push_back(std::abs(gap_reduction.fraction - gap_reduction.confirmed));
        score.covered.add(gap_reduction.interval[0] <= gap_reduction.confirmed &&
                          gap_reduction.confirmed <= gap_reduction.interval[1]);
    }
    score.cases = static_cast<int>(errors.size());
    score.median_error = median(errors);
    return score;
}

/// Findings and answers of all methods except the whole one, by method and case.
struct OtherArms {
    std::vector<std::vector<Findings>> findings;
    std::vector<std::vector<Answer>> answers;
};

/// Evaluates all methods for all diagnosed cases, on all cores.
OtherArms try_other_arms(const OpenChallenge& open, const ChallengeResults& results,
                         const std::filesystem::path& folder,
                         const std::function<void(double)>& on_progress) {
    OtherArms arms{{ablations().size(), std::vector<Findings>(open.cases.size())},
                   {simpler_methods().size(), std::vector<Answer>(open.cases.size())}};
    std::mutex turn;
    std::size_t done = 0;
    in_parallel(open.cases.size(), [&](std::size_t k) {
        if (results.cases[k].problem.empty()) {
            const Evidence evidence = read_evidence(evidence_file(folder, open.cases[k]), results.library);
            for (std::size_t a = 0; a < arms.findings.size(); ++a)
                arms.findings[a][k] = ablated_findings(evidence, ablations()[a]);
            for (std::size_t a = 0; a < arms.answers.size(); ++a)
                arms.answers[a][k] = simpler_methods()[a].answer(evidence);
        }
        const std::lock_guard lock(turn);
        on_progress(static_cast<double>(++done) / static_cast<double>(open.cases.size()));
    });
    return arms;
}

/// The cases of one half.
template <class Case>
std::vector<Case> half_of(const std::vector<Case>& cases, bool first) {
    std::vector<Case> half;
    for (const Case& c : cases)
        if (in_first_half(c.truth->packing) == first) half.push_back(c);
    return half;
}

ArmScore score_with_limits(const Challenge& truth, const ChallengeResults& results, std::string_view name,
                           std::string_view meaning, const std::vector<Findings>& findings) {
    std::vector<LimitCase> cases;
    for (std::size_t k = 0; k < truth.cases.size(); ++k)
        cases.push_back({&truth.cases[k], &findings[k], over_limit(truth.cases[k], results.cases[k])});
    const auto first = half_of(cases, true), second = half_of(cases, false);
    ArmScore arm{std::string(name), std::string(meaning), true, choose_limits(first), {}, {}};
    arm.first = merits_with(first, arm.limits);
    arm.second = merits_with(second, arm.limits);
    return arm;
}

std::vector<ScoredCase> scored(const Challenge& truth, const ChallengeResults& results,
                               const std::vector<Answer>& answers) {
    std::vector<ScoredCase> cases;
    for (std::size_t k = 0; k < truth.cases.size(); ++k)
        cases.push_back({&truth.cases[k], answers[k], over_limit(truth.cases[k], results.cases[k])});
    return cases;
}

void expect_same_cases(const Challenge& truth, const OpenChallenge& open) {
    bool same = truth.cases.size() == open.cases.size();
    for (std::size_t k = 0; same && k < open.cases.size(); ++k)
        same = truth.cases[k].folder == open.cases[k].folder;
    if (!same) throw InputError("challenge.json: lists other cases than its truth");
}

}  // namespace

ChallengeScore score_challenge(const Challenge& truth, const OpenChallenge& open,
                               const std::filesystem::path& folder,
                               const std::function<void(double)>& on_progress) {
    expect_same_cases(truth, open);
    const ChallengeResults results = read_challenge_results(folder, open);
    const OtherArms others = try_other_arms(open, results, folder, on_progress);
    ChallengeScore score;
    score.cases = static_cast<int>(truth.cases.size());
    std::vector<Findings> whole;
    for (std::size_t k = 0; k < results.cases.size(); ++k) {
        whole.push_back(results.cases[k].findings);
        if (const std::string& problem = results.cases[k].problem; !problem.empty())
            score.not_diagnosed.push_back(open.cases[k].folder + ": " + problem);
    }
    score.arms.push_back(score_with_limits(truth, results, "whole method", "with confirming runs", whole));
    for (std::size_t a = 0; a < others.findings.size(); ++a)
        score.arms.push_back(score_with_limits(truth, results, ablations()[a].name, ablations()[a].meaning,
                                               others.findings[a]));
    for (std::size_t a = 0; a < others.answers.size(); ++a) {
        const SimplerMethod& method = simpler_methods()[a];
        const auto cases = scored(truth, results, others.answers[a]);
        const Merits first = merits_of(half_of(cases, true)), second = merits_of(half_of(cases, false));
        score.arms.push_back(
            {std::string(method.name), std::string(method.meaning), false, {}, first, second});
    }
    score.gap_reduction = score_gap_reduction(results.cases);
    std::vector<Answer> answers;
    for (const Findings& findings : whole) answers.push_back(answer_of(findings, score.arms.front().limits));
    score.scored = half_of(scored(truth, results, answers), false);
    return score;
}

}  // namespace mcdem::challenge
