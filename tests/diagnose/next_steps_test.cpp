// Recommended next measurements, predicted from the signatures.
#include "diagnose/decide/next_steps.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/decide/diagnose.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two effects whose signatures differ by `apart`; the first one is planted.
Evidence two_alike(SyntheticWorld& world, double apart, double amplitude) {
    Evidence evidence = world.evidence(1, 32);
    const Eigen::VectorXd shape = world.pattern(1);
    world.add_effect(evidence, "viscoelasticity", shape);
    world.add_effect(evidence, "plasticity", shape + apart * world.pattern(1));
    world.add_nuisance(evidence, "modulus", world.pattern(0.5), 1);
    evidence.observed += amplitude * shape;
    return evidence;
}

TEST(NextSteps, DistinguishTheMembersOfAGroup) {
    SyntheticWorld world(6, 3);
    const Evidence evidence = two_alike(world, 0.05, 4);
    const DiagnosisBuilder builder(evidence, {});
    ASSERT_EQ(builder.decision().verdict, Verdict::group);
    const Diagnosis diagnosis = builder.diagnosis();
    for (const Cause& cause : diagnosis.ranking)
        EXPECT_EQ(cause.group.size(), cause.effect == "modulus" ? 1u : 2u) << cause.effect;
    const auto& steps = diagnosis.next;
    EXPECT_THAT(steps, Contains(Field(&NextStep::what,
                                      AllOf(HasSubstr("3 more packings"),
                                            HasSubstr("to distinguish viscoelasticity from plasticity")))));
    for (std::size_t k = 1; k < steps.size(); ++k)
        EXPECT_LE(steps[k].power.value_or(0), steps[k - 1].power.value_or(0)) << "the most useful first";
    // At twice the difference, more of such experiments would distinguish them.
    SyntheticWorld again(6, 3);
    const Evidence farther = two_alike(again, 0.1, 4);
    const DiagnosisBuilder other(farther, {});
    if (other.decision().verdict == Verdict::group) {
        EXPECT_GT(other.diagnosis().next[0].power.value(), steps[0].power.value());
    }
}

// The predicted power equals the fraction of experiments in which the likelihoods differ by the margin.
TEST(NextSteps, PredictedPowerIsCorrect) {
    constexpr int drawn = 60;
    double predicted = 0;
    int told = 0, groups = 0;
    for (int k = 0; k < drawn; ++k) {
        SyntheticWorld world(6, 900 + static_cast<std::uint64_t>(k));
        Evidence evidence = two_alike(world, 0.12, 4);
        const DiagnosisBuilder builder(evidence, {});
        if (builder.decision().verdict != Verdict::group) continue;
        for (const NextStep& step : builder.diagnosis().next)
            if (step.what.find("3 more packings") != std::string::npos) {
                predicted += *step.power;
                ++groups;
                // The mean of four experiments has half the scatter.
                Evidence four = evidence;
                four.observed = evidence.baseline.colwise().mean().transpose() +
                                4 * evidence.library.effects[0].linear + 0.5 * world.noise();
                four.library.baseline *= 0.5;
                four.baseline = four.library.baseline;
                four.observed += four.baseline.colwise().mean().transpose() -
                                 evidence.baseline.colwise().mean().transpose();
                const std::vector<double> gain = DiagnosisBuilder(four, {}).findings().gain;
                told += gain[0] - gain[1] > std::max(Limits{}.group, Limits{}.group_share * gain[0]);
            }
    }
    ASSERT_GT(groups, 10);
    EXPECT_NEAR(static_cast<double>(told) / groups, predicted / groups, 0.2);
}

/// Eight runs of each effect. In a cell that the diagnosis does not have, their scatter is 1 and they differ
/// by `apart`.
ProtocolRuns protocol_runs(SyntheticWorld& world, double apart) {
    ProtocolRuns runs{world.noise().transpose().replicate(8, 1), world.noise().transpose().replicate(8, 1)};
    const Eigen::Index relaxation = world.known() + 3;
    for (int r = 0; r < 8; ++r) {
        runs.leader.row(r) = world.noise(0.3).transpose();
        runs.rival.row(r) = world.noise(0.3).transpose();
        runs.leader(r, relaxation) = std::sqrt(7.0 / 8) * (r % 2 == 0 ? 1 : -1);
        runs.rival(r, relaxation) = runs.leader(r, relaxation) + apart;
    }
    return runs;
}

// A difference of n sigmas decides with the probability that a normal number exceeds margin / n - n / 2. The
// noise of the runs in the other cells changes the mean of a few draws by some per cent.
TEST(NextSteps, PowerOfAProtocolFollowsFromRunsOfBothEffects) {
    for (const double apart : {0.0, 2.0, 3.0, 5.0}) {
        constexpr int drawn = 20;
        double power = 0, expected = 0;
        for (int k = 0; k < drawn; ++k) {
            SyntheticWorld world(6, 70 + static_cast<std::uint64_t>(k));
            const Evidence evidence = two_alike(world, 0.05, 4);
            const DiagnosisBuilder builder(evidence, {});
            ASSERT_EQ(builder.decision().verdict, Verdict::group);
            power += builder.power_of(protocol_runs(world, apart)) / drawn;
            const double gain = builder.findings().proposals[builder.decided()].best_gain();
            const double margin = std::max(Limits{}.group, Limits{}.group_share * gain);
            if (apart > 0) expected += 0.5 * std::erfc((margin / apart - 0.5 * apart) / std::sqrt(2)) / drawn;
        }
        EXPECT_NEAR(power, expected, 0.1) << apart;
    }
}

TEST(NextSteps, AnotherSpeedChecksAnEffectThatDependsOnIt) {
    SyntheticWorld world(6, 3);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "viscoelasticity", world.pattern(1));
    evidence.observed += 4 * evidence.library.effects[0].linear;
    const DiagnosisBuilder builder(evidence, {});
    ASSERT_EQ(builder.decision().verdict, Verdict::effect);
    EXPECT_THAT(builder.diagnosis().next,
                Contains(Field(&NextStep::what, HasSubstr("repeat the experiment at another plate speed"))));
}

// Without parameters the limit is proportional to the noise.
TEST(NextSteps, HalfTheErrorOfPositionsLowersTheLimitsAsItLowersTheScatter) {
    SyntheticWorld world(6, 5);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "diameter_error", world.pattern(2));
    const Eigen::RowVectorXd mean = evidence.baseline.colwise().mean();
    evidence.finer_baseline = (0.6 * (evidence.baseline.rowwise() - mean)).rowwise() + mean;
    const DiagnosisBuilder builder(evidence, {});
    ASSERT_EQ(builder.decision().verdict, Verdict::no_gap);
    EXPECT_THAT(builder.diagnosis().next,
                Contains(Field(&NextStep::what, AllOf(HasSubstr("measure positions twice as accurately"),
                                                      HasSubstr("to 60 % of the present value")))));
}

TEST(NextSteps, WithoutAGapTheyLowerTheDetectionLimits) {
    SyntheticWorld world(6, 5);
    Evidence evidence = world.evidence(1, 32);
    const Eigen::VectorXd modulus = world.pattern(2);
    world.add_effect(evidence, "diameter_error", modulus + world.pattern(0.1));
    world.add_nuisance(evidence, "modulus", modulus, 1);
    const DiagnosisBuilder builder(evidence, {});
    ASSERT_EQ(builder.decision().verdict, Verdict::no_gap);
    const auto steps = builder.diagnosis().next;
    ASSERT_FALSE(steps.empty());
    EXPECT_THAT(steps[0].what, AllOf(HasSubstr("grains.youngs_modulus 5 times more accurately"),
                                     HasSubstr("% of the present value")));
    EXPECT_THAT(steps, Each(Field(&NextStep::what, Not(HasSubstr("hold the plate")))));
}

}  // namespace
}  // namespace mcdem
