#include "calibrate/local_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mcdem {
namespace {

TEST(RisingFit, pools_decreasing_values) {
    EXPECT_EQ(rising_fit({{0, 1}, {1, 3}, {2, 2}, {3, 5}}), (std::vector<double>{1, 2.5, 2.5, 5}));
    EXPECT_EQ(rising_fit({{0, 3}, {1, 2}, {2, 1}}), (std::vector<double>{2, 2, 2}));
}

TEST(CrossingOfFit, a_line_agrees_with_a_hand_calculation) {
    const auto crossing = crossing_of_fit({{0, 0}, {1, 2}, {2, 4}, {3, 6}}, 0, 3, 3);
    EXPECT_NEAR(crossing.x, 1.5, 1e-12);
    EXPECT_NEAR(crossing.standard_error, 0, 1e-12);
}

TEST(CrossingOfFit, error_at_the_middle_of_a_line_is_known) {
    // Residuals +-1 about y = 2 x: scatter^2 = 4 / 2, variance at the middle scatter^2 / 4, slope 2.
    const auto crossing = crossing_of_fit({{-3, -5}, {-1, -3}, {1, 1}, {3, 7}}, -3, 3, 0);
    EXPECT_NEAR(crossing.x, 0, 1e-12);
    EXPECT_NEAR(crossing.standard_error, std::sqrt(2.0 / 4) / 2, 1e-12);
    EXPECT_NEAR(crossing.slope, 2, 1e-12);
}

TEST(CrossingOfFit, is_exact_for_a_parabola) {
    std::vector<Point> points;
    for (double x : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5}) points.push_back({x, x * x});
    EXPECT_NEAR(crossing_of_fit(points, 0, 2.5, 3).x, std::sqrt(3.0), 1e-12);
}

TEST(CrossingOfFit, is_nan_without_a_crossing) {
    EXPECT_TRUE(std::isnan(crossing_of_fit({{0, 0}, {1, 1}, {2, 2}}, 0, 2, 5).x));  // out of the window
    EXPECT_TRUE(std::isnan(crossing_of_fit({{0, 2}, {1, 1}, {2, 0}}, 0, 2, 1).x));  // decreasing
    EXPECT_TRUE(std::isnan(crossing_of_fit({{0, 0}, {1, 1}}, 5, 6, 1).x));          // no points
    EXPECT_TRUE(std::isnan(crossing_of_fit({{0, 0}, {1, 1}}, 0, 1, 0.5).standard_error));
}

}  // namespace
}  // namespace mcdem
