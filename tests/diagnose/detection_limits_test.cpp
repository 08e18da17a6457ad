// Detection limits, compared with simulated experiments with that amplitude.
#include "diagnose/infer/detection_limits.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int replicates = 32;

struct Case {
    /// `huge`: the prior of the nuisance is so wide that it has no effect.
    Case() : world(4, 1), evidence(make()), data(gap_data(evidence)) {}

    Evidence make() {
        Evidence e = world.evidence(1, replicates);
        const Eigen::VectorXd modulus = world.pattern(0.5), first = world.pattern(0.5),
                              second = world.pattern(0.5);
        world.add_effect(e, "adhesion", first);
        world.add_effect(e, "the_same", 0.5 * first);
        world.add_effect(e, "friction", second, 0, 10);
        world.add_effect(e, "nothing", Eigen::VectorXd::Zero(first.size()));
        world.add_effect(e, "like_modulus", modulus);
        world.add_effect(e, "too_small", second, 0, 1e-3);
        world.add_nuisance(e, "modulus", modulus, 1000);
        return e;
    }
    std::vector<DetectionLimit> limits() const {
        Limits limits;
        limits.false_alarm = 0.05;
        return detection_limits(space, data, null, evidence, limits);
    }
    double expected_gain(std::size_t c, double amplitude) const {
        return 0.5 * space.whiten(data.candidates[c].signature->at(amplitude)).squaredNorm();
    }

    SyntheticWorld world;
    Evidence evidence;
    GapData data;
    GapSpace space{data.noise, replicates, data.cells, data.free};
    NullDistribution null{data, replicates, 1};
};

TEST(DetectionLimits, OnePerEffect) {
    const Case c;
    const auto list = c.limits();
    ASSERT_EQ(list.size(), 6u);  // none for the modulus
    for (std::size_t k = 0; k < list.size(); ++k) EXPECT_EQ(list[k].effect, c.evidence.candidates[k].name);
}

TEST(DetectionLimits, ExpectedGainGivesAPowerOfFourFifths) {
    const Case c;
    const auto list = c.limits();
    const double threshold = c.null.quantile(&GapStatistics::directed, 0.025);
    const double wanted = 0.5 * std::pow(std::sqrt(2 * threshold) + 0.8416, 2);
    EXPECT_NEAR(c.expected_gain(0, list[0].minimum_amplitude), wanted, 2e-3 * wanted);
    EXPECT_NEAR(c.expected_gain(2, list[2].minimum_amplitude), wanted, 2e-3 * wanted);
    EXPECT_NEAR(list[1].minimum_amplitude, 2 * list[0].minimum_amplitude, 1e-6);
}

TEST(DetectionLimits, FourInFiveAreDetectedAtTheLimit) {
    Case c;
    const double amplitude = c.limits()[2].minimum_amplitude;
    int detected = 0;
    constexpr int draws = 300;
    for (int k = 0; k < draws; ++k) {
        const Eigen::VectorXd gap = std::sqrt(1 + 1.0 / replicates) * c.world.noise() +
                                    amplitude * c.evidence.library.effects[2].linear;
        const GapStatistics s = gap_statistics(c.space, c.data, gap);
        detected += c.null.p_value(&GapStatistics::directed, s.directed) < 0.025;
    }
    // 300 draws: 2.3 %; the covariance of 32 replicates and the best of several candidates add a few per
    // cent.
    EXPECT_GT(detected, 0.65 * draws);
    EXPECT_LT(detected, 0.95 * draws);
}

TEST(DetectionLimits, AreInfiniteForEffectsThatCannotBeDetected) {
    const auto list = Case().limits();
    EXPECT_TRUE(std::isinf(list[3].minimum_amplitude));
    EXPECT_TRUE(std::isinf(list[4].minimum_amplitude));
    EXPECT_TRUE(std::isinf(list[5].minimum_amplitude));
    EXPECT_EQ(list[3].absorbed_by_calibration, 0);  // nothing to absorb
}

TEST(DetectionLimits, UseTheEasierSign) {
    Case c;
    c.data.candidates[0].high = 1e-3;
    const double down = c.limits()[0].minimum_amplitude;
    EXPECT_NEAR(down, Case().limits()[0].minimum_amplitude, 1e-6);
}

TEST(DetectionLimits, ListEffectsWithTheSameSignature) {
    const auto list = Case().limits();
    EXPECT_THAT(list[0].group, Contains("the_same"));
    EXPECT_THAT(list[1].group, Contains("adhesion"));
    EXPECT_THAT(list[0].group, Not(Contains("adhesion")));
    EXPECT_THAT(list[0].group, Not(Contains("friction")));
    EXPECT_THAT(list[2].group, IsEmpty());
}

TEST(DetectionLimits, ReportThePartAbsorbedByCalibration) {
    EXPECT_NEAR(Case().limits()[4].absorbed_by_calibration, 1, 1e-4);
    // Orthogonal to the modulus in the metric of the noise: nothing is absorbed.
    Case c;
    const GapSpace fixed(c.data.noise, replicates, c.data.cells, {});
    const Eigen::VectorXd modulus = c.evidence.library.nuisances[0].linear;
    Eigen::VectorXd& linear = c.evidence.library.effects[2].linear;
    const Eigen::VectorXd m = fixed.whiten(modulus);
    linear -= fixed.whiten(linear).dot(m) / m.squaredNorm() * modulus;
    EXPECT_NEAR(c.limits()[2].absorbed_by_calibration, 0, 1e-9);
}

}  // namespace
}  // namespace mcdem
