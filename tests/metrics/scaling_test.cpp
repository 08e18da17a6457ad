#include "metrics/scaling.h"

#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

std::vector<ScalingPoint> points_of(const std::vector<double>& x, double linear, double square) {
    std::vector<ScalingPoint> points;
    for (double product : x) {
        ScalingPoint point;
        point.product.value = product;
        point.top_force.value = linear * product + square * product * product;
        points.push_back(point);
    }
    return points;
}

TEST(Scaling, coefficient_of_the_recording_is_found) {
    // The synthetic averages satisfy F = 150 <Z><phi><b><f> in both phases.
    const auto recording = synthetic::recording({.cycles = 2});
    const auto points = scaling_points(group_levels({&recording}));
    EXPECT_EQ(points.size(), 20u);
    for (Phase phase : {Phase::load, Phase::unload}) {
        const auto fit = fit_scaling(points, phase);
        EXPECT_EQ(fit.points, 10);
        EXPECT_NEAR(fit.coefficient, 150, 1e-9);
        EXPECT_NEAR(fit.r_squared, 1, 1e-12);
        EXPECT_NEAR(fit.curvature, 0, 1e-9);
    }
}

TEST(Scaling, curvature_is_the_quadratic_part_at_full_scale) {
    EXPECT_NEAR(fit_scaling(points_of({1, 2, 3, 4}, 3, 0.25)).curvature, 0.25 * 4 / (3 + 0.25 * 4), 1e-12);
    EXPECT_NEAR(fit_scaling(points_of({1, 2, 3, 4}, 0, 1)).curvature, 1, 1e-12);
    EXPECT_LT(fit_scaling(points_of({1, 2, 3, 4}, 3, -0.25)).curvature, 0);
}

TEST(Scaling, least_squares_through_zero_agrees_with_a_hand_calculation) {
    auto points = points_of({1, 2}, 0, 0);
    points[0].top_force.value = 1;
    points[1].top_force.value = 3;
    const auto fit = fit_scaling(points);
    EXPECT_DOUBLE_EQ(fit.coefficient, 7.0 / 5);
    EXPECT_NEAR(fit.r_squared, 1 - (0.16 + 0.04) / 2, 1e-12);
}

TEST(Scaling, levels_without_measured_averages_are_excluded) {
    auto recording = synthetic::recording({});
    recording.scans[3].packing_fraction = not_available;
    EXPECT_EQ(scaling_points(group_levels({&recording})).size(), 19u);
    EXPECT_EQ(fit_scaling({}).points, 0);
}

}  // namespace
}  // namespace mcdem
