// A planted difference is located at its cells; replicates without a difference have none.
#include "diagnose/decide/location.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem::location {
namespace {

constexpr int replicates = 32;

struct Case {
    explicit Case(std::uint64_t seed) : world(4, seed), evidence(make()), data(gap_data(evidence)) {}
    Evidence make() {
        Evidence e = world.evidence(1, replicates);
        world.add_nuisance(e, "modulus", world.pattern(0.5), 1);
        return e;
    }
    Location locate_gap(const Eigen::VectorXd& gap) const {
        Limits limits;
        limits.false_alarm = 0.05;
        return locate(space, data, null, gap, synthetic_grid, limits);
    }

    SyntheticWorld world;
    Evidence evidence;
    GapData data;
    GapSpace space{data.noise, replicates, data.cells, data.free};
    NullDistribution null{data, replicates, 1};
};

/// Observable of the library: the third, unloading, second and third displacement.
constexpr Eigen::Index planted = 8 * 2 + 4 + 1;

TEST(Location, FindsPlantedCellsAndTheirRange) {
    const Case c(1);
    Eigen::VectorXd gap = Eigen::VectorXd::Constant(c.data.mean.size(), not_available);
    gap.head(c.world.known()).setZero();
    gap[planted] = 8;
    gap[planted + 1] = 10;
    const Location found = c.locate_gap(gap);
    ASSERT_EQ(found.entries.size(), 1u);
    const WhereEntry& entry = found.entries[0];
    EXPECT_EQ(entry.observable, observables()[2].name);
    EXPECT_EQ(entry.phase, "unload");
    EXPECT_EQ(entry.region, std::string(observables()[2].region));
    EXPECT_FALSE(entry.force_class);
    const double half = 0.5 * (synthetic_grid.displacement[1] - synthetic_grid.displacement[0]);
    EXPECT_NEAR(entry.displacement[0], synthetic_grid.displacement[1] - half, 1e-12);
    EXPECT_NEAR(entry.displacement[1], synthetic_grid.displacement[2] + half, 1e-12);
    EXPECT_NEAR(entry.z_score, 10 / c.space.sigma()[planted + 1], 1e-9);
    const double shift = c.space.fit_nuisances(gap)[0];
    EXPECT_NEAR(
        entry.z_score_refitted,
        (10 - shift * c.evidence.library.nuisances[0].linear[planted + 1]) / c.space.sigma()[planted + 1],
        1e-9);
}

TEST(Location, RangesDoNotExceedTheStroke) {
    const Case c(1);
    Eigen::VectorXd gap = Eigen::VectorXd::Zero(c.data.mean.size());
    gap[3] = -9;
    const Location found = c.locate_gap(gap);
    ASSERT_EQ(found.entries.size(), 1u);
    EXPECT_EQ(found.entries[0].displacement[1], synthetic_grid.stroke);
    EXPECT_LT(found.entries[0].z_score, 0);
}

TEST(Location, LargestIsFirst) {
    const Case c(1);
    Eigen::VectorXd gap = Eigen::VectorXd::Zero(c.data.mean.size());
    gap[0] = 8;
    gap[8] = -12;
    gap[2] = 9;  // not adjacent to the first: the cell between them has no difference
    const Location found = c.locate_gap(gap);
    ASSERT_EQ(found.entries.size(), 3u);
    EXPECT_EQ(found.entries[0].observable, observables()[1].name);
    for (std::size_t k = 1; k < 3; ++k)
        EXPECT_GT(std::abs(found.entries[k - 1].z_score_refitted),
                  std::abs(found.entries[k].z_score_refitted));
}

TEST(Location, AllCellsAreListed) {
    const Case c(1);
    const Location found = c.locate_gap(c.data.gap);
    ASSERT_EQ(found.cells.size(), 32u);
    EXPECT_EQ(found.cells[planted].observable, observables()[2].name);
    EXPECT_EQ(found.cells[planted].phase, "unload");
    EXPECT_EQ(found.cells[planted].displacement, synthetic_grid.displacement[1]);
    EXPECT_NEAR(found.cells[planted].z_score, c.data.gap[planted] / c.space.sigma()[planted], 1e-12);
}

TEST(Location, ReplicatesHaveNoSignificantCells) {
    int alarms = 0;
    constexpr int draws = 200;
    for (int k = 0; k < draws; ++k) {
        Case c(static_cast<std::uint64_t>(k) + 10);
        c.data.gap += c.world.random().normal() * c.evidence.library.nuisances[0].linear;
        alarms += !c.locate_gap(c.data.gap).entries.empty();
    }
    EXPECT_LE(alarms, 0.12 * draws);  // 5 % +- 1.5 %, and as much again for thresholds from 32 replicates
    EXPECT_GE(alarms, 1);
}

}  // namespace
}  // namespace mcdem::location
