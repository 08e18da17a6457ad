#include "metrics/top_force.h"

#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

struct Ready {
    explicit Ready(Recording made) : recording(std::move(made)) { levels = group_levels(replicas); }
    Recording recording;
    Replicas replicas{&recording};
    Levels levels;
};

TopForceRatio ratio(const Ready& a, const Ready& b) {
    return top_force_ratio(a.levels, a.replicas, b.levels, b.replicas);
}
LevelError error(const Ready& a, const Ready& b, std::optional<double> touch = std::nullopt) {
    return top_force_error(a.levels, b.levels, match_levels(a.levels, b.levels), {Omission{}}, touch);
}

TEST(Rtop, is_the_ratio_at_maximum_compression) {
    const Ready a(synthetic::recording({.top = 6.45, .hysteresis = 0.3})),
        b(synthetic::recording({.top = 15}));
    EXPECT_NEAR(ratio(a, b).Rtop.value, 0.43, 1e-12);
    EXPECT_NEAR(ratio(a, b).displacement, 30e-3, 1e-12);
}

TEST(Rtop, is_averaged_over_cycles) {
    const Ready b(synthetic::recording({.top = 10}));
    auto two = synthetic::recording({.cycles = 2, .top = 10});
    for (auto& scan : two.scans)
        scan.wall_force[static_cast<int>(Wall::plate)] *= scan.cycle == 0 ? 0.6 : 0.8;
    EXPECT_NEAR(ratio(Ready(two), b).Rtop.value, 0.7, 1e-12);
}

TEST(Rtop, a_turning_point_counts_as_either_phase) {
    auto named_unload = synthetic::recording({.top = 10});
    for (auto& scan : named_unload.scans)
        if (named_unload.displacement(scan) > 29.9e-3) scan.phase = Phase::unload;
    EXPECT_NEAR(ratio(Ready(synthetic::recording({.top = 15})), Ready(named_unload)).Rtop.value, 1.5, 1e-12);
}

TEST(Rtop, a_shorter_simulation_is_compared_at_its_end) {
    const Ready longer(synthetic::recording({.stroke = 30e-3}));
    auto cut = synthetic::recording({.stroke = 30e-3});
    std::erase_if(cut.scans, [&](const Scan& s) { return cut.displacement(s) > 21.1e-3; });
    const auto at_end = ratio(Ready(cut), longer);
    EXPECT_NEAR(at_end.displacement, 21e-3, 1e-12);
    EXPECT_NEAR(at_end.Rtop.value, 1, 1e-12);
    cut.failure = Failure{10, 1, "ran away"};
    EXPECT_FALSE(ratio(Ready(cut), longer).Rtop.available());
}

TEST(Errf, a_constant_difference_is_found) {
    const Ready b(synthetic::recording({}));
    auto raised = synthetic::recording({});
    for (auto& scan : raised.scans)
        scan.wall_force[static_cast<int>(Wall::plate)].z() += scan.phase == Phase::load ? 0.5 : -1.5;
    EXPECT_NEAR(error(Ready(raised), b).by_omission[0], std::sqrt((0.25 + 2.25) / 2), 1e-12);
    EXPECT_EQ(error(Ready(raised), b).levels_used, 20);
}

TEST(Errf, linear_curves_are_interpolated_exactly_over_the_common_range) {
    const auto straight = [](int levels, double slope) {
        auto made = synthetic::recording({.levels = levels});
        for (auto& scan : made.scans)
            scan.wall_force[static_cast<int>(Wall::plate)].z() = slope * made.displacement(scan);
        return Ready(made);
    };
    const auto e = error(straight(7, 300), straight(10, 300));
    EXPECT_NEAR(e.by_omission[0], 0, 1e-12);
    EXPECT_EQ(e.levels_used, 9 + 9);  // loading from 30/7 = 4.3 mm on, unloading up to 30 * 6/7 = 25.7 mm
}

TEST(Errf, can_exclude_levels_before_contact) {
    const Ready a(synthetic::recording({.top = 12})), b(synthetic::recording({.top = 10, .touch = 9.1e-3}));
    EXPECT_EQ(error(a, b).levels_used, 20);
    EXPECT_EQ(error(a, b, 0.0).levels_used, 7 + 6);  // 12 .. 30 mm and 27 .. 12 mm
}

}  // namespace
}  // namespace mcdem
