// Signatures from paired runs: parabolas are found, noise is shrunk to zero.
#include "diagnose/infer/signature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/random.h"

namespace mcdem::signature {
namespace {

/// Identical rows plus noise: linear a + curvature a^2.
Eigen::MatrixXd differences(double a, const Eigen::VectorXd& linear, const Eigen::VectorXd& curvature,
                            int pairs, double noise = 0, std::uint64_t seed = 1) {
    Random random(seed, Stream::positions);
    Eigen::MatrixXd rows = (a * linear + a * a * curvature).transpose().replicate(pairs, 1);
    for (Eigen::Index r = 0; r < rows.rows(); ++r)
        for (Eigen::Index cell = 0; cell < rows.cols(); ++cell) rows(r, cell) += noise * random.normal();
    return rows;
}

const Eigen::Vector3d linear(1, -0.5, 2), curvature(0.3, 0.4, -0.7);

TEST(Signature, ParabolaThroughExactDataIsExact) {
    for (const auto& [first, second] : {std::pair{0.5, 1.0}, {-0.7, 2.5}, {-0.2, 0.2}}) {
        const Signature s =
            learn_signature("adhesion", first, second, differences(first, linear, curvature, 4),
                            differences(second, linear, curvature, 4));
        EXPECT_EQ(s.name, "adhesion");
        EXPECT_EQ(s.reach, second);
        EXPECT_EQ(s.pairs(), 4);
        EXPECT_LT((s.linear - linear).norm(), 1e-12);
        EXPECT_LT((s.curvature - curvature).norm(), 1e-11);
        EXPECT_LT(s.spread().norm(), 1e-20);
        const double a = 0.6 * second;
        EXPECT_LT((s.at(a) - (a * linear + a * a * curvature)).norm(), 1e-11);
        EXPECT_LT((s.slope(a) - (linear + 2 * a * curvature)).norm(), 1e-11);
    }
}

TEST(Signature, IsLinearBeyondItsReach) {
    const Signature s{"", 2, linear, curvature, {}};
    for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d end = side * 2 * linear + 4 * curvature, slope = linear + side * 4 * curvature;
        EXPECT_LT((s.at(side * 2) - end).norm(), 1e-12);
        EXPECT_LT((s.at(side * 3.5) - (end + side * 1.5 * slope)).norm(), 1e-12);
        EXPECT_LT((s.slope(side * 3.5) - slope).norm(), 1e-12);
    }
}

TEST(Signature, NoiseIsShrunkToZero) {
    const int cells = 2000, pairs = 8;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(cells);
    const Signature s = learn_signature("", -1, 1, differences(-1, zero, zero, pairs, 1, 1),
                                        differences(1, zero, zero, pairs, 1, 2));
    // 68 % of normal means are below one of their known error; with the error from 8 pairs, 65 %.
    const double nothing = (s.linear.array() == 0).cast<double>().mean();
    EXPECT_NEAR((s.curvature.array() == 0).cast<double>().mean(), 0.65, 0.05);
    EXPECT_GT(nothing, 0.4);
    EXPECT_LT(s.at(1).squaredNorm() / cells,
              0.7 / pairs);  // mean of the runs with the second amplitude: 1/pairs
}

TEST(Signature, ClearEffectsAreKept) {
    const Eigen::VectorXd one = Eigen::VectorXd::Constant(500, 1.0), zero = Eigen::VectorXd::Zero(500);
    const Signature s = learn_signature("", 0.5, 1, differences(0.5, one, zero, 8, 0.1, 1),
                                        differences(1, one, zero, 8, 0.1, 2));
    // The mean of 8 pairs has an error of 0.035. The error of the slope is slightly larger, and larger again
    // if a curvature is accepted.
    EXPECT_NEAR(s.at(1).mean(), 1, 0.01);
    EXPECT_LT((s.at(1) - one).norm() / std::sqrt(500), 0.06);
}

TEST(Signature, SpreadIsThatOfPairsOverTheAmplitude) {
    Eigen::MatrixXd first(3, 1), second(3, 1);
    first << 1, 1, 1;
    second << 2, 3, 7;  // variance 7
    const Signature s = learn_signature("", 1, 2, first, second);
    EXPECT_NEAR(s.spread()[0], 7.0 / 4, 1e-12);
}

// Numerics: half of the error is already removed; a further part b of the rest gives 1/2 + b/2 in total.
TEST(Signature, ContinuesFromAPartiallyRefinedModel) {
    const Signature s = learn_signature("plate_speed", 0.5, 0.75, differences(0.5, linear, curvature, 4),
                                        differences(0.75, linear, curvature, 4));
    for (const double done : {0.5, 0.75, 0.875})
        for (const double part : {0.0, 0.3, 0.5, 1.0}) {
            const Eigen::VectorXd expected = s.at(done + part * (1 - done)) - s.at(done);
            EXPECT_LT((continued_from(s, done).at(part) - expected).norm(), 1e-11) << done << " " << part;
        }
}

// A pair with a failed run is ignored; if the larger amplitude runs away, the smaller one is used.
TEST(Signature, FailedRunsAreExcluded) {
    Eigen::MatrixXd first = differences(0.5, linear, curvature, 4),
                    second = differences(1, linear, curvature, 4);
    second.row(2).setConstant(NAN);
    const Signature three = learn_signature("adhesion", 0.5, 1, first, second);
    EXPECT_EQ(three.pairs(), 3);
    EXPECT_LT((three.linear - linear).norm(), 1e-12);
    second.topRows(3).setConstant(NAN);
    const Signature straight = learn_signature("adhesion", 0.5, 1, first, second);
    EXPECT_EQ(straight.reach, 0.5);
    EXPECT_EQ(straight.curvature.norm(), 0);
    EXPECT_LT((straight.at(0.5) - (0.5 * linear + 0.25 * curvature)).norm(), 1e-12);
    first.topRows(3).setConstant(NAN);
    EXPECT_FALSE(learn_signature("adhesion", 0.5, 1, first, second).linear.array().isFinite().any());
}

// A force whose logarithm is observed may vanish with the larger amplitude, in some bins and pairs only.
TEST(Signature, ACellWithoutAValueAtOneAmplitudeIsAStraightLineThroughTheOther) {
    Eigen::MatrixXd first = differences(0.5, linear, curvature, 4),
                    second = differences(1, linear, curvature, 4);
    second(2, 1) = NAN;
    first(0, 2) = NAN;
    const Signature s = learn_signature("adhesion", 0.5, 1, first, second);
    EXPECT_EQ(s.pairs(), 4);
    EXPECT_NEAR(s.linear[0], linear[0], 1e-12);
    EXPECT_NEAR(s.curvature[0], curvature[0], 1e-11);
    EXPECT_NEAR(s.linear[1], linear[1] + 0.5 * curvature[1], 1e-12);
    EXPECT_NEAR(s.linear[2], linear[2] + curvature[2], 1e-12);
    EXPECT_EQ(s.curvature.tail(2).norm(), 0);
    EXPECT_LT(s.spread().norm(), 1e-20);
    second(1, 2) = NAN;
    const Signature none = learn_signature("adhesion", 0.5, 1, first, second);
    EXPECT_TRUE(std::isnan(none.linear[2]));
    EXPECT_NEAR(none.linear[1], s.linear[1], 1e-12);
}

}  // namespace
}  // namespace mcdem::signature
