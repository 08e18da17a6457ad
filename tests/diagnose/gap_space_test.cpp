// Covariances, whitening and fitted nuisances, compared with explicit formulas.
#include "diagnose/infer/gap_space.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

Eigen::MatrixXd noise_rows(int rows, int observables, std::uint64_t seed) {
    SyntheticWorld world(observables, seed);
    Eigen::MatrixXd all(rows, world.noise().size());
    for (int r = 0; r < rows; ++r) all.row(r) = world.noise(1 + r % 2 * 0.5).transpose();
    return all;
}

CellChoice first_cells(Eigen::Index number) {
    CellChoice cells;
    for (Eigen::Index cell = 0; cell < number; ++cell) cells.push_back(cell);
    return cells;
}

/// Ledoit & Wolf 2004, as sums over rows and pairs of cells, for standardised columns.
Eigen::MatrixXd by_double_loop(const Eigen::MatrixXd& x) {
    const Eigen::Index n = x.rows(), p = x.cols();
    Eigen::VectorXd sigma(p);
    for (Eigen::Index i = 0; i < p; ++i) sigma[i] = std::sqrt(x.col(i).squaredNorm() / n);
    Eigen::MatrixXd r(p, p);
    double sampling = 0, signal = 0;
    for (Eigen::Index i = 0; i < p; ++i)
        for (Eigen::Index j = 0; j < p; ++j) {
            r(i, j) = 0;
            for (Eigen::Index k = 0; k < n; ++k) r(i, j) += x(k, i) * x(k, j) / (sigma[i] * sigma[j]) / n;
            for (Eigen::Index k = 0; k < n; ++k)
                sampling += std::pow(x(k, i) * x(k, j) / (sigma[i] * sigma[j]) - r(i, j), 2) / n / n;
            if (i != j) signal += r(i, j) * r(i, j);
        }
    const double shrink = std::min(1.0, sampling / signal);
    Eigen::MatrixXd covariance(p, p);
    for (Eigen::Index i = 0; i < p; ++i)
        for (Eigen::Index j = 0; j < p; ++j)
            covariance(i, j) = (i == j ? 1 : (1 - shrink) * r(i, j)) * sigma[i] * sigma[j];
    return covariance;
}

TEST(ShrunkCovariance, AgreesWithLedoitAndWolf) {
    for (const int rows : {6, 30}) {
        const Eigen::MatrixXd x = noise_rows(rows, 2, 5)(Eigen::all, first_cells(12)) * 1e-3;
        EXPECT_LT((shrunk_covariance(x) - by_double_loop(x)).norm(), 1e-12 * by_double_loop(x).norm());
    }
}

TEST(ShrunkCovariance, IsHardlyShrunkForManyRows) {
    const Eigen::MatrixXd x = noise_rows(5000, 1, 6)(Eigen::all, first_cells(8));
    const Eigen::MatrixXd sample = x.transpose() * x / 5000;
    EXPECT_LT((shrunk_covariance(x) - sample).norm(), 0.01 * sample.norm());
    EXPECT_NEAR(shrunk_covariance(x)(3, 4) / shrunk_covariance(x)(3, 3), 0.5, 0.05);
}

TEST(ShrunkCovariance, IsPositiveDefiniteForFewRows) {
    const Eigen::MatrixXd x = noise_rows(5, 10, 7)(Eigen::all, first_cells(80));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(shrunk_covariance(x));
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.01);
    const Eigen::VectorXd variance = x.colwise().squaredNorm() / 5;
    EXPECT_LT((shrunk_covariance(x).diagonal() - variance).norm(), 1e-12);  // variances are not changed
}

TEST(UsableCells, AreFiniteInAllRowsAndVary) {
    SyntheticWorld world(2, 8);
    Evidence evidence = world.evidence(1, 6);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    world.add_nuisance(evidence, "modulus", world.pattern(1), 1);
    evidence.library.baseline.col(2).setConstant(0.5);
    evidence.library.baseline(3, 5) = not_available;
    evidence.library.effects[0].curvature[7] = not_available;
    evidence.library.nuisances[0].linear[9] = INFINITY;
    evidence.observed[11] = not_available;
    const Library& library = evidence.library;
    EXPECT_EQ(usable_cells(library.baseline, {&library.effects[0], &library.nuisances[0]}, evidence.observed),
              (CellChoice{0, 1, 3, 4, 6, 8, 10, 12, 13, 14, 15}));
}

TEST(Resolutions, AreThoseOfTheObservables) {
    const auto list = resolutions({0, 7, 8, 15}, static_cast<Eigen::Index>(8 * observables().size()));
    EXPECT_EQ(list[0], observables()[0].resolution);
    EXPECT_EQ(list[1], observables()[0].resolution);
    EXPECT_EQ(list[2], observables()[1].resolution);
    EXPECT_EQ(list[3], observables()[1].resolution);
}

/// A space with two nuisances, an extra variance and a mean of four, and its matrices.
struct DenseSpace {
    DenseSpace() {
        SyntheticWorld world(2, 9);
        free = {{world.pattern(0.7), 1.5}, {world.pattern(2), 0.4}};
        noise_covariance = 1.25 * shrunk_covariance(noise(Eigen::all, cells));
        noise_covariance.diagonal().array() += resolutions(cells, noise.cols()).square();
        noise_covariance.diagonal() += pick(extra, cells);
        directions.resize(static_cast<Eigen::Index>(cells.size()), 2);
        for (int k = 0; k < 2; ++k)
            directions.col(k) = pick(free[static_cast<std::size_t>(k)].direction, cells);
        gap = world.noise(2);
    }
    GapSpace space() const { return {noise, 4, cells, free, extra}; }

    CellChoice cells{0, 2, 3, 5, 8, 9, 13};
    Eigen::MatrixXd noise = noise_rows(20, 2, 10);
    Eigen::VectorXd extra = Eigen::VectorXd::LinSpaced(noise.cols(), 0, 5);
    std::vector<FreeParameter> free;
    Eigen::MatrixXd noise_covariance, directions;
    Eigen::VectorXd gap;
};

TEST(GapSpace, MarginalisesNuisances) {
    const DenseSpace d;
    const Eigen::Matrix2d prior = Eigen::Vector2d(1.5 * 1.5, 0.4 * 0.4).asDiagonal();
    const Eigen::MatrixXd total = d.noise_covariance + d.directions * prior * d.directions.transpose();
    const Eigen::VectorXd chosen = pick(d.gap, d.cells);
    const double expected = chosen.dot(total.inverse() * chosen);
    EXPECT_NEAR(d.space().whiten(d.gap).squaredNorm(), expected, 1e-9 * expected);
}

TEST(GapSpace, StandardDeviationsAreShrunkTowardsTheirObservable) {
    const DenseSpace d;
    const Eigen::ArrayXd own = d.noise_covariance.diagonal(), sigma = d.space().sigma();
    const double first = own.head(4).mean(), second = own.tail(3).mean();
    // Twenty replicates, and eight more for the mean.
    for (Eigen::Index k = 0; k < 7; ++k)
        EXPECT_NEAR(sigma[k] * sigma[k], (20 * own[k] + 8 * (k < 4 ? first : second)) / 28, 1e-12) << k;
}

// The normal density of four cells, written with the inverse and the determinant.
TEST(GapSpace, LogLikelihoodIsTheNormalDensity) {
    Random random(5, Stream::positions);
    const auto cells_all = static_cast<Eigen::Index>(cells_of(synthetic_grid).size());
    Eigen::MatrixXd noise(50, cells_all);
    for (Eigen::Index k = 0; k < noise.size(); ++k) noise.data()[k] = random.normal();
    const CellChoice cells{0, 1, 2, 3};
    const FreeParameter free{Eigen::VectorXd::Constant(cells_all, 2), 1.5};
    const Eigen::VectorXd extra = Eigen::VectorXd::Constant(cells_all, 0.3);
    const GapSpace space(noise, 4, cells, {free}, extra);
    const auto covariance = [&]() -> Eigen::MatrixXd {
        Eigen::MatrixXd c = 1.25 * shrunk_covariance(noise(Eigen::all, cells));
        c.diagonal().array() += resolutions(cells, cells_all).square() + 0.3;
        return c.array() + 2 * 2 * 1.5 * 1.5;
    }();
    const Eigen::VectorXd gap = Eigen::VectorXd::LinSpaced(cells_all, 0.5, 60);
    const Eigen::VectorXd chosen = pick(gap, cells);
    const double expected =
        -0.5 * chosen.dot(covariance.inverse() * chosen) - 0.5 * std::log(covariance.determinant());
    EXPECT_NEAR(space.log_likelihood(gap), expected, 1e-9 * std::abs(expected));
}

TEST(GapSpace, FitsNuisancesAsRidgeRegression) {
    const DenseSpace d;
    // |L^-1 (gap - S shift)|^2 + |shift / prior|^2 as one least-squares system.
    const Eigen::LLT<Eigen::MatrixXd> factor(d.noise_covariance);
    Eigen::MatrixXd system(9, 2);
    system.topRows(7) = factor.matrixL().solve(d.directions);
    system.bottomRows(2) = Eigen::Vector2d(1 / 1.5, 1 / 0.4).asDiagonal();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(9);
    right.head(7) = factor.matrixL().solve(pick(d.gap, d.cells));
    const Eigen::Vector2d shifts = system.colPivHouseholderQr().solve(right);
    EXPECT_LT((d.space().fit_nuisances(d.gap) - shifts).norm(), 1e-10);
    const Eigen::Matrix2d covariance = (system.transpose() * system).inverse();
    EXPECT_LT((d.space().nuisance_errors() - covariance.diagonal().cwiseSqrt()).norm(), 1e-10);
}

TEST(GapSpace, SquareOfWhitenedNoiseIsTheNumberOfCells) {
    SyntheticWorld world(2, 11);
    const int rows = 2000;
    Eigen::MatrixXd noise(rows, world.noise().size());
    for (int r = 0; r < rows; ++r) noise.row(r) = world.noise().transpose();
    const std::vector<FreeParameter> free{{world.pattern(1), 2}};
    const GapSpace space(noise, 1, first_cells(16), free);
    double sum = 0;
    const int draws = 3000;
    for (int k = 0; k < draws; ++k)
        sum += space.whiten(world.noise() - world.noise() + 2 * world.random().normal() * free[0].direction)
                   .squaredNorm();
    // Chi-square of 16: 3000 draws determine the mean to 0.10, 2000 rows of noise the covariance to 1 %.
    EXPECT_NEAR(sum / draws, 16, 0.5);
}

}  // namespace
}  // namespace mcdem
