// Discretisation errors from paired runs: known errors are found, and are separated from chaotic scatter.
#include "diagnose/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace mcdem {
namespace {

constexpr int replicas = 64;

Grid one_place() { return {{0.01}, 0.002, 0.02}; }
Eigen::Index cell_count_of(const Grid& grid) { return static_cast<Eigen::Index>(cells_of(grid).size()); }

/// Replicas with a scatter of their own; each step adds a scatter of `chaos`.
struct Made {
    Eigen::MatrixXd base;
    RefinedRuns refinement{"plate speed", "plate.speed = 0.1 / {0:.2g}", {}, {}};

    /// `left(remaining)`: fraction of the error in the refined run.
    template <class Left>
    Made(const std::vector<double>& remaining, double error, double chaos, Left left) {
        const Grid grid = one_place();
        std::mt19937 engine(7);
        std::normal_distribution<double> normal;
        const auto noise = [&](double sd) -> Eigen::MatrixXd {
            return Eigen::MatrixXd::NullaryExpr(replicas, cell_count_of(grid),
                                                [&] { return sd * normal(engine); });
        };
        const Eigen::MatrixXd packing = noise(0.1);
        base = packing.array() + error;
        refinement.remaining = remaining;
        for (const double part : remaining)
            refinement.observed.push_back((packing + noise(chaos)).array() + error * left(part));
    }
    Convergence result() const { return convergence_of(one_place(), base, {refinement}, {0.005, 0.5}); }
};

double linear(double part) { return part; }

TEST(Convergence, FindsAnErrorOfTheExpectedOrder) {
    const Convergence c = Made({0.5, 0.25, 0.125}, 0.03, 0.01, linear).result();
    int missed = 0;
    for (const CellError& cell : c.causes[0].cells) {
        EXPECT_TRUE(cell.follows_order);
        missed += std::abs(cell.value - 0.03) > 2 * cell.standard_error;
    }
    // Two standard errors are exceeded by chance in 1 of 20 cells.
    EXPECT_LT(missed, 0.15 * static_cast<double>(c.cells.size()));
    EXPECT_GT(missed, 0) << "standard errors are no larger than the scatter";
}

TEST(Convergence, AnErrorOfAnotherOrderIsReportedAsALowerBound) {
    const Convergence c =
        Made({0.5, 0.25, 0.125}, 0.1, 0.005, [](double part) { return part < 0.2 ? 0.2 : 1.0; }).result();
    for (const CellError& cell : c.causes[0].cells) {
        EXPECT_FALSE(cell.follows_order);
        EXPECT_NEAR(cell.value, 0.08, 5 * cell.standard_error);
    }
}

TEST(Convergence, OnlyLargeAndSignificantErrorsExceedALimit) {
    const Convergence small = Made({0.5}, 0.002, 1e-5, linear).result(),
                      large = Made({0.5}, 0.2, 0.001, linear).result(),
                      unsure = Made({0.5}, 0.2, 1.0, linear).result();
    for (std::size_t cell = 0; cell < small.cells.size(); ++cell) {
        EXPECT_FALSE(small.is_beyond(small.causes[0], cell)) << "sure, but within the limit";
        EXPECT_TRUE(large.is_beyond(large.causes[0], cell));
        EXPECT_FALSE(unsure.is_beyond(unsure.causes[0], cell)) << "large, but perhaps by chance";
    }
    EXPECT_EQ(small.worst_beyond(small.causes[0]), -1);
    EXPECT_GE(large.worst_beyond(large.causes[0]), 0);
}

TEST(Convergence, LimitsAreRelativeForForcesAndInStandardDeviationsOtherwise) {
    const Convergence c = Made({0.5}, 0.01, 0.01, linear).result();
    for (std::size_t cell = 0; cell < c.cells.size(); ++cell) {
        const auto& observable = observables()[static_cast<std::size_t>(c.cells[cell].observable)];
        if (observable.name == "top_force" || observable.name == "mean_force")
            EXPECT_EQ(c.limit(cell), 0.005);
        else
            EXPECT_NEAR(c.limit(cell), 0.5 * 0.1, 0.02);
    }
}

// If copies hardly rearrange, their scatter is tiny; the resolution of the observable is then allowed.
TEST(Convergence, ADifferenceBelowTheResolutionIsWithinTheLimit) {
    Made made({0.5}, 1e-4, 0, linear);
    made.base.setConstant(1 + 1e-4);
    made.refinement.observed[0].setConstant(1 + 0.5e-4);
    const Convergence c = made.result();
    for (std::size_t cell = 0; cell < c.cells.size(); ++cell) {
        if (c.is_relative(cell)) continue;
        EXPECT_EQ(c.limit(cell),
                  observables()[static_cast<std::size_t>(c.cells[cell].observable)].resolution);
        EXPECT_FALSE(c.is_beyond(c.causes[0], cell));
    }
}

// A replica that failed in one step is excluded from that cell in all steps.
TEST(Convergence, AFailedReplicaAffectsOnlyItself) {
    Made made({0.5, 0.25}, 0.03, 0.001, linear);
    made.refinement.observed[1].row(3).setConstant(std::nan(""));
    const Convergence c = made.result();
    for (const CellError& cell : c.causes[0].cells) EXPECT_NEAR(cell.value, 0.03, 5 * cell.standard_error);
}

}  // namespace
}  // namespace mcdem
