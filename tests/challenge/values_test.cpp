#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "challenge/figure_values.h"

namespace mcdem {
namespace {

TEST(WilsonInterval, agrees_with_newcombe_1998) {
    // Newcombe, Statistics in Medicine 17 (1998) 857, Table I, method 3, to four decimals
    const auto expect = [](int successes, int trials, double low, double high) {
        const auto interval = wilson_interval(successes, trials);
        EXPECT_NEAR(interval[0], low, 5.1e-5) << successes;
        EXPECT_NEAR(interval[1], high, 5.1e-5) << successes;
    };
    expect(81, 263, 0.2553, 0.3662);
    expect(15, 148, 0.0624, 0.1605);
    expect(0, 20, 0, 0.1611);
    expect(1, 29, 0.0061, 0.1718);
    EXPECT_EQ(wilson_interval(0, 0), (std::array{0.0, 1.0}));
    EXPECT_DOUBLE_EQ(wilson_interval(20, 20)[1], 1);
    for (int trials = 1; trials <= 100; ++trials)
        for (int successes = 0; successes <= trials; ++successes) {
            const auto [low, high] = wilson_interval(successes, trials);
            const double share = static_cast<double>(successes) / trials;
            EXPECT_TRUE(0 <= low && low <= share && share <= high && high <= 1)
                << successes << " of " << trials;
        }
}

TEST(IdealPower, has_the_stated_values) {
    EXPECT_NEAR(ideal_power(0.05, 0), 0.05, 1e-12);
    EXPECT_NEAR(ideal_power(0.05, 1), 0.8, 1e-5);  // the other sign adds 1e-6
    // half of the cases at 1.96 sigma; the limit is 1.960 + 0.8416 sigma
    EXPECT_NEAR(ideal_power(0.05, 1.95996 / (1.95996 + 0.84162)), 0.5, 1e-4);
    EXPECT_GT(ideal_power(0.05, 2), 0.999);
}

const ChallengeCase no_effect{}, adhesion{{}, CaseKind::effect, {{"adhesion", 1e-3}}, {}, {}};
const Answer nothing{}, right{Verdict::effect, {"adhesion"}, 0.9}, unknown{Verdict::unknown_effect, {}, 0};

/// The figures for these numbers of cases of each kind.
nlohmann::ordered_json figures_of(const std::vector<std::pair<int, ScoredCase>>& cases) {
    ChallengeScore score;
    score.arms.push_back({"whole", "", true, {.false_alarm = 0.05}, {}, {}});
    for (const auto& [count, one] : cases) score.scored.insert(score.scored.end(), count, one);
    return score_figure_values(score);
}

TEST(ScoreFigures, count_cases_and_mark_correct_answers) {
    const auto values = figures_of({{9, {&no_effect, nothing}},
                                    {1, {&no_effect, right}},
                                    {2, {&adhesion, nothing}},
                                    {3, {&adhesion, right}},
                                    {5, {&adhesion, unknown}}})["confusion"];
    EXPECT_EQ(values["truths"], (nlohmann::json{"no_gap", "adhesion"}));
    EXPECT_EQ(values["verdicts"], (nlohmann::json{"no_gap", "adhesion", "unknown_effect"}));
    EXPECT_EQ(values["cases"], (nlohmann::json{{9, 1, 0}, {2, 3, 5}}));
    EXPECT_EQ(values["right"], (nlohmann::json{{0, 0}, {1, 1}}));
}

TEST(ScoreFigures, power_is_a_fraction_with_an_interval_and_omits_empty_bins) {
    const auto values = figures_of({{20, {&adhesion, nothing, 0.5}}, {20, {&adhesion, right, 2}}})["power"];
    EXPECT_EQ(values["measured"]["x"], (nlohmann::json{0.5, 2.0}));
    EXPECT_EQ(values["measured"]["part"], (nlohmann::json{0.0, 1.0}));
    EXPECT_NEAR(values["measured"]["interval"][0][1].get<double>(), 0.161, 5e-4);
    EXPECT_EQ(values["measured"]["cases"], (nlohmann::json{20, 20}));
    EXPECT_DOUBLE_EQ(values["predicted"]["part"][50].get<double>(),
                     ideal_power(0.05, values["predicted"]["x"][50].get<double>()));
}

TEST(ScoreFigures, confidence_is_the_success_rate_over_the_stated_one) {
    const Answer refused{Verdict::unknown_effect, {"adhesion"}, 0.1};
    const auto values = figures_of(
        {{15, {&adhesion, right}}, {5, {&no_effect, right}}, {4, {&adhesion, refused}}})["confidence"];
    EXPECT_EQ(values["measured"]["x"], (nlohmann::json{0.1, 0.9}));
    EXPECT_EQ(values["measured"]["part"], (nlohmann::json{1.0, 0.75}));
    EXPECT_NEAR(values["measured"]["interval"][1][0].get<double>(), 0.531, 5e-4);
}

TEST(ScoreFigures, exist_only_with_data) {
    EXPECT_TRUE(figures_of({}).empty());
    EXPECT_EQ(figures_of({{1, {&no_effect, nothing}}}).size(), 1u);
}

}  // namespace
}  // namespace mcdem
