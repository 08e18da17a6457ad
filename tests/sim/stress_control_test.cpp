// Prescribed stresses of a cell: they are reached within the tolerance, without overshoot, and held, on
// every path.
#include <fmt/core.h>

#include <cmath>

#include "sim/traced_programme.h"

namespace reference {
namespace {

using Stage = mcdem::ProtocolState::Stage;

const std::string cell_text = R"([container]
shape = "cell"
size_x = 0.09
size_y = 0.09
[packing]
count = 100
packing_fraction = 0.6
[protocol]
rate_tolerance = 0.05
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

/// Largest overshoot of a stress in any interval, and largest deviation from it while strains change,
/// relative. Packings without friction rearrange suddenly.
struct Kind {
    const char* name;
    std::vector<std::string> overrides;
    double beyond, off;
};

const Kind kinds[] = {
    {"independent", {"contact.model=independent", "grains.friction=0"}, 0.05, 0.1},
    {"mc_dem", {"grains.friction=0"}, 0.05, 0.1},
    {"friction",
     {"contact.model=independent", "grains.friction=0.3", "contact.friction_law=mindlin"},
     1e-3,
     0.01},
    {"mc_dem, friction", {"grains.friction=0.3", "contact.friction_law=mindlin"}, 1e-3, 0.01},
    {"elastic_sphere",
     {"contact.model=elastic_sphere", "grains.friction=0.3", "contact.friction_law=mindlin"},
     1e-3,
     0.01},
    {"viscoelastic",
     {"effects.viscoelasticity=0.4", "effects.relaxation_time=0.05", "grains.friction=0.3",
      "contact.friction_law=mindlin"},
     1e-3,
     0.01},
    {"plastic",
     {"effects.plasticity=0.3", "grains.friction=0.3", "contact.friction_law=mindlin"},
     1e-3,
     0.01},
};

class StressControl : public testing::TestWithParam<Kind> {};

/// Largest deviations above and below the prescribed stress, over the directions with a prescribed stress.
std::pair<double, double> farthest(const Traced& traced, int leg) {
    double up = -1, down = -1;
    for (const auto& row : traced.rows)
        for (int axis = 0; row.leg == leg && row.stage != Stage::relax && axis < (leg == 3 ? 2 : 3); ++axis) {
            const double off = row.stress(axis, axis) / set[leg] - 1;
            up = std::max(up, off), down = std::max(down, -off);
        }
    return {up, down};
}

TEST_P(StressControl, ReachesStressesWithoutOvershootAndHoldsThem) {
    double beyond = -1, off = 0;
    for (const char* seed : {"packing.seed=1", "packing.seed=2"}) {
        SCOPED_TRACE(seed);
        auto overrides = GetParam().overrides;
        overrides.push_back(seed);
        const Traced traced = trace(cell_text + paths, overrides);
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
    EXPECT_LT(beyond, GetParam().beyond);
    EXPECT_LT(off, GetParam().off);
    fmt::print("{}: passes a stress by at most {:.2g} %, keeps it within {:.2g} % while strains change\n",
               GetParam().name, 100 * beyond, 100 * off);
}

INSTANTIATE_TEST_SUITE_P(Kinds, StressControl, testing::ValuesIn(kinds), [](const auto& kind) {
    std::string name = kind.param.name;
    std::erase_if(name, [](char c) { return c == ',' || c == ' '; });
    return name;
});

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
                                {"effects.viscoelasticity=0.4", "effects.relaxation_time=0.1",
                                 "grains.friction=0.3", "contact.friction_law=mindlin"});
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

TEST(StressControl, UnreachableStressEndsWithItsCause) {
    const Traced loose = trace(cell_text + "[[programme]]\nstress_x = 100\nrate = 1\n",
                               {"packing.packing_fraction=0.3", "protocol.rate_tolerance=0"});
    EXPECT_NE(
        loose.hindrance.find("stage 1 of the programme: the stress 100 Pa along x cannot be reached: grains "
                             "would meet their own images"),
        std::string::npos)
        << loose.hindrance;
    EXPECT_NE(loose.hindrance.find("or take more grains"), std::string::npos) << loose.hindrance;
    EXPECT_TRUE(loose.scans.empty());
}

}  // namespace
}  // namespace reference
