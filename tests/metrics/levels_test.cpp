#include "metrics/levels.h"

#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

using synthetic::Law;

TEST(GroupLevels, one_for_each_phase_and_displacement) {
    const auto recording = synthetic::recording({.cycles = 3, .levels = 4});
    const auto levels = group_levels({&recording});
    ASSERT_EQ(levels.size(), 8u);
    EXPECT_EQ(levels[0].phase, Phase::load);
    EXPECT_NEAR(levels[0].displacement, 7.5e-3, 1e-12);
    EXPECT_NEAR(levels[3].displacement, 30e-3, 1e-12);
    EXPECT_EQ(levels[4].phase, Phase::unload);
    EXPECT_NEAR(levels[4].displacement, 0, 1e-12);
    for (const auto& level : levels) EXPECT_EQ(level.scans[0].size(), 3u);
}

TEST(GroupLevels, discards_first_cycles_by_the_key_of_the_recording) {
    auto recording = synthetic::recording({.cycles = 4, .levels = 2});
    recording.parameters["protocol.discard"] = "3";
    EXPECT_EQ(group_levels({&recording})[0].scans[0].size(), 1u);
    EXPECT_EQ(group_levels({&recording})[0].scans[0][0]->cycle, 3);
    recording.parameters["protocol.discard"] = "1";
    EXPECT_EQ(group_levels({&recording})[0].scans[0].size(), 3u);
    recording.parameters["protocol.discard"] = "4";
    EXPECT_TRUE(group_levels({&recording}).empty());
}

TEST(GroupLevels, displacements_within_the_tolerance_are_one_level) {
    auto recording = synthetic::recording({.cycles = 2, .levels = 3});
    const auto move_apart = [&](double way) {
        for (auto& scan : recording.scans) scan.plate_z += scan.cycle == 0 ? way : -way;
    };
    move_apart(0.04e-3);
    EXPECT_EQ(group_levels({&recording}).size(), 6u);
    EXPECT_NEAR(group_levels({&recording})[0].displacement, 10e-3, 1e-9);
    move_apart(0.02e-3);
    EXPECT_EQ(group_levels({&recording}).size(), 12u);
}

TEST(GroupLevels, scans_recorded_during_motion_keep_their_own_levels) {
    const auto recording = synthetic::recording({.cycles = 2, .levels = 1000});  // 0.03 mm apart
    EXPECT_EQ(group_levels({&recording}).size(), 2000u);
}

TEST(GroupLevels, a_scan_without_a_plate_position_is_excluded) {
    auto recording = synthetic::recording({.levels = 2});
    recording.scans[0].plate_z = not_available;
    EXPECT_EQ(group_levels({&recording}).size(), 3u);
}

TEST(LevelMeans, cycles_are_averaged_first_and_replicas_give_the_error) {
    auto a = synthetic::recording({.cycles = 2, .levels = 1}), b = a;
    const auto set = [](Recording& r, int scan, double force) {
        r.scans[scan].wall_force[static_cast<int>(Wall::plate)].z() = force;
    };
    set(a, 0, 1), set(a, 2, 3);  // loading scans of both cycles
    set(b, 0, 4), set(b, 2, 8);
    const auto means = level_means(group_levels({&a, &b}), top_force);
    EXPECT_DOUBLE_EQ(means[0].mean.value, 4);
    EXPECT_DOUBLE_EQ(means[0].mean.standard_error, 2);  // of 2 and 6
}

TEST(LevelMeans, a_replica_that_stopped_counts_up_to_its_last_level) {
    auto a = synthetic::recording({.levels = 2}), b = a;
    b.scans.resize(1);
    b.failure = Failure{100, 3, "overlap past the limit"};
    const auto means = level_means(group_levels({&a, &b}), top_force);
    EXPECT_EQ(means[0].mean.count, 2);
    EXPECT_EQ(means[1].mean.count, 1);
    EXPECT_DOUBLE_EQ(means[1].mean.value, 15);
}

TEST(MatchLevels, finds_levels_within_the_tolerance) {
    const auto recording = synthetic::recording({.levels = 4});
    auto shifted = recording;
    for (auto& scan : shifted.scans) scan.plate_z -= 0.09e-3;
    const auto matches = match_levels(group_levels({&shifted}), group_levels({&recording}));
    for (std::size_t i = 0; i < matches.size(); ++i) {
        EXPECT_EQ(matches[i].below, static_cast<int>(i));
        EXPECT_EQ(matches[i].above, static_cast<int>(i));
    }
}

TEST(MatchLevels, dense_levels_are_interpolated_not_rounded) {
    const auto dense = synthetic::recording({.levels = 1000}), wanted = synthetic::recording({.levels = 7});
    const auto levels = group_levels({&dense});
    const auto displacement = [&](const Scan& scan) { return dense.displacement(scan); };
    const auto at =
        at_reference(by_replica(levels, displacement), match_levels(levels, group_levels({&wanted})));
    for (int l = 0; l < 7; ++l) EXPECT_NEAR(at(0, l), 30e-3 * (l + 1) / 7, 1e-9);
}

TEST(MatchLevels, interpolates_linearly_within_a_phase_and_never_beyond) {
    const auto coarse = synthetic::recording({.levels = 2}), fine = synthetic::recording({.levels = 4});
    const auto levels = group_levels({&coarse}), wanted = group_levels({&fine});
    const auto matches = match_levels(levels, wanted);
    const auto displacement = [&](Phase phase) {
        return [phase, start = fine.plate_start](const Scan& scan) {
            return scan.phase == phase ? start - scan.plate_z : not_available;
        };
    };
    EXPECT_FALSE(matches[0].found());  // 7.5 mm while loading: the first simulated level is 15 mm
    const auto load = at_reference(by_replica(levels, displacement(Phase::load)), matches);
    EXPECT_NEAR(load(0, 2), 22.5e-3, 1e-12);
    EXPECT_NEAR(load(0, 3), 30e-3, 1e-12);
    const auto unload = at_reference(by_replica(levels, displacement(Phase::unload)), matches);
    EXPECT_NEAR(unload(0, 5), 7.5e-3, 1e-12);
    EXPECT_FALSE(matches[7].found());  // 22.5 mm while unloading: the last simulated level is 15 mm
}

}  // namespace
}  // namespace mcdem
