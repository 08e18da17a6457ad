// A planted effect, from the evidence to the text of the diagnosis.
#include "diagnose/decide/diagnose.h"

#include <gmock/gmock.h>

#include "diagnose/observe/scan_observables.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(DiagnosisBuilder, FindsAndMeasuresAPlantedEffect) {
    SyntheticWorld world(6, 3);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    world.add_effect(evidence, "friction", world.pattern(1));
    world.add_nuisance(evidence, "modulus", world.pattern(0.5), 1);
    evidence.candidates[0].unit = "J/m2";
    evidence.observed += 4 * evidence.library.effects[0].linear;
    const DiagnosisBuilder builder(evidence, {});
    const Diagnosis d = builder.diagnosis();
    EXPECT_EQ(d.verdict, Verdict::effect);
    ASSERT_EQ(d.causes.size(), 1u);
    EXPECT_EQ(d.causes[0].effect, "adhesion");
    EXPECT_EQ(d.causes[0].unit, "J/m2");
    EXPECT_NEAR(d.causes[0].amplitude, 4, 4 * d.causes[0].amplitude_error);
    EXPECT_FALSE(d.causes[0].at_limit);
    EXPECT_GT(d.causes[0].explained, 0.5);
    EXPECT_LT(d.p_value, 1e-3);
    EXPECT_FALSE(d.where.empty());
    ASSERT_EQ(d.ranking.size(), 3u);
    EXPECT_EQ(d.ranking[0].effect, "adhesion");
    ASSERT_EQ(d.nuisances.size(), 1u);
    ASSERT_TRUE(d.gap_reduction);
    EXPECT_GT(d.gap_reduction->fraction, 0.9);
    EXPECT_THAT(d.not_measured, ElementsAre(HasSubstr("grains.csv")));
}

/// A world with `observables_known` observables at four displacements, loading and unloading, in which the
/// experiment differs by `size` wherever `differs`.
template <class Differs>
Diagnosis diagnosis_where(Differs differs, double size, int observables_known = 10) {
    SyntheticWorld world(observables_known, 3);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    for (Eigen::Index cell = 0; cell < world.known(); ++cell)
        if (differs(cell / 8, cell % 8)) evidence.observed[cell] += size;
    return DiagnosisBuilder(evidence, {}).diagnosis();
}

TEST(DiagnosisBuilder, ADifferenceAtOneDisplacementIsARearrangement) {
    const auto smaller_p = [](const Diagnosis& d) { return 2 * std::min(d.p_omnibus, d.p_directed); };
    const Diagnosis one = diagnosis_where([](auto, auto place) { return place == 2; }, 5);
    EXPECT_LT(smaller_p(one), 1e-3) << "all cells together";
    EXPECT_GT(one.p_value, 0.01);
    EXPECT_EQ(one.verdict, Verdict::no_gap);
    const Diagnosis two = diagnosis_where([](auto, auto place) { return place == 2 || place == 5; }, 5);
    EXPECT_LT(two.p_value, 0.01);
    EXPECT_GT(two.p_value, smaller_p(two));
    const Diagnosis everywhere = diagnosis_where([](auto, auto) { return true; }, 2);
    EXPECT_LT(everywhere.p_value, 0.01);
}

// The force relaxes in a hold only, and a hold belongs to one displacement.
TEST(DiagnosisBuilder, ADifferenceInAHoldIsNoRearrangement) {
    const int all = static_cast<int>(observables().size());
    for (const OfProgramme kind : {OfProgramme::relaxation, OfProgramme::creep}) {
        const auto in_hold = [&](auto observable, auto place) {
            return observable == index_of(kind) && place == 3;
        };
        EXPECT_LT(diagnosis_where(in_hold, 60, all).p_value, 0.01);
    }
    const auto elsewhere = [&](auto observable, auto place) { return observable == 0 && place == 3; };
    EXPECT_GT(diagnosis_where(elsewhere, 60, all).p_value, 0.01);
}

/// Runs of a few replicates that differ by `shift` from the baseline.
Eigen::MatrixXd runs_at(SyntheticWorld& world, const Evidence& evidence, const Eigen::VectorXd& shift) {
    Eigen::MatrixXd runs(64, shift.size());
    const Eigen::VectorXd centre = evidence.baseline.colwise().mean().transpose() + shift;
    for (Eigen::Index r = 0; r < runs.rows(); ++r) runs.row(r) = (centre + world.noise()).transpose();
    return runs;
}

/// Decides between an effect with the pattern of all differences and none, if the runs with the effect leave
/// `left` at the chosen cells.
template <class Chosen>
Diagnosis with_remainder(Chosen chosen, double left) {
    SyntheticWorld world(8, 6);
    Evidence evidence = world.evidence(1, 32);
    const Eigen::VectorXd pattern = world.pattern(1);
    world.add_effect(evidence, "adhesion", pattern);
    evidence.observed += 9 * pattern;
    const Eigen::Index each = cells_each(evidence.observed.size());
    for (Eigen::Index i = 0; i < evidence.observed.size(); ++i)
        if (chosen(i / each, i % each)) evidence.observed[i] += (i / each % 2 ? 1 : -1) * left;
    DiagnosisBuilder builder(evidence, {});
    builder.confirm(0, runs_at(world, evidence, 9 * pattern));
    while (const auto k = builder.wants_held_out())
        builder.confirm_held_out(*k, runs_at(world, evidence, 9 * pattern));
    return builder.diagnosis();
}

// Grains rearranged at one displacement of the unloading, which is held out. Differences of the same size at
// two displacements, or everywhere in one observable, are a remainder.
TEST(DiagnosisBuilder, ARearrangementBesideAnEffectIsLeftOut) {
    const Diagnosis d = with_remainder([](auto, auto place) { return place == 5; }, 12);
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_GT(d.explanation->reduction, 0.9);
    EXPECT_THAT(d.explanation->without, EndsWith(" mm of unloading"));
    EXPECT_FALSE(d.explanation->leaves_more_than_noise);
    const Diagnosis two = with_remainder([](auto, auto place) { return place == 5 || place == 6; }, 12);
    EXPECT_EQ(two.verdict, Verdict::unknown_effect);
    EXPECT_EQ(two.explanation->without, "");
    ASSERT_FALSE(two.next.empty());
    EXPECT_THAT(two.next[0].what, HasSubstr("mcdem experiment check"));
    const Diagnosis one = with_remainder([](auto observable, auto) { return observable == 3; }, 12);
    EXPECT_EQ(one.explanation->without, "");
    EXPECT_TRUE(one.explanation->leaves_more_than_noise);
}

// The hidden amplitude is 4, larger than the range tried.
TEST(DiagnosisBuilder, SaysThatAnAmplitudeIsAtTheLimitOfItsRange) {
    SyntheticWorld world(6, 3);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    evidence.candidates[0].high = 3;
    evidence.observed += 4 * evidence.library.effects[0].linear;
    const Cause cause = DiagnosisBuilder(evidence, {}).diagnosis().ranking.at(0);
    EXPECT_NEAR(cause.amplitude, 3, 1e-6);
    EXPECT_TRUE(cause.at_limit);
}

TEST(DiagnosisBuilder, AParameterFarFromItsStatedValueIsASymptom) {
    SyntheticWorld world(6, 4);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    world.add_nuisance(evidence, "modulus", world.pattern(2), 1);
    evidence.observed += 9 * evidence.library.nuisances[0].linear;
    const Diagnosis d = DiagnosisBuilder(evidence, {}).diagnosis();
    EXPECT_EQ(d.verdict, Verdict::calibration_suspect);
    EXPECT_TRUE(d.nuisances[0].at_bound);
    EXPECT_EQ(d.causes.at(0).effect, "modulus");
}

// Effect and parameter have the same signature. The effect's runs agree with the data; those of the
// parameter do not reach them and leave a slightly larger gap.
TEST(DiagnosisBuilder, AParameterIsRunAgainIfItsRunsRequireALargerAmplitude) {
    SyntheticWorld world(6, 4);
    Evidence evidence = world.evidence(1, 32);
    const Eigen::VectorXd pattern = world.pattern(2);
    world.add_effect(evidence, "adhesion", pattern);
    world.add_nuisance(evidence, "modulus", pattern, 1);
    evidence.observed += 9 * pattern;
    DiagnosisBuilder builder(evidence, {});
    const auto& proposals = builder.findings().proposals;
    ASSERT_GE(proposals.size(), 2u);
    ASSERT_THAT(proposals[0].candidates, ElementsAre(0u));
    ASSERT_THAT(proposals[1].candidates, ElementsAre(1u));
    builder.confirm(0, runs_at(world, evidence, 9 * pattern));
    builder.confirm(1, runs_at(world, evidence, 7.5 * pattern + 0.6 * world.pattern(1)));
    ASSERT_EQ(builder.decision().proposal, 0);
    ASSERT_GT(proposals[1].best_misfit(), 0.01);
    const double before = builder.whole_fit(1).amplitudes[0];
    EXPECT_TRUE(builder.refit(1));
    EXPECT_NEAR(builder.whole_fit(1).amplitudes[0] - before, 1.5, 0.5);
    EXPECT_FALSE(builder.refit(0));
}

TEST(DiagnosisBuilder, RunsThatFailAreRepeatedWithHalfTheAmplitude) {
    SyntheticWorld world(6, 4);
    Evidence evidence = world.evidence(1, 32);
    const Eigen::VectorXd pattern = world.pattern(1);
    world.add_effect(evidence, "adhesion", pattern);
    evidence.observed += 9 * pattern;
    DiagnosisBuilder builder(evidence, {});
    const double fitted = builder.whole_fit(0).amplitudes[0];
    Eigen::MatrixXd failed = runs_at(world, evidence, fitted * pattern);
    failed.col(builder.data().cells[0]).setConstant(not_available);
    builder.confirm(0, failed);
    EXPECT_TRUE(builder.refit(0));
    EXPECT_DOUBLE_EQ(builder.whole_fit(0).amplitudes[0], fitted / 2);
    builder.confirm(0, runs_at(world, evidence, fitted / 2 * pattern));
    EXPECT_GT(builder.findings().proposals[0].amplitudes[0], 0.6 * fitted)
        << "half of the step that they require";
    builder.confirm(0, failed);
    EXPECT_FALSE(builder.refit(0)) << "an earlier amplitude has results";
}

}  // namespace
}  // namespace mcdem
