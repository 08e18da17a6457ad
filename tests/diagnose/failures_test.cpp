// A failed simulation affects only the candidate or nuisance for which it was run.
#include <gmock/gmock.h>

#include "core/errors.h"
#include "diagnose/decide/diagnose.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

using World = TwoEffects;

TEST(Failures, NothingIsExcludedFromCompleteEvidence) {
    World w;
    EXPECT_THAT(leave_out_failures(w.evidence), IsEmpty());
    EXPECT_EQ(w.evidence.candidates.size(), 2u);
    EXPECT_EQ(w.evidence.library.baseline.rows(), 16);
}

TEST(Failures, ACandidateThatRunsAwayIsExcludedAlone) {
    World w;
    w.evidence.library.effects[1].linear.setConstant(not_available);
    EXPECT_THAT(leave_out_failures(w.evidence), ElementsAre(HasSubstr("friction: its runs failed")));
    const Diagnosis d = DiagnosisBuilder(w.evidence, {}).diagnosis();
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_EQ(d.causes.at(0).effect, "adhesion");
}

TEST(Failures, ANuisanceThatRunsAwayIsExcludedAlone) {
    World w;
    w.evidence.library.nuisances[0].curvature.setConstant(not_available);
    EXPECT_THAT(leave_out_failures(w.evidence), ElementsAre(HasSubstr("modulus: its runs failed")));
    EXPECT_THAT(w.evidence.nuisances, IsEmpty());
    EXPECT_NO_THROW(DiagnosisBuilder(w.evidence, {}));
}

TEST(Failures, ReplicatesWithoutNumbersAreExcluded) {
    World w;
    for (const Eigen::Index r : {2, 7}) {
        w.evidence.library.baseline.row(r).setConstant(not_available);
        w.evidence.baseline.row(r).setConstant(not_available);
    }
    EXPECT_THAT(leave_out_failures(w.evidence),
                ElementsAre(HasSubstr("2 of 16 runs of the scene as it stands failed")));
    EXPECT_EQ(w.evidence.library.baseline.rows(), 14);
    EXPECT_EQ(w.evidence.library.packing.size(), 14u);
    EXPECT_EQ(w.evidence.baseline.rows(), 14);
    EXPECT_EQ(DiagnosisBuilder(w.evidence, {}).diagnosis().verdict, Verdict::effect);
    w.evidence.library.baseline.topRows(7).setConstant(not_available);
    EXPECT_THAT([&] { leave_out_failures(w.evidence); },
                ThrowsMessage<InputError>(HasSubstr("runs of the scene")));
}

TEST(Failures, ReasonsAreStatedWhereTheyAreKnown) {
    World w;
    w.evidence.library.effects[1].linear.setConstant(not_available);
    w.evidence.library.baseline.row(3).setConstant(not_available);
    w.evidence.baseline.row(3).setConstant(not_available);
    const FailureCauses causes{{"", "too many neighbours"}, {"friction", "the force is not reached"}};
    EXPECT_THAT(leave_out_failures(w.evidence, causes),
                ElementsAre("replicates: 1 of 16 runs of the scene as it stands failed and are left out: too "
                            "many neighbours",
                            "friction: its runs failed (the force is not reached), so it cannot be tested"));
    w.evidence.library.baseline.topRows(8).setConstant(not_available);
    EXPECT_THAT([&] { leave_out_failures(w.evidence, causes); },
                ThrowsMessage<InputError>(HasSubstr("failed: too many neighbours; try `mcdem run`")));
}

// Two experiments drawn from the same noise, and an effect that no observable shows.
TEST(Failures, AnEffectThatNoObservableShowsHasNoAmplitude) {
    World w;
    w.synthetic.add_effect(w.evidence, "force_bias", Eigen::VectorXd::Zero(w.evidence.observed.size()));
    const Diagnosis d = DiagnosisBuilder(w.evidence, {}).diagnosis();
    const auto of = std::ranges::find(d.ranking, "force_bias", &Cause::effect);
    ASSERT_NE(of, d.ranking.end());
    EXPECT_EQ(of->amplitude, 0);
    EXPECT_EQ(of->amplitude_error, INFINITY);
}

}  // namespace
}  // namespace mcdem
