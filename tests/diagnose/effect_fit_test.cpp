// Amplitudes and scores from synthetic gaps, compared with closed-form solutions.
#include "diagnose/infer/effect_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

struct Setting {
    explicit Setting(std::uint64_t seed = 1)
        : world(2, seed), evidence(world.evidence(1, 40)), data(gap_data(evidence)) {}
    GapSpace space() const { return {data.noise, 0, data.cells, {{direction, 1.0}}}; }
    SyntheticWorld world;
    Evidence evidence;
    GapData data;
    Eigen::VectorXd direction = world.pattern(1);
};

TEST(EffectFit, LinearSignatureAgreesWithTheClosedForm) {
    Setting s;
    const Signature signature = s.world.signature("adhesion", s.world.pattern(0.5));
    const Eigen::VectorXd gap = 3 * signature.linear + s.world.noise();
    const GapSpace space = s.space();
    const Eigen::VectorXd l = space.whiten(signature.linear), g = space.whiten(gap);
    const EffectFit fit = fit_effect(space, {&signature, -8, 8}, gap);
    EXPECT_NEAR(fit.amplitude, l.dot(g) / l.squaredNorm(), 1e-4);  // 20 bits of the range
    EXPECT_NEAR(fit.error, 1 / l.norm(), 1e-9);
    EXPECT_NEAR(fit.score, 0.5 * l.dot(g) * l.dot(g) / l.squaredNorm(), 1e-6 * fit.score);
    EXPECT_NEAR(fit.amplitude, 3, 4 * fit.error);
    EXPECT_FALSE(fit.at_bound);
}

TEST(EffectFit, ErrorIsTheScatterOfTheAmplitudes) {
    Setting s(2);
    const Signature signature = s.world.signature("adhesion", s.world.pattern(0.5));
    const GapSpace space = s.space();
    double square = 0;
    const int draws = 400;
    for (int k = 0; k < draws; ++k) {
        const Eigen::VectorXd gap =
            2 * signature.linear + s.world.noise() + s.world.random().normal() * s.direction;
        const EffectFit fit = fit_effect(space, {&signature, -20, 20}, gap);
        square += std::pow((fit.amplitude - 2) / fit.error, 2) / draws;
    }
    EXPECT_NEAR(square, 1, 0.4);  // 400 draws: 0.07; the covariance is known from 40 rows: about 0.2
}

// Pairs whose responses differ by a tenth, more than by chaos.
TEST(DrawError, IsTheScatterBetweenPairs) {
    Setting s(4);
    Signature signature = s.world.signature("polydispersity", s.world.pattern(0.5));
    const GapSpace space = s.space();
    signature.reach = 1e3;  // chaos is negligible
    const Eigen::Vector4d part(0.9, 1.1, 1.1, 0.9);
    signature.slopes = part * signature.linear.transpose();
    EXPECT_NEAR(draw_error(space, {&signature, 0, 8}, -3), 3 * std::sqrt(0.04 / 3 * (1 + 1.0 / 4)), 1e-4);
    signature.reach = 1e-3;
    EXPECT_EQ(draw_error(space, {&signature, 0, 8}, 3), 0);
    signature.slopes.resize(0, signature.linear.size());
    EXPECT_EQ(draw_error(space, {&signature, 0, 8}, 3), 0);
}

TEST(EffectFit, CurvedSignatureIsFitted) {
    Setting s(3);
    Signature signature = s.world.signature("stiffening", s.world.pattern(1));
    signature.curvature = s.world.pattern(0.4);
    signature.reach = 1.5;
    for (const double amplitude : {-1.2, 0.4, 1.5, 3.7})  // the last one is beyond the reach
        EXPECT_NEAR(fit_effect(s.space(), {&signature, -2, 4}, signature.at(amplitude)).amplitude, amplitude,
                    1e-4);
    // The error follows from the slope of the signature at the amplitude a, not from its linear part.
    const EffectFit fit = fit_effect(s.space(), {&signature, -2, 4}, signature.at(0.4));
    EXPECT_NEAR(fit.error, 1 / s.space().whiten(signature.slope(fit.amplitude)).norm(), 1e-9);
}

// Least squares with two signatures: amplitudes, errors and gain in closed form, even for a correlation of
// 0.98.
TEST(EffectFit, TwoSignaturesAgreeWithTheClosedForm) {
    Setting s(5);
    for (const double apart : {3.0, 0.2}) {
        const Signature first = s.world.signature("friction", s.world.pattern(0.5));
        const Signature second = s.world.signature("adhesion", first.linear + s.world.pattern(0.5 * apart));
        const Eigen::VectorXd gap = 3 * first.linear - 2 * second.linear + s.world.noise();
        const GapSpace space = s.space();
        Eigen::MatrixXd columns(static_cast<Eigen::Index>(space.cells().size()), 2);
        columns << space.whiten(first.linear), space.whiten(second.linear);
        const Eigen::MatrixXd covariance = (columns.transpose() * columns).inverse();
        const Eigen::VectorXd moment = columns.transpose() * space.whiten(gap), best = covariance * moment;
        const JointFit fit = fit_effects(space, {{&first, -60, 60}, {&second, -60, 60}}, gap);
        for (const int k : {0, 1}) {
            const auto at = static_cast<std::size_t>(k);
            EXPECT_NEAR(fit.errors[at], std::sqrt(covariance(k, k)), 1e-6 * fit.errors[at]);
            EXPECT_NEAR(fit.amplitudes[at], best[k], 0.05 * fit.errors[at]);  // tolerance of the search
        }
        EXPECT_NEAR(fit.score, 0.5 * moment.dot(best), 2e-3 * fit.score);
    }
}

// Two identical signatures: the sum of the amplitudes is determined, the amplitudes are not.
TEST(EffectFit, TwoIdenticalSignaturesHaveNoAmplitudes) {
    Setting s(6);
    const Signature one = s.world.signature("friction", s.world.pattern(0.5));
    const JointFit fit = fit_effects(s.space(), {{&one, -8, 8}, {&one, -8, 8}}, 3 * one.linear);
    EXPECT_NEAR(fit.amplitudes[0] + fit.amplitudes[1], 3, 1e-3);
    EXPECT_TRUE(std::isinf(fit.errors[0]) && std::isinf(fit.errors[1]));
}

TEST(EffectFit, StaysWithinItsBounds) {
    Setting s(4);
    const Signature signature = s.world.signature("plasticity", s.world.pattern(1));
    const EffectFit above = fit_effect(s.space(), {&signature, 0, 2}, 5 * signature.linear);
    EXPECT_NEAR(above.amplitude, 2, 1e-3);
    EXPECT_TRUE(above.at_bound);
    const EffectFit below = fit_effect(s.space(), {&signature, 0, 2}, -5 * signature.linear);
    EXPECT_EQ(below.amplitude, 0);
    EXPECT_EQ(below.score, 0);
    EXPECT_FALSE(below.at_bound);
    // Near a bound that means no effect, a fit is not at a bound.
    EXPECT_FALSE(fit_effect(s.space(), {&signature, 0, 5000}, signature.linear).at_bound);
    const EffectFit lowest = fit_effect(s.space(), {&signature, -1, 2}, -5 * signature.linear);
    EXPECT_NEAR(lowest.amplitude, -1, 2e-3);
    EXPECT_TRUE(lowest.at_bound);
}

}  // namespace
}  // namespace mcdem
