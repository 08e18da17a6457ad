// Prescribed forces: they are reached within the tolerance, without overshoot, and held. A force that cannot
// be reached ends the replica.
#include <fmt/core.h>

#include <cmath>

#include "sim/control_kinds.h"

namespace mcdem::reference {
namespace {

const std::string packing_text = R"([box]
size_x = 0.08
size_y = 0.08
[packing]
count = 60
packing_fraction = 0.55
[plate]
start = 0.09
end = 0.05
[protocol]
rate_tolerance = 0.02
stop_at_scans = true
)";
const std::string loads =
    "[[programme]]\nforce = 0.2\n[[programme]]\nforce = 1\n[[programme]]\nforce = 0.3\n";
constexpr double set[] = {0.2, 1, 0.3};

class ForceControl : public testing::TestWithParam<Kind> {};

/// Largest relative overshoot of a leg's force in any interval.
double beyond(const Traced& traced, int leg) {
    double farthest = -1;
    for (const auto& row : traced.rows)
        if (row.leg == leg && row.activity != mcdem::Activity::relax)
            farthest = std::max(farthest, (leg == 2 ? -1 : 1) * (row.force / set[leg] - 1));
    return farthest;
}

TEST_P(ForceControl, ReachesTheForceWithoutOvershoot) {
    double farthest = -1;
    for (const char* seed : {"packing.seed=1", "packing.seed=2", "packing.seed=3"}) {
        SCOPED_TRACE(seed);
        const Traced traced = trace(packing_text + loads, GetParam().with(seed, true));
        EXPECT_EQ(traced.hindrance, "");
        ASSERT_EQ(traced.scans.size(), 3u);
        for (int leg = 0; leg < 3; ++leg) {
            EXPECT_NEAR(traced.scans[leg].force / set[leg], 1, 1e-3) << leg;
            EXPECT_TRUE(traced.scans[leg].tag.settled) << leg;
            farthest = std::max(farthest, beyond(traced, leg));
        }
    }
    EXPECT_LT(farthest, GetParam().force_beyond());
    fmt::print("{}: passes a force by at most {:.2g} % of it\n", GetParam().name, 100 * farthest);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ForceControl, testing::ValuesIn(control_kinds), test_name);

// Viscoelastic grains relax; the plate follows to keep the force constant.
TEST(ForceHold, KeepsTheForceWhileThePackingCreeps) {
    const Traced traced = trace(packing_text +
                                    "[[programme]]\nforce = 1\n[[programme]]\nstage = \"hold\"\nkeep = "
                                    "\"force\"\ntime = 0.3\nscans = 6\n",
                                creeping(0.1));
    ASSERT_EQ(traced.scans.size(), 7u);
    for (const auto& scan : traced.scans) EXPECT_NEAR(scan.force, 1, 1e-3);
    for (int k = 1; k < 7; ++k)
        EXPECT_NEAR(traced.scans[k].tag.time - traced.scans[0].tag.time, 0.05 * k, 2e-4) << k;
    const auto way = [&](int k) { return traced.scans[k - 1].tag.plate_z - traced.scans[k].tag.plate_z; };
    for (int k = 1; k < 7; ++k) EXPECT_GT(way(k), 0) << k;
    EXPECT_GT(way(1), 2 * way(5)) << "slower and slower";
}

TEST(ForceHold, ForceRelaxesAtConstantPosition) {
    const Traced traced =
        trace(packing_text +
                  "[[programme]]\nstrain = 0.1\n[[programme]]\nstage = \"hold\"\ntime = "
                  "0.3\nscan_at = [0.02, 0.3]\n",
              {"protocol.stop_at_scans=false", "effects.viscoelasticity=0.4", "effects.relaxation_time=0.05",
               "grains.friction=0.3", "contact.friction_law=mindlin"});
    ASSERT_EQ(traced.scans.size(), 3u);
    for (const auto& scan : traced.scans) EXPECT_NEAR(scan.tag.plate_z, 0.081, 1e-12);
    EXPECT_LT(traced.scans[2].force, 0.95 * traced.scans[1].force);
    EXPECT_NEAR(traced.scans[2].tag.time - traced.scans[0].tag.time, 0.3, 2e-4);
}

// 4/3 E* sqrt(R) (R - z/2)^(3/2) = F on both sides of a grain.
TEST(ForceControl, PositionOfOneGrainAgreesWithHertz) {
    constexpr double force = 0.05, radius = 0.01, youngs_modulus = 23.3e3, poisson = 0.5, wall = 1e13;
    const double modulus = 1 / ((1 - poisson * poisson) * (1 / youngs_modulus + 1 / wall));
    const double overlap = std::pow(force / (4.0 / 3 * modulus * std::sqrt(radius)), 2.0 / 3);
    const Traced traced = trace_one_grain("[[programme]]\nforce = 0.05\n");
    ASSERT_EQ(traced.scans.size(), 1u);
    EXPECT_NEAR(traced.scans[0].tag.plate_z / (2 * (radius - overlap)), 1, 1e-4);
}

TEST(ForceControl, UnreachableForceEndsWithItsCause) {
    const Traced at_end =
        trace(packing_text + "[[programme]]\nforce = 50\n", {"plate.end=0.085", "grains.friction=0.3"});
    EXPECT_THAT(at_end.hindrance, testing::HasSubstr("stage 1 of the programme: the force 50 N cannot be "
                                                     "reached: the plate is at plate.end = 0.085"));
    EXPECT_TRUE(at_end.scans.empty());
    const Traced floating = trace(
        packing_text +
            "[[programme]]\nposition = 0.11\n[[programme]]\nstage = \"hold\"\nkeep = \"force\"\ntime = 1\n",
        {"plate.start=0.11"});
    EXPECT_THAT(
        floating.hindrance,
        testing::HasSubstr("stage 2 of the programme: the force 0 N cannot be reached: no grain presses"));
    EXPECT_EQ(floating.scans.size(), 1u);
    const Traced at_start = trace(packing_text + "[[programme]]\nforce = 1e-9\n",
                                  {"packing.packing_fraction=0.6", "plate.start=0.083"});
    EXPECT_THAT(at_start.hindrance, testing::HasSubstr("the plate is at plate.start = 0.083"));
}

}  // namespace
}  // namespace mcdem::reference
