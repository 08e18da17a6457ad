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
class Trying {
public:
    Trying(const OpenChallenge& open, const ChallengeResults& results, const std::filesystem::path& folder)
        : open_(open), results_(results), folder_(folder) {}

    OtherArms all(const std::function<void(double)>& on_progress) {
        OtherArms arms{{ablations().size(), std::vector<Findings>(open_.cases.size())},
                       {simpler_methods().size(), std::vector<Answer>(open_.cases.size())}};
        std::mutex turn;
        std::size_t done = 0;
        in_parallel(open_.cases.size(), [&](std::size_t k) {
            if (results_.cases[k].problem.empty()) one(k, arms);
            const std::lock_guard lock(turn);
            on_progress(static_cast<double>(++done) / static_cast<double>(open_.cases.size()));
        });
        return arms;
    }

private:
    void one(std::size_t k, OtherArms& arms) const {
        const Evidence evidence = read_evidence(evidence_file(folder_, open_.cases[k]), results_.library);
        for (std::size_t a = 0; a < arms.findings.size(); ++a)
            arms.findings[a][k] = ablated_findings(evidence, ablations()[a]);
        for (std::size_t a = 0; a < arms.answers.size(); ++a)
            arms.answers[a][k] = simpler_methods()[a].answer(evidence);
    }

    const OpenChallenge& open_;
    const ChallengeResults& results_;
    const std::filesystem::path& folder_;
};

/// The cases of one half.
template <class Case>
std::vector<Case> half_of(const std::vector<Case>& cases, bool first) {
    std::vector<Case> half;
    for (const Case& c : cases)
        if (in_first_half(c.truth->packing) == first) half.push_back(c);
    return half;
}

class Scoring {
public:
    Scoring(const Challenge& truth, const ChallengeResults& results) : truth_(truth), results_(results) {}

    ArmScore with_limits(std::string_view name, std::string_view meaning,
                         const std::vector<Findings>& findings) const {
        std::vector<LimitCase> cases;
        for (std::size_t k = 0; k < truth_.cases.size(); ++k)
            cases.push_back({&truth_.cases[k], &findings[k], over_limit(truth_.cases[k], results_.cases[k])});
        const auto first = half_of(cases, true), second = half_of(cases, false);
        ArmScore arm{std::string(name), std::string(meaning), true, choose_limits(first), {}, {}};
        arm.first = merits_with(first, arm.limits);
        arm.second = merits_with(second, arm.limits);
        return arm;
    }

    ArmScore without_limits(const SimplerMethod& method, const std::vector<Answer>& answers) const {
        const auto cases = scored(answers);
        return {std::string(method.name),        std::string(method.meaning),     false, {},
                merits_of(half_of(cases, true)), merits_of(half_of(cases, false))};
    }

    std::vector<ScoredCase> scored(const std::vector<Answer>& answers) const {
        std::vector<ScoredCase> cases;
        for (std::size_t k = 0; k < truth_.cases.size(); ++k)
            cases.push_back({&truth_.cases[k], answers[k], over_limit(truth_.cases[k], results_.cases[k])});
        return cases;
    }

private:
    const Challenge& truth_;
    const ChallengeResults& results_;
};

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
    const OtherArms others = Trying(open, results, folder).all(on_progress);
    const Scoring scoring(truth, results);
    ChallengeScore score;
    score.cases = static_cast<int>(truth.cases.size());
    std::vector<Findings> whole;
    for (std::size_t k = 0; k < results.cases.size(); ++k) {
        whole.push_back(results.cases[k].findings);
        if (const std::string& problem = results.cases[k].problem; !problem.empty())
            score.not_diagnosed.push_back(open.cases[k].folder + ": " + problem);
    }
    score.arms.push_back(scoring.with_limits("whole method", "with confirming runs", whole));
    for (std::size_t a = 0; a < others.findings.size(); ++a)
        score.arms.push_back(
            scoring.with_limits(ablations()[a].name, ablations()[a].meaning, others.findings[a]));
    for (std::size_t a = 0; a < others.answers.size(); ++a)
        score.arms.push_back(scoring.without_limits(simpler_methods()[a], others.answers[a]));
    score.gap_reduction = score_gap_reduction(results.cases);
    std::vector<Answer> answers;
    for (const Findings& findings : whole) answers.push_back(answer_of(findings, score.arms.front().limits));
    score.scored = half_of(scoring.scored(answers), false);
    return score;
}

}  // namespace mcdem::challenge
