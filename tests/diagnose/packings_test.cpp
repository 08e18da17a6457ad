// Several packings of one experiment: common effects and differences.
#include "diagnose/decide/packings.h"

#include <gmock/gmock.h>

#include "diagnose/decide/diagnose.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem::packings {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int replicates = 16;

/// Two packings with the scatter of packings. "adhesion" acts on every cell of both, with the given
/// amplitudes.
Evidence two_packings(double first, double second, std::uint64_t seed, double size = 0.4) {
    SyntheticWorld world(6, seed);
    Evidence evidence = world.evidence(2, replicates);
    world.add_effect(evidence, "adhesion", world.pattern(size));
    world.add_effect(evidence, "friction", world.pattern(0.4));
    world.add_nuisance(evidence, "strain_offset", world.pattern(0.5), 1);
    const Eigen::VectorXd linear = evidence.library.effects[0].linear;
    const double amplitudes[] = {first, second};
    for (int p = 0; p < 2; ++p) {
        const Eigen::MatrixXd runs = evidence.library.baseline.middleRows(p * replicates, replicates);
        const Eigen::VectorXd centre = runs.colwise().mean().transpose();
        evidence.packings.push_back(
            {p == 0 ? "A" : "B", centre + world.noise() + amplitudes[p] * linear, runs});
    }
    take_means(evidence);
    return evidence;
}

TEST(Packings, ACommonEffectHasOneAmplitude) {
    const Evidence evidence = two_packings(3, 3, 5);
    const Diagnosis d = DiagnosisBuilder(evidence, {}).diagnosis();
    ASSERT_EQ(d.verdict, Verdict::effect);
    EXPECT_EQ(d.causes.at(0).effect, "adhesion");
    EXPECT_NEAR(d.causes[0].amplitude, 3, 3 * d.causes[0].amplitude_error);
    ASSERT_EQ(d.packings.size(), 2u);
    for (const PackingAgreement& packing : d.packings) {
        EXPECT_LT(packing.gap_p, 0.01);
        EXPECT_NEAR(packing.amplitude, 3, 4 * packing.amplitude_error);
        EXPECT_NEAR(packing.amplitude_error, std::sqrt(2) * d.causes[0].amplitude_error,
                    0.2 * packing.amplitude_error);
        EXPECT_GT(packing.agreement_p, 0.01);
        EXPECT_FALSE(packing.differs);
    }
}

TEST(Packings, AnEffectInOneOfThemIsNotCommon) {
    const Diagnosis d = DiagnosisBuilder(two_packings(5, -5, 5), {}).diagnosis();
    ASSERT_EQ(d.packings.size(), 2u);
    for (const PackingAgreement& packing : d.packings) {
        EXPECT_LT(packing.gap_p, 0.01);
        EXPECT_TRUE(packing.differs);
    }
}

// Signatures have an error of a tenth: packings may respond to a strong effect with this difference.
TEST(Packings, AStrongEffectMayDifferSlightlyBetweenPackings) {
    const Diagnosis d = DiagnosisBuilder(two_packings(8, 7.4, 5, 3), {}).diagnosis();
    ASSERT_EQ(d.verdict, Verdict::effect);
    for (const PackingAgreement& packing : d.packings) EXPECT_FALSE(packing.differs);
}

/// Experiments without an effect: the joint p and the p of agreement are uniformly distributed.
TEST(Packings, WithoutAnEffectAllPAreUniform) {
    constexpr int drawn = 200;
    constexpr double level = 0.1;
    int gaps = 0, alone = 0, apart = 0;
    for (std::uint64_t seed = 1; seed <= drawn; ++seed) {
        const Diagnosis d = DiagnosisBuilder(two_packings(0, 0, seed), {}).diagnosis();
        gaps += d.p_omnibus < level;
        alone += d.packings[0].gap_p < level;
        apart += d.packings[0].agreement_p < level;
    }
    const double error = std::sqrt(level * (1 - level) * drawn);
    for (const int found : {gaps, alone, apart}) EXPECT_NEAR(found, level * drawn, 3.5 * error);
}

TEST(Packings, ASinglePackingHasNoTestOfAgreement) {
    SyntheticWorld world(6, 1);
    Evidence evidence = world.evidence(1, replicates);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    EXPECT_THAT(DiagnosisBuilder(evidence, {}).diagnosis().packings, IsEmpty());
}

TEST(Packings, RowsAreAveragedByReplicate) {
    Eigen::MatrixXd rows(4, 1);
    rows << 1, 2, 5, 10;
    const Eigen::MatrixXd means = mean_over_packings(rows, 2);
    EXPECT_THAT((std::vector<double>{means(0, 0), means(1, 0)}), ElementsAre(3, 6));
}

}  // namespace
}  // namespace mcdem::packings
