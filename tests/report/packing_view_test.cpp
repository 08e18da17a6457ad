#include "report/page/packing_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mcdem {
namespace {

using testing::ElementsAre;

/// Grains in a row along y; each touches the next one, the first also the floor.
Recording row_of_grains(int grains, int scans) {
    Recording made;
    made.box = {0.1, 0.2};
    made.plate_start = 0.15;
    made.diameter.assign(static_cast<std::size_t>(grains), 0.0123456);
    for (int s = 0; s < scans; ++s) {
        Scan scan;
        scan.frame = s;
        scan.plate_z = 0.15 - 1e-3 * s;
        for (int g = 0; g < grains; ++g)
            scan.position.push_back({0.05, 0.2 * (g + 0.5) / grains, 0.0617234567});
        scan.contacts.push_back({0, wall_partner(Wall::floor), {0, 0, 0}, {0, 0, 2e-3}, 0});
        for (int g = 0; g + 1 < grains; ++g)
            scan.contacts.push_back({g, g + 1, {0, 0, 0}, {3e-3 * (s + 1), 4e-3 * (s + 1), 0}, 0});
        made.scans.push_back(scan);
    }
    return made;
}

TEST(PackingView, lengths_are_millimetres_and_forces_millinewtons) {
    const auto view = *packing_view({{"mc_dem", row_of_grains(3, 2)}});
    const auto& setting = view["settings"][0];
    EXPECT_EQ(setting["label"], "mc_dem");
    EXPECT_EQ(setting["box_mm"], (Json{100.0, 200.0}));
    EXPECT_EQ(setting["top_mm"], 150.0);
    EXPECT_EQ(setting["diameter_mm"][0], 12.346);
    const auto& scan = setting["scans"][1];
    EXPECT_EQ(scan["plate_mm"], 149.0);
    EXPECT_EQ(scan["displacement_mm"], 1.0);
    EXPECT_EQ(scan["z_mm"], (Json{61.723, 61.723, 61.723}));
    EXPECT_EQ(scan["grain"], (Json{0, 0, 1}));
    EXPECT_EQ(scan["partner"], (Json{wall_partner(Wall::floor), 1, 2}));
    EXPECT_EQ(scan["force_mN"], (Json{2.0, 10.0, 10.0}));
    EXPECT_EQ(scan["title"], "scan 1: 1.00 mm, loading, cycle 1, top force 0 N");
    EXPECT_EQ(view["force_mN"], 10.0);
    EXPECT_EQ(view["load_mN"], 20.0);
}

TEST(PackingView, grains_of_a_periodic_container_are_wrapped_into_it) {
    auto moved = row_of_grains(3, 1);
    EXPECT_EQ((*packing_view({{"box", moved}}))["settings"][0]["container"], "box");
    moved.box.shape = ContainerShape::periodic;
    moved.scans[0].position[1] += Vec3(0.1, -0.4, 0);
    const auto view = *packing_view({{"mc_dem", moved}});
    const auto& setting = view["settings"][0];
    EXPECT_EQ(setting["container"], "periodic");
    EXPECT_EQ(setting["scans"][0]["x_mm"], (Json{50.0, 50.0, 50.0}));
    EXPECT_EQ(setting["scans"][0]["y_mm"], (Json{33.333, 100.0, 166.67}));
}

TEST(PackingView, opens_at_the_scan_with_the_largest_load) {
    auto made = row_of_grains(3, 4);
    EXPECT_EQ((*packing_view({{"unloaded", made}}))["settings"][0]["strongest"], 0);
    made.scans[2].wall_force[static_cast<int>(Wall::plate)] = {0, 0, 3};
    EXPECT_EQ((*packing_view({{"loaded", made}}))["settings"][0]["strongest"], 2);
    made.scans[0].position.clear();  // a scan that is not shown is ignored
    EXPECT_EQ((*packing_view({{"loaded", made}}))["settings"][0]["strongest"], 1);
}

TEST(PackingView, of_a_cell_contains_strains_and_mean_stress) {
    auto made = row_of_grains(3, 1);
    made.box = {0.1, 0.2, ContainerShape::cell, 0.1};
    made.scans[0].strain = {0.1, 0, 0, 0, 0, 0};
    made.scans[0].packing_fraction = 0.65;
    made.scans[0].stress = 20e3 * Mat3::Identity();
    EXPECT_EQ((*packing_view({{"cell", made}}))["settings"][0]["scans"][0]["title"],
              "scan 0: volume strain 10.00 %, deviatoric strain 7.02 %, φ 0.650, p 20 kPa");
}

TEST(PackingView, requires_positions) {
    auto bare = row_of_grains(3, 2);
    for (auto& scan : bare.scans) scan.position.clear();
    EXPECT_FALSE(packing_view({{"mc_dem", bare}}));
    const auto view = *packing_view({{"bare", bare}, {"whole", row_of_grains(3, 1)}});
    ASSERT_EQ(view["settings"].size(), 1u);
    EXPECT_EQ(view["settings"][0]["label"], "whole");
}

TEST(PackingView, of_large_packings_contains_the_grains_nearest_to_the_middle_plane) {
    PackingLimits limits;
    limits.max_grains = 4;
    const auto view = *packing_view({{"large", row_of_grains(100, 1)}}, limits);
    const auto& setting = view["settings"][0];
    EXPECT_EQ(setting["number"], (Json{48, 49, 50, 51}));
    const auto& scan = setting["scans"][0];
    EXPECT_EQ(scan["y_mm"], (Json{97.0, 99.0, 101.0, 103.0}));
    EXPECT_EQ(scan["grain"], (Json{0, 1, 2}));  // contacts between them
    EXPECT_EQ(scan["partner"], (Json{1, 2, 3}));
}

/// This number of scans, down to scan `lowest` and back up.
Recording stroke(std::size_t scans, std::size_t lowest) {
    Recording made;
    for (std::size_t s = 0; s < scans; ++s) {
        Scan scan;
        scan.plate_z = std::abs(static_cast<double>(s) - static_cast<double>(lowest));
        scan.wall_force[static_cast<int>(Wall::plate)] = {0, 0, 100 - scan.plate_z};
        made.scans.push_back(scan);
    }
    return made;
}

TEST(ScansShown, are_all_or_evenly_spaced_including_both_ends) {
    EXPECT_THAT(scans_shown(stroke(4, 2), 1000), ElementsAre(0, 1, 2, 3));
    PackingLimits limits;
    limits.scans = 3;
    EXPECT_THAT(scans_shown(stroke(61, 60), 1000, limits), ElementsAre(0, 30, 60));
    limits.scans = 1;
    EXPECT_THAT(scans_shown(stroke(61, 30), 1000, limits), ElementsAre(30));
    EXPECT_TRUE(scans_shown(stroke(0, 0), 1000).empty());
    EXPECT_EQ(scans_shown(stroke(61, 30), 60'000).size(), 10u);  // as many as fit
    EXPECT_THAT(scans_shown(stroke(61, 30), 10'000'000),
                ElementsAre(0, 30, 60));  // these are always included
}

TEST(ScansShown, include_the_one_with_the_largest_load) {
    PackingLimits limits;
    limits.scans = 5;
    EXPECT_THAT(scans_shown(stroke(61, 28), 1000, limits), ElementsAre(0, 15, 28, 45, 60));
    EXPECT_THAT(scans_shown(stroke(61, 0), 1000, limits), ElementsAre(0, 15, 30, 45, 60));
}

}  // namespace
}  // namespace mcdem
