#include <gmock/gmock.h>

#include "metrics/synthetic.h"
#include "report/run/run_page.h"

namespace mcdem {
namespace {

TEST(WhatWasSimulated, NamesGrainsContainerProtocolAndCopies) {
    const auto run = synthetic::run({{.model = "independent"}, {.model = "mc_dem"}}, 3);
    EXPECT_EQ(what_was_simulated(group_by_setting(run)),
              "100 grains in a box, compressed by a plate; 2 settings, 3 packings each.");
    const Recording cell = synthetic::cell("mc_dem");
    EXPECT_EQ(
        what_was_simulated({{"mc_dem", {&cell}}}),
        "20 grains in a cell that repeats in all directions, deformed in 3 stages; 1 setting, 1 packing "
        "each.");
}

TEST(MainResult, IsTheForceAtFullStroke) {
    auto run = synthetic::run({{.model = "independent", .top = 6.45}, {.model = "mc_dem"}}, 2);
    EXPECT_EQ(main_result(group_by_setting(run)),
              "Force on the plate at 30.00 mm: Independent contacts 6.45 ± 0.00 N, MC-DEM 15.00 ± 0.00 N.");
    run.recordings[0].failure = Failure{};
    EXPECT_THAT(main_result(group_by_setting(run)), testing::EndsWith(" 1 of 4 replicas stopped early."));
}

TEST(MainResult, OfManySettingsIsTheirRange) {
    const auto run = synthetic::run({{.model = "independent", .top = 5},
                                     {.model = "mc_dem", .top = 9},
                                     {.model = "elastic_sphere", .top = 7},
                                     {.model = "sphere_to_sphere", .top = 3},
                                     {.model = "point_force_on_sphere", .top = 6}},
                                    1);
    EXPECT_EQ(main_result(group_by_setting(run)),
              "Force on the plate at 30.00 mm: from 3.00 N (Sphere to sphere) to 9.00 N (MC-DEM).");
}

TEST(MainResult, OfProgrammesIsTheLargestForceOrStress) {
    const Recording cell = synthetic::cell("mc_dem");
    EXPECT_EQ(main_result({{"mc_dem", {&cell}}}), "Largest mean stress: MC-DEM 5880 Pa at φ = 0.620.");
    Recording held = synthetic::recording({.levels = 2});
    held.parameters["programme.1.stage"] = "\"hold\"";
    EXPECT_EQ(main_result({{"mc_dem", {&held}}}), "Largest force on the plate: MC-DEM 15 N at 30.00 mm.");
}

}  // namespace
}  // namespace mcdem
