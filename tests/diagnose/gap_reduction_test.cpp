// A planted effect closes its gap on held-out data; without a gap, no effect reduces anything.
#include "diagnose/infer/gap_reduction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem::gap_reduction {
namespace {

constexpr int replicates = 32;

struct Case {
    explicit Case(double amplitude, std::uint64_t seed = 1)
        : world(6, seed), evidence(make(amplitude)), data(gap_data(evidence)) {}
    Evidence make(double amplitude) {
        Evidence e = world.evidence(1, replicates);
        world.add_effect(e, "adhesion", world.pattern(1));
        world.add_effect(e, "friction", world.pattern(1));
        world.add_nuisance(e, "modulus", world.pattern(0.5), 1);
        e.observed += amplitude * e.library.effects[0].linear;
        return e;
    }
    GapReduction gap_reduction(std::vector<std::size_t> candidates) const {
        Proposal p;
        p.candidates = std::move(candidates);
        return measure_reduction(data, split, p, replicates, 1);
    }

    SyntheticWorld world;
    Evidence evidence;
    GapData data;
    Split split = split_cells(data.cells, synthetic_grid);
};

TEST(Split, FitsTheFirstPartOfLoading) {
    const Case c(0);
    ASSERT_EQ(c.split.fitted.size() + c.split.held_out.size(), 48u);
    EXPECT_EQ(c.split.fitted.size(), 6 * 3u);  // three of four displacements are below 85 % of the stroke
    const auto cells = cells_of(synthetic_grid);
    for (const auto cell : c.split.fitted) {
        EXPECT_EQ(cells[static_cast<std::size_t>(cell)].phase, Phase::load);
        EXPECT_LT(cells[static_cast<std::size_t>(cell)].displacement, 0.85 * synthetic_grid.stroke);
    }
}

TEST(GapSize, OfNoiseIsZeroOnAverage) {
    Case c(0);
    double mean = 0, twice = 0;
    constexpr int draws = 2000;
    for (int k = 0; k < draws; ++k) {
        const Eigen::VectorXd gap = c.world.noise() - c.world.noise();
        mean += gap_size(c.data, c.split.held_out, gap, 1) / draws;
        twice += gap_size(c.data, c.split.held_out, gap + c.world.noise(), 1, 1) / draws;
    }
    // Thirty cells with a scatter of 2 sqrt 2: 0.4 over 2000 draws; variances from 32 replicates have an
    // error of 0.25 per cell.
    EXPECT_NEAR(mean, 0, 5);
    EXPECT_NEAR(twice, 0, 8);
}

TEST(GapSize, OfAGapIsItsSquareInSigmas) {
    Case c(0);
    double mean = 0;
    constexpr int draws = 500;
    const Eigen::VectorXd there = 3 * c.evidence.library.effects[0].linear;
    for (int k = 0; k < draws; ++k)
        mean += (gap_size(c.data, c.split.held_out, there + c.world.noise(), 0) -
                 gap_size(c.data, c.split.held_out, c.world.noise(), 0)) /
                draws;
    double expected = 0;
    for (const auto cell : c.split.held_out)
        expected += there[cell] * there[cell] * replicates / c.data.noise.col(cell).squaredNorm();
    EXPECT_NEAR(mean, expected, 0.03 * expected);
}

TEST(GapReduction, APlantedEffectClosesItsGap) {
    const Case c(4);
    const GapReduction s = c.gap_reduction({0});
    EXPECT_GT(s.fraction, 0.9);
    EXPECT_LE(s.fraction, 1);
    EXPECT_NEAR(s.fraction, std::min(1.0, 1 - s.after / s.before), 1e-12);
    EXPECT_LE(s.interval[0], s.fraction);
    EXPECT_GE(s.interval[1], s.fraction);
    EXPECT_GT(s.interval[0], 0.75);
    EXPECT_EQ(held_out_reduction(c.data, c.split, {0}, replicates), s.fraction);
    const double placebo = held_out_placebo(c.data, c.split, replicates, 1);
    EXPECT_LT(placebo, 0.5);
    EXPECT_GE(placebo, 0);
    EXPECT_TRUE(held_out_gap(c.data, c.split, replicates).shows());
}

TEST(GapReduction, WithoutAGapHeldOutDataShowNone) {
    int shown = 0;
    for (std::uint64_t seed = 50; seed < 90; ++seed) {
        const Case c(0, seed);
        shown += held_out_gap(c.data, c.split, replicates).shows();
    }
    EXPECT_LE(shown, 8) << "beyond two sigmas of a skewed distribution";
}

// Runs that agree with the data close the gap, whatever the signature predicts; failed runs do not count.
TEST(GapReduction, ConfirmationRunsReplaceThePrediction) {
    Case c(4);
    const Eigen::VectorXd centre = c.evidence.baseline.colwise().mean().transpose();
    Eigen::MatrixXd runs(9, centre.size());
    const auto make = [&](double amplitude) {
        for (Eigen::Index r = 0; r < runs.rows(); ++r)
            runs.row(r) =
                (centre + amplitude * c.evidence.library.effects[0].linear + c.world.noise()).transpose();
        runs.row(3).setConstant(not_available);
        return reduction_by_runs(c.data, c.split, c.evidence.observed, runs, replicates);
    };
    EXPECT_GT(make(4).value(), 0.9);
    EXPECT_NEAR(make(2).value(), 0.75, 0.15);
    EXPECT_NEAR(make(0).value(), 0, 0.15);
    runs.setConstant(not_available);
    EXPECT_FALSE(reduction_by_runs(c.data, c.split, c.evidence.observed, runs, replicates));
}

// The signature has half of the effect's true size: the amplitude is corrected by a second fit with runs.
TEST(GapReduction, RunsCorrectTheAmplitude) {
    Case c(4);
    const Eigen::VectorXd shape = c.evidence.library.effects[0].linear;
    c.evidence.library.effects[0].linear *= 0.5;
    const PartialFit first = fit_part(c.data, c.split.fitted, c.data.gap, {0}, replicates);
    EXPECT_NEAR(first.amplitudes[0], 8, 2);
    const PartialFit at{{3}, Eigen::VectorXd::Constant(1, 0.4)};
    const Eigen::VectorXd left = c.data.gap - 3 * shape - 0.4 * c.evidence.library.nuisances[0].linear;
    const PartialFit again = refit_part(c.data, c.split.fitted, left, {0}, at, replicates);
    EXPECT_NEAR(again.amplitudes[0], 3 + 2 * 1, 1.5);
    EXPECT_NEAR(again.nuisances[0],
                GapSpace(c.data.noise, replicates, c.split.fitted, {c.data.free[0], {0.5 * shape, 20}})
                    .fit_nuisances(c.data.gap - 3 * shape)[0],
                1e-9);
}

// A gap far beyond the prior: runs are made with a parameter that simulations can have.
TEST(GapReduction, NuisancesOfRunsStayInRange) {
    Case c(4);
    const double farthest = 12 * c.data.free[0].sigma;
    c.data.gap += 1e6 * c.evidence.library.nuisances[0].linear;
    const PartialFit first = fit_part(c.data, c.split.fitted, c.data.gap, {0}, replicates);
    EXPECT_EQ(first.nuisances[0], farthest);
    EXPECT_EQ(refit_part(c.data, c.split.fitted, -c.data.gap, {0}, first, replicates).nuisances[0],
              -farthest);
}

TEST(GapReduction, AnotherEffectDoesNotCloseTheGap) { EXPECT_LT(Case(4).gap_reduction({1}).fraction, 0.3); }

TEST(GapReduction, TwoEffectsAreFittedTogether) {
    Case c(4);
    c.data.gap -= 3 * c.evidence.library.effects[1].linear;
    EXPECT_GT(c.gap_reduction({0, 1}).fraction, 0.9);
    EXPECT_LT(c.gap_reduction({0}).fraction, 0.8);
    const PartialFit fit = fit_part(c.data, c.split.fitted, c.data.gap, {0, 1}, replicates);
    EXPECT_NEAR(fit.amplitudes[0], 4, 1.2);  // 18 correlated cells with noise 1: 0.3 each
    EXPECT_NEAR(fit.amplitudes[1], -3, 1.2);
    EXPECT_EQ(fit.nuisances.size(), 1);
}

TEST(GapReduction, OfNoiseIsNotSignificant) {
    int covered = 0;
    constexpr int cases = 20;
    for (int k = 0; k < cases; ++k) {
        const GapReduction s = Case(0, 50 + static_cast<std::uint64_t>(k)).gap_reduction({0});
        covered += s.interval[0] <= 0.1;
    }
    EXPECT_GE(covered, 16);  // a 90 % interval of the fraction, whose true value is zero
}

TEST(GapReduction, IsZeroIfOnePartIsMissing) {
    const Case c(4);
    Proposal p;
    p.candidates = {0};
    const GapReduction s = measure_reduction(c.data, {c.split.fitted, {}}, p, replicates, 1);
    EXPECT_EQ(s.fraction, 0);
    EXPECT_EQ(s.before, 0);
}

}  // namespace
}  // namespace mcdem::gap_reduction
