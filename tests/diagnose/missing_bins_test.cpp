// Bins in which a candidate, a parameter or a replicate has no value.
#include <gmock/gmock.h>

#include "diagnose/decide/diagnose.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem::missing_bins {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Bins 16 to 35 of 48 can be taken from any.
struct World : TwoEffects {
    Signature& effect(int k) { return evidence.library.effects[static_cast<std::size_t>(k)]; }
    static void take_bins(Eigen::VectorXd& values) { values.segment(16, 20).setConstant(not_available); }
    GapStatistics statistics() const {
        const GapData data = gap_data(evidence);
        const GapSpace space(data.noise, static_cast<int>(evidence.baseline.rows()), data.cells, data.free);
        return gap_statistics(space, data, data.gap);
    }
};

TEST(MissingBins, OfACandidateLeaveTheEvidenceForAllOthersAsItIs) {
    World without, with;
    without.evidence.candidates.pop_back();
    World::take_bins(with.effect(1).linear);
    EXPECT_EQ(gap_data(with.evidence).cells, gap_data(without.evidence).cells);
    const GapStatistics a = without.statistics(), b = with.statistics();
    EXPECT_EQ(a.omnibus, b.omnibus);
    EXPECT_EQ(a.highest_refitted, b.highest_refitted);
    EXPECT_EQ(a.fits[0].amplitude, b.fits[0].amplitude);
    EXPECT_EQ(a.fits[0].error, b.fits[0].error);
    EXPECT_EQ(a.fits[0].score, b.fits[0].score);
    const Diagnosis d = DiagnosisBuilder(with.evidence, {}).diagnosis();
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_EQ(d.causes.at(0).effect, "adhesion");
    ASSERT_EQ(d.missing_bins.size(), 1u);
    EXPECT_EQ(d.missing_bins[0].of, "friction");
    EXPECT_EQ(d.missing_bins[0].count, 20);
    EXPECT_EQ(d.missing_bins[0].all, 48);
    EXPECT_FALSE(d.missing_bins[0].for_all);
    EXPECT_THAT(DiagnosisBuilder(without.evidence, {}).diagnosis().missing_bins, IsEmpty());
}

// The amplitude is that of the other bins, without bias; what the missing ones would have gained is lost.
TEST(MissingBins, CostTheCandidateThatLacksThem) {
    World whole, lacking;
    World::take_bins(lacking.effect(0).curvature);
    const EffectFit a = whole.statistics().fits[0], b = lacking.statistics().fits[0];
    EXPECT_NEAR(b.amplitude, 4, 4 * b.error);
    EXPECT_GT(b.error, a.error);
    EXPECT_LT(b.score, 0.8 * a.score);  // 28 of 48 bins
    EXPECT_GT(b.score, 0.4 * a.score);
    const GapData data = gap_data(lacking.evidence);
    const GapSpace space(data.noise, 16, data.cells, data.free);
    const Split split = split_cells(data.cells, lacking.evidence.library.grid);
    const double all_known = held_out_reduction(gap_data(whole.evidence), split, {0}, 16);
    EXPECT_GT(all_known, 0.9);
    // 10 of the 30 bins that are held out are unloading ones among the missing.
    EXPECT_NEAR(held_out_reduction(data, split, {0}, 16), all_known * 17 / 30, 0.2);
    const Diagnosis d = DiagnosisBuilder(lacking.evidence, {}).diagnosis();
    EXPECT_EQ(d.ranking.at(0).effect, "adhesion");
    EXPECT_EQ(d.verdict, Verdict::unknown_effect) << "the gap in the missing bins is left";
    EXPECT_TRUE(d.explanation->leaves_more_than_noise);
}

/// Runs of a few replicates with four times the effect.
Eigen::MatrixXd runs_with(World& world, const Eigen::VectorXd& effect) {
    Eigen::MatrixXd runs(16, effect.size());
    const Eigen::VectorXd centre = world.evidence.baseline.colwise().mean().transpose() + 4 * effect;
    for (Eigen::Index r = 0; r < runs.rows(); ++r)
        runs.row(r) = (centre + world.synthetic.noise()).transpose();
    return runs;
}

// The signature is not known at amplitudes at which a force vanishes; runs at the fitted one have all bins.
TEST(MissingBins, AreGivenBackByRunsThatHaveThem) {
    World world;
    const Eigen::VectorXd effect = world.effect(0).linear;
    World::take_bins(world.effect(0).linear);
    for (const bool have : {true, false}) {
        DiagnosisBuilder builder(world.evidence, {});
        Eigen::MatrixXd runs = runs_with(world, effect);
        if (!have) runs.middleCols(16, 20).topRows(3).setConstant(not_available);
        builder.confirm(0, runs);
        while (const auto k = builder.wants_held_out()) builder.confirm_held_out(*k, runs);
        const Diagnosis d = builder.diagnosis();
        ASSERT_TRUE(d.ranking.at(0).confirmed_score) << have;
        EXPECT_EQ(d.ranking.at(0).effect, "adhesion");
        EXPECT_NEAR(d.ranking.at(0).amplitude, 4, 4 * d.ranking.at(0).amplitude_error);
        EXPECT_EQ(d.verdict, have ? Verdict::effect : Verdict::unknown_effect);
        EXPECT_EQ(d.explanation->reduction > 0.9, have) << d.explanation->reduction;
        EXPECT_EQ(d.explanation->leaves_more_than_noise, !have);
    }
}

TEST(MissingBins, OfOneOfAPairAreNotGainedByThePair) {
    World world;
    world.evidence.observed += 3 * world.effect(1).linear;
    const auto pair_gain = [&] {
        const GapData data = gap_data(world.evidence);
        const GapSpace space(data.noise, 16, data.cells, data.free);
        return fit_effects(space, {data.candidates[0], data.candidates[1]}, data.gap).score;
    };
    const double whole = pair_gain();
    World::take_bins(world.effect(1).linear);
    const double lacking = pair_gain();
    EXPECT_TRUE(std::isfinite(lacking));
    EXPECT_LT(lacking, 0.8 * whole);
    const Diagnosis d = DiagnosisBuilder(world.evidence, {}).diagnosis();
    for (const Cause& cause : d.ranking) EXPECT_TRUE(std::isfinite(cause.score)) << cause.effect;
    for (const DetectionLimit& limit : d.detection_limits)
        EXPECT_TRUE(std::isfinite(limit.minimum_amplitude)) << limit.effect;
}

// A parameter may shift a bin by any amount where its own change of it is not known.
TEST(MissingBins, OfAParameterAreComparedForNoCandidate) {
    World world;
    world.evidence.library.nuisances[0].linear.segment(4, 3).setConstant(not_available);
    EXPECT_EQ(gap_data(world.evidence).cells.size(), 45u);
    const Diagnosis d = DiagnosisBuilder(world.evidence, {}).diagnosis();
    ASSERT_EQ(d.missing_bins.size(), 1u);
    EXPECT_EQ(d.missing_bins[0].of, "modulus");
    EXPECT_EQ(d.missing_bins[0].count, 3);
    EXPECT_TRUE(d.missing_bins[0].for_all);
}

TEST(MissingBins, OfAFewReplicatesLeaveOutTheseReplicates) {
    World world;
    for (const Eigen::Index r : {2, 7}) {
        world.evidence.library.baseline.row(r).segment(16, 20).setConstant(not_available);
        world.evidence.baseline.row(r).segment(16, 20).setConstant(not_available);
    }
    EXPECT_EQ(gap_data(world.evidence).cells.size(), 28u);
    EXPECT_THAT(
        leave_out_failures(world.evidence),
        ElementsAre(HasSubstr("2 of 16 runs of the scene as it stands lack values that the others have")));
    EXPECT_EQ(gap_data(world.evidence).cells.size(), 48u);
    EXPECT_EQ(DiagnosisBuilder(world.evidence, {}).diagnosis().verdict, Verdict::effect);
}

// 15 replicates in 48 bins are fewer values than 16 in 47.
TEST(MissingBins, OfSingleReplicatesAreSaid) {
    World world;
    world.evidence.library.baseline(5, 20) = not_available;
    EXPECT_THAT(leave_out_failures(world.evidence), IsEmpty());
    const Diagnosis d = DiagnosisBuilder(world.evidence, {}).diagnosis();
    ASSERT_EQ(d.missing_bins.size(), 1u);
    EXPECT_EQ(d.missing_bins[0].of, "");
    EXPECT_EQ(d.missing_bins[0].count, 1);
    EXPECT_TRUE(d.missing_bins[0].for_all);
}

// Eight replicates are the fewest with which a gap is tested.
TEST(MissingBins, LeaveEightReplicatesAtLeast) {
    SyntheticWorld synthetic(6, 3);
    Evidence evidence = synthetic.evidence(1, 9);
    synthetic.add_effect(evidence, "adhesion", synthetic.pattern(1));
    for (const Eigen::Index r : {1, 4})
        evidence.library.baseline.row(r).segment(16, 20).setConstant(not_available);
    EXPECT_THAT(leave_out_failures(evidence), IsEmpty());
    EXPECT_EQ(evidence.library.baseline.rows(), 9);
}

}  // namespace
}  // namespace mcdem::missing_bins
