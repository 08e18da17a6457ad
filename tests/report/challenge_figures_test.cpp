#include "report/challenge_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/draw_figure.h"
#include "report/folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

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

TEST(ConfusionFigure, counts_cases_and_frames_right_answers) {
    const auto figure =
        confusion_figure({{"none", "adhesion"}, {"none", "adhesion", "unknown"}, {{9, 1, 0}, {2, 3, 5}}});
    EXPECT_THAT(figure.data, HasSubstr(",0.9,9,none,none\n"));
    EXPECT_THAT(figure.data, HasSubstr(",0.3,3,adhesion,adhesion\n"));
    EXPECT_THAT(figure.data, HasSubstr(",0.5,5,adhesion,unknown\n"));
    EXPECT_THAT(figure.data, HasSubstr("\n\n\n0,0,-0.47,0.47,-0.43,0.43\n1,-1,0.53,1.47,-1.43,-0.57\n"));
}

TEST(PowerFigure, shows_parts_with_intervals_and_leaves_out_empty_points) {
    const auto figure = power_figure({.points = {{0.5, 0, 20}, {1, 0, 0}, {2, 20, 20}}});
    EXPECT_THAT(figure.data, HasSubstr("\n0.5,0,0,0.161"));
    EXPECT_THAT(figure.data, HasSubstr("\n2,1,0.838"));
    EXPECT_THAT(figure.data, testing::EndsWith("1,20\n"));
    const std::string measured = figure.data.substr(figure.data.find("\n0.5,0,0,0.161"));
    EXPECT_THAT(measured, testing::Not(HasSubstr("\n1,")));
}

TEST(ConfidenceFigure, shows_parts_over_what_was_stated) {
    EXPECT_THAT(confidence_figure({{0.9, 15, 20}, {0.3, 0, 0}}).data, HasSubstr("\n0.9,0.75,0.531"));
}

TEST(ChallengeFigures, can_be_drawn_with_any_names) {
    const TestFolder folder;
    const std::vector<std::string> names{"it's, \"quoted\" %s", "`touch pwned`"};
    for (const auto& figure : {confusion_figure({names, names, {{3, 0}, {1, 2}}}),
                               power_figure({.points = {{1, 3, 4}}}), confidence_figure({{0.5, 1, 2}})})
        EXPECT_EQ(draw_figure(figure, folder.path).size(), 2u);
}

}  // namespace
}  // namespace mcdem
