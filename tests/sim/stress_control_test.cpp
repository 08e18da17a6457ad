// Prescribed stresses of a cell, along its axes and in shear: they are reached within the tolerance, without
// overshoot, and held, on every path.
#include <fmt/core.h>

#include <cmath>

#include "sim/control_kinds.h"

namespace mcdem::reference::stress_control {
namespace {

const std::string cell_text = R"([container]
shape = "cell"
size_x = 0.09
size_y = 0.09
[packing]
count = 100
packing_fraction = 0.6
[protocol]
rate_tolerance = 0.05
stop_at_scans = true
)";

/// Stages 0 to 2: to a pressure; 3: triaxial; 4: back to the pressure; 5: simple shear at constant pressure.
const std::string paths = R"([[programme]]
pressure = 100
[[programme]]
pressure = 500
[[programme]]
pressure = 150
[[programme]]
stress_x = 150
stress_y = 150
strain_z = 0.12
[[programme]]
pressure = 150
[[programme]]
pressure = 150
shear_xz = 0.05
scans = 2
)";
constexpr double set[] = {100, 500, 150, 150, 150, 150};

/// Seen were deviations of 8 and 10.4 % without friction while strains change, and shear stresses 0.5 and
/// 0.76 % beyond (a fifth of the overshoot is allowed, relative to the pressure). Plastic grains at 500 Pa
/// are ten times as stiff as the controller expects; it passes the stress by 0.15 % until it has noticed.
class StressControl : public testing::TestWithParam<Kind> {};

/// Largest deviations above and below the prescribed stress, over the directions with a prescribed stress.
std::pair<double, double> farthest(const Traced& traced, int leg) {
    double up = -1, down = -1;
    for (const auto& row : traced.rows)
        for (int axis = 0;
             row.leg == leg && row.activity != mcdem::Activity::relax && axis < (leg == 3 ? 2 : 3); ++axis) {
            const double off = row.stress(axis, axis) / set[leg] - 1;
            up = std::max(up, off), down = std::max(down, -off);
        }
    return {up, down};
}

TEST_P(StressControl, ReachesStressesWithoutOvershootAndHoldsThem) {
    double beyond = -1, off = 0;
    for (const char* seed : {"packing.seed=1", "packing.seed=2"}) {
        SCOPED_TRACE(seed);
        const Traced traced = trace(cell_text + paths, GetParam().with(seed));
        EXPECT_EQ(traced.hindrance, "");
        ASSERT_EQ(traced.scans.size(), 7u);
        for (int n = 0; n < 7; ++n) {
            const auto& scan = traced.scans[n];
            const int leg = std::min(n, 5);
            EXPECT_TRUE(scan.tag.settled) << n;
            for (int axis = 0; axis < (leg == 3 ? 2 : 3); ++axis)
                EXPECT_NEAR(scan.stress(axis, axis) / set[leg], 1, 1e-3) << n << ' ' << axis;
            EXPECT_LT((scan.stress - scan.stress.transpose()).cwiseAbs().maxCoeff() / set[leg], 0.01) << n;
        }
        EXPECT_EQ(traced.scans[3].strain[2], 0.12);
        EXPECT_NEAR(traced.scans[5].strain[4], 0.025, 1e-12);
        EXPECT_EQ(traced.scans[6].strain[4], 0.05);
        EXPECT_EQ(traced.scans[0].tag.phase, mcdem::Phase::load);
        EXPECT_EQ(traced.scans[2].tag.phase, mcdem::Phase::unload);
        EXPECT_EQ(traced.scans[3].tag.phase, mcdem::Phase::load);
        EXPECT_EQ(traced.scans[3].tag.cycle, 1);
        beyond = std::max(
            {beyond, farthest(traced, 0).first, farthest(traced, 1).first, farthest(traced, 2).second});
        for (const int leg : {3, 5})
            off = std::max({off, farthest(traced, leg).first, farthest(traced, leg).second});
    }
    EXPECT_LT(beyond, GetParam().stress_beyond);
    EXPECT_LT(off, GetParam().stress_off());
    fmt::print("{}: passes a stress by at most {:.2g} %, keeps it within {:.2g} % while strains change\n",
               GetParam().name, 100 * beyond, 100 * off);
}

/// Stages 0: to a pressure; 1, 2: shear stress at this pressure, there and back; 3: none.
const std::string shears = R"([[programme]]
pressure = 150
[[programme]]
pressure = 150
stress_xz = -15
scans = 2
[[programme]]
pressure = 150
stress_xz = 10
[[programme]]
pressure = 150
stress_xz = 0
)";

double shear_stress(const mcdem::Mat3& stress) { return (stress(0, 2) + stress(2, 0)) / 2; }

TEST_P(StressControl, ReachesShearStressesFromTheSideFromWhichTheyCome) {
    constexpr double pressure = 150, set_shear[] = {0, -15, 10, 0}, sides[] = {0, -1, 1, -1};
    double beyond = -1;
    const Traced traced = trace(cell_text + shears, GetParam().with("packing.seed=1"));
    EXPECT_EQ(traced.hindrance, "");
    ASSERT_EQ(traced.scans.size(), 5u);
    for (int n = 1; n < 5; ++n) {
        const auto& scan = traced.scans[n];
        const int leg = std::max(1, n - 1);
        EXPECT_TRUE(scan.tag.settled) << n;
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(scan.stress(axis, axis) / pressure, 1, 1e-3) << n;
        if (n > 1) {
            EXPECT_NEAR(shear_stress(scan.stress), set_shear[leg], 1e-3 * pressure / 10) << n;
        }
        for (const int k : {3, 5}) EXPECT_EQ(scan.strain[k], 0) << "not part of the move";
    }
    const double half = (shear_stress(traced.scans[0].stress) + set_shear[1]) / 2;
    EXPECT_NEAR(shear_stress(traced.scans[1].stress), half, 1e-3 * pressure / 10);
    EXPECT_GT(traced.scans[2].strain[4], 1e-3) << "a positive shear needs a negative shear stress";
    EXPECT_LT(traced.scans[3].strain[4], traced.scans[2].strain[4] - 1e-3);
    EXPECT_EQ(traced.scans[2].tag.phase, mcdem::Phase::load);
    EXPECT_EQ(traced.scans[4].tag.phase, mcdem::Phase::unload);
    for (const auto& row : traced.rows)
        if (row.leg > 0)
            beyond =
                std::max(beyond, sides[row.leg] * (shear_stress(row.stress) - set_shear[row.leg]) / pressure);
    EXPECT_LT(beyond, GetParam().stress_beyond / 5);
    fmt::print("{}: passes a shear stress by at most {:.2g} % of the pressure\n", GetParam().name,
               100 * beyond);
}

INSTANTIATE_TEST_SUITE_P(Kinds, StressControl, testing::ValuesIn(control_kinds), test_name);

// The stresses of viscoelastic grains are kept constant while the cell creeps.
TEST(StressHold, KeepsTheStressesWhileTheCellCreeps) {
    const Traced traced = trace(cell_text + R"([[programme]]
pressure = 200
[[programme]]
stress_x = 200
stress_y = 200
strain_z = 0.1
[[programme]]
stage = "hold"
keep = "stress"
time = 0.3
scans = 6
)",
                                creeping(0.1));
    ASSERT_EQ(traced.scans.size(), 8u);
    const auto& begin = traced.scans[1];
    for (int n = 2; n < 8; ++n) {
        const auto& scan = traced.scans[n];
        EXPECT_NEAR(scan.tag.time - begin.tag.time, 0.05 * (n - 1), 2e-4) << n;
        EXPECT_NEAR(scan.stress(0, 0) / 200, 1, 2e-3) << n;
        EXPECT_NEAR(scan.stress(1, 1) / 200, 1, 2e-3) << n;
        EXPECT_EQ(scan.strain[2], 0.1);
        EXPECT_LT(scan.stress(2, 2), traced.scans[n - 1].stress(2, 2)) << "relaxes where the strain is kept";
    }
    EXPECT_GT(std::abs(traced.scans[7].strain[0] - begin.strain[0]), 1e-4)
        << "creeps where the stress is kept";
}

// Simple shear under stress, then creep: the shear grows while all four stresses are kept.
TEST(StressHold, KeepsAShearStressWhileTheCellCreeps) {
    const Traced traced = trace(cell_text + R"([[programme]]
pressure = 200
[[programme]]
pressure = 200
stress_xz = -40
[[programme]]
stage = "hold"
keep = "stress"
time = 0.3
scans = 6
)",
                                creeping(0.1));
    ASSERT_EQ(traced.scans.size(), 8u);
    for (int n = 2; n < 8; ++n) {
        const auto& scan = traced.scans[n];
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(scan.stress(axis, axis) / 200, 1, 2e-3) << n;
        EXPECT_NEAR(shear_stress(scan.stress) / -40, 1, 2e-3) << n;
        EXPECT_GT(scan.strain[4], traced.scans[n - 1].strain[4]) << "creeps";
        EXPECT_EQ(scan.strain[3], 0);
    }
}

// A loose packing would be sheared without limit.
TEST(StressControl, ShearWaitsForThePressure) {
    const Traced traced = trace(cell_text + "[[programme]]\npressure = 150\nstress_xz = -20\n",
                                {"grains.friction=0.3", "contact.friction_law=mindlin"});
    ASSERT_EQ(traced.scans.size(), 1u);
    EXPECT_NEAR(shear_stress(traced.scans[0].stress) / -20, 1, 1e-3);
    for (const auto& row : traced.rows)
        if (row.stress.trace() / 3 < 0.95 * 150) {
            EXPECT_EQ(row.strain[4], 0);
        }
}

// The same shear is imposed by its strain: without sliding contacts the stress is the same.
TEST(StressControl, ShearByStressAgreesWithShearByStrain) {
    const std::vector<std::string> elastic{"grains.friction=10", "contact.friction_law=mindlin",
                                           "numerics.precision=double"};
    const std::string pressure = "[[programme]]\npressure = 200\n";
    const Traced by_stress = trace(cell_text + pressure + pressure + "stress_xz = -10\n", elastic);
    ASSERT_EQ(by_stress.scans.size(), 2u);
    const double shear = by_stress.scans[1].strain[4];
    const Traced by_strain =
        trace(cell_text + pressure + pressure + fmt::format("shear_xz = {}\n", shear), elastic);
    ASSERT_EQ(by_strain.scans.size(), 2u);
    EXPECT_NEAR(shear_stress(by_stress.scans[1].stress) / -10, 1, 1e-3);
    EXPECT_NEAR(shear_stress(by_strain.scans[1].stress) / -10, 1, 5e-3);
    fmt::print("shear by strain over shear by stress: {:.5f}\n",
               shear_stress(by_strain.scans[1].stress) / -10);
}

TEST(StressControl, AShearStressBeyondTheStrengthEndsWithItsCause) {
    const Traced yields =
        trace(cell_text +
                  "[[programme]]\npressure = 100\nrate = 1\n[[programme]]\npressure = 100\nstress_yz = 300\n"
                  "rate = 1\n",
              {"protocol.rate_tolerance=0"});
    EXPECT_THAT(
        yields.hindrance,
        testing::HasSubstr("stage 2 of the programme: the shear stress 300 Pa along yz cannot be reached"));
    EXPECT_EQ(yields.scans.size(), 1u);
    EXPECT_EQ(yields.status, 0);
    EXPECT_LT(yields.rows.back().strain[5], -0.5) << "against the stress";
    EXPECT_GE(yields.rows.back().strain[5], -5);
}

TEST(StressControl, UnreachableStressEndsWithItsCause) {
    const Traced loose = trace(cell_text + "[[programme]]\nstress_x = 100\nrate = 1\n",
                               {"packing.packing_fraction=0.3", "protocol.rate_tolerance=0"});
    EXPECT_THAT(
        loose.hindrance,
        testing::AllOf(testing::HasSubstr("stage 1 of the programme: the stress 100 Pa along x cannot "
                                          "be reached: grains would meet their own images"),
                       testing::HasSubstr("or take more grains")));
    EXPECT_TRUE(loose.scans.empty());
}

}  // namespace
}  // namespace mcdem::reference::stress_control
