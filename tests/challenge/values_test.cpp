#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "challenge/figure_values.h"

namespace mcdem {
namespace {

TEST(WilsonInterval, is_that_of_newcombe_1998) {
    // Newcombe, Statistics in Medicine 17 (1998) 857, Table I, method 3: to its four decimals
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
}

TEST(IdealPower, goes_through_what_was_stated) {
    const PowerCurve curve{.points = {}, .false_alarm = 0.05, .power_at_limit = 0.8};
    EXPECT_NEAR(ideal_power(curve, 0), 0.05, 1e-12);
    EXPECT_NEAR(ideal_power(curve, 1), 0.8, 1e-5);  // the other sign adds 1e-6
    // half of the cases at 1.96 sigma, the limit being 1.960 + 0.8416 sigma
    EXPECT_NEAR(ideal_power(curve, 1.95996 / (1.95996 + 0.84162)), 0.5, 1e-4);
    EXPECT_GT(ideal_power(curve, 2), 0.999);
}

TEST(ConfusionValues, count_cases_and_mark_right_answers) {
    const auto values = confusion_values(
        {{"no_gap", "adhesion"}, {"no_gap", "adhesion", "unknown_effect"}, {{9, 1, 0}, {2, 3, 5}}});
    EXPECT_EQ(values["truths"], (nlohmann::json{"no gap", "adhesion"}));
    EXPECT_EQ(values["cases"][1][2], 5);
    EXPECT_EQ(values["right"], (nlohmann::json{{0, 0}, {1, 1}}));
}

TEST(PowerValues, are_parts_with_intervals_and_leave_out_empty_points) {
    const PowerCurve curve{.points = {{0.5, 0, 20}, {1, 0, 0}, {2, 20, 20}}};
    const auto values = power_values(curve);
    EXPECT_EQ(values["measured"]["x"], (nlohmann::json{0.5, 2.0}));
    EXPECT_EQ(values["measured"]["part"], (nlohmann::json{0.0, 1.0}));
    EXPECT_NEAR(values["measured"]["interval"][0][1].get<double>(), 0.161, 5e-4);
    EXPECT_EQ(values["measured"]["cases"], (nlohmann::json{20, 20}));
    EXPECT_DOUBLE_EQ(values["predicted"]["part"][50].get<double>(),
                     ideal_power(curve, values["predicted"]["x"][50].get<double>()));
}

TEST(ConfidenceValues, are_parts_over_what_was_stated) {
    const auto values = confidence_values({{0.9, 15, 20}, {0.3, 0, 0}});
    EXPECT_EQ(values["measured"]["x"], (nlohmann::json{0.9}));
    EXPECT_EQ(values["measured"]["part"], (nlohmann::json{0.75}));
    EXPECT_NEAR(values["measured"]["interval"][0][0].get<double>(), 0.531, 5e-4);
}

}  // namespace
}  // namespace mcdem
