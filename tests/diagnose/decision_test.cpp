// The verdict as a function of a few numbers.
#include "diagnose/decide/decision.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "diagnose/decision_cases.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;

double all_confidence(const Decision& d) {
    return std::accumulate(d.confidence.begin(), d.confidence.end(), 0.0);
}

// If the best effect reduces the gap clearly, the confidence is the measured success rate of such effects.
void expect_sum_of_known(const Decision& d) { EXPECT_NEAR(all_confidence(d), Limits{}.right_above, 1e-12); }

TEST(Decision, NamesOneEffect) {
    const Decision d = decide(clear_case(), {});
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_EQ(d.proposal, 0);
    EXPECT_THAT(d.group, ElementsAre(1));
    expect_sum_of_known(d);
    EXPECT_GT(d.confidence[1], 0.99 * Limits{}.right_above);
}

TEST(Decision, ConfidenceDecreasesWithTheReduction) {
    Findings f = clear_case();
    const Limits limits;
    const auto confidence = [&](double reduction) {
        f.proposals[0].reduction = reduction;
        return all_confidence(decide(f, limits));
    };
    EXPECT_NEAR(confidence(1), limits.right_above, 1e-12);
    const double certain = limits.reduction + limits.certain_above;
    EXPECT_NEAR(confidence(certain), limits.right_above, 1e-12);
    const double none = limits.reduction - limits.doubt_below;
    EXPECT_NEAR(confidence(none), limits.right_below, 1e-12);
    EXPECT_NEAR(confidence(0.25 * certain + 0.75 * none),
                0.25 * limits.right_above + 0.75 * limits.right_below, 1e-12);
    EXPECT_NEAR(confidence(limits.reduction - 0.01), limits.right_refused, 1e-12) << "not named";
    EXPECT_GT(confidence(limits.reduction), limits.right_refused);
    EXPECT_NEAR(confidence(-1), limits.right_below, 1e-12);
    f.proposals[0].confirmed_reduction = 0.96;
    EXPECT_NEAR(confidence(-1), limits.right_above, 1e-12) << "real runs count";
    f.placebo = 1 + limits.doubt_below;
    EXPECT_NEAR(confidence(-1), limits.right_below, 1e-12);
}

TEST(Decision, ReportsNoGap) {
    Findings f = clear_case();
    const Limits limits;
    f.p_value = limits.false_alarm;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::no_gap);
    f.p_value = 0.99 * limits.false_alarm;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
}

// No effect gains anything, or the runs of all of them failed.
TEST(Decision, AGapWithoutAProposalIsUnknown) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals.clear();
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect);
    EXPECT_EQ(decide(f, limits).proposal, -1);
    f.p_value = limits.false_alarm;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::no_gap);
}

TEST(Decision, GroupContainsEffectsWithinTheMarginOfTheGain) {
    Findings f = clear_case();
    f.gain = {47.5, 50, 48.5, 46.9, 20};
    Limits limits;
    limits.group = 3;
    const Decision d = decide(f, limits);
    EXPECT_EQ(d.verdict, Verdict::group);
    EXPECT_THAT(d.group, ElementsAre(1, 2, 0));
    expect_sum_of_known(d);
    EXPECT_NEAR(d.confidence[2] / d.confidence[1], std::exp(-1.5), 1e-12);
    EXPECT_NEAR(d.confidence[0] / d.confidence[1], std::exp(-2.5), 1e-12);
}

TEST(Decision, MarginGrowsWithTheGainOfTheBest) {
    Findings f = clear_case();
    f.gain = {481, 500, 479, 0, 0};
    f.proposals = {proposal({1}, 500, 0.5)};
    Limits limits;
    limits.group = 3;
    limits.group_share = 0.04;  // 20 of 500
    const Decision d = decide(f, limits);
    EXPECT_THAT(d.group, ElementsAre(1, 0));
    EXPECT_NEAR(d.confidence[0] / d.confidence[1], std::exp(-19 * 3.0 / 20), 1e-12);
}

TEST(Decision, GroupsExcludeEffectsWithoutGain) {
    Findings f = clear_case();
    f.gain = {0, 2, -0.5, 1e-3, 0};
    f.proposals = {proposal({1}, 2, 0.5)};
    EXPECT_THAT(decide(f, {}).group, ElementsAre(1, 3));
}

TEST(Decision, CalibrationIsSuspectIfANuisanceIsBest) {
    Findings f = clear_case();
    f.gain = {10, 58, 2, 0, 60};
    f.proposals = {proposal({4}, 60, 0.5), proposal({1}, 58, 0.5)};
    const Decision d = decide(f, {});
    EXPECT_EQ(d.verdict, Verdict::calibration_suspect);
    EXPECT_THAT(d.group, ElementsAre(4, 1));
    f.effects = 5;  // if it were an effect
    EXPECT_EQ(decide(f, {}).verdict, Verdict::group);
}

TEST(Decision, CalibrationIsSuspectIfANuisanceIsNearlyAsGood) {
    Findings f = clear_case();
    const Limits limits;
    f.gain[4] = 50 - 0.99 * limits.group;
    f.proposals[1].gain = f.gain[4];
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect) << "which takes little of the gap away";
    f.proposals[1].reduction = 0.9;
    Decision d = decide(f, limits);
    EXPECT_EQ(d.verdict, Verdict::calibration_suspect);
    EXPECT_THAT(d.group, ElementsAre(4, 1));
    EXPECT_EQ(d.proposal, 1);
    f.gain[4] = f.proposals[1].gain = 50 - 1.01 * limits.group;
    d = decide(f, limits);
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_EQ(d.proposal, 0);
}

// Numerical errors are suspected first: before effects and before stated parameters.
TEST(Decision, NotConvergedIfNumericsAreNearlyAsGood) {
    Findings f = clear_case();
    f.gain = {49, 50, 48.5, 0, 49};
    f.proposals = {proposal({1}, 50, 0.5), proposal({2}, 48.5, 0.5), proposal({4}, 49, 0.5)};
    EXPECT_EQ(decide(f, {}).verdict, Verdict::calibration_suspect);
    f.numerics = {2};
    Decision d = decide(f, {});
    EXPECT_EQ(d.verdict, Verdict::not_converged);
    EXPECT_EQ(d.group.front(), 2u);
    EXPECT_EQ(d.proposal, 1);
    f.proposals[1].confirmed_reduction = 0.2;
    EXPECT_EQ(decide(f, {}).verdict, Verdict::calibration_suspect) << "real runs of it take little away";
    f = clear_case();
    f.numerics = {2};
    EXPECT_EQ(decide(f, {}).verdict, Verdict::effect) << "far behind";
}

TEST(Decision, NotConvergedIfNumericsArePartOfThePair) {
    Findings f = clear_case();
    f.proposals[0].misfit_p = 1e-6;
    f.proposals[0].reduction = 0.7;
    f.proposals.push_back(proposal({1, 3}, 80, 0.5));
    f.numerics = {3};
    const Decision d = decide(f, {});
    EXPECT_EQ(d.verdict, Verdict::not_converged);
    EXPECT_EQ(d.proposal, 2);
    EXPECT_THAT(d.group, ElementsAre(3, 1));
}

TEST(Decision, UnknownIfConfirmationRunsHaveNoGain) {
    Findings f = clear_case();
    for (Proposal& p : f.proposals) p.confirmed_gain = -1;
    EXPECT_EQ(decide(f, {}).verdict, Verdict::unknown_effect);
    f.proposals[0].confirmed_gain = 1;
    EXPECT_EQ(decide(f, {}).verdict, Verdict::effect);
}

TEST(Decision, UnknownIfTheBestReducesTheGapLittle) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].reduction = limits.reduction - 0.01;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "whatever its likelihood and its misfit";
    EXPECT_EQ(decide(f, limits).proposal, 0);
    f.proposals[0].reduction = limits.reduction;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
    f.proposals[0].confirmed_reduction = 0.5;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "real runs count";
}

// The reduction of a small gap in held-out data is uncertain by its noise.
TEST(Decision, ABadlyMeasuredReductionMayBeSmallerByItsNoiseIfOnlyNoiseIsLeft) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].misfit_p = limits.only_noise;
    f.proposals[0].reduction = 0.45;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "the gap is well measured";
    f.held_out_noise = 0.2;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
    EXPECT_NEAR(explanation_of(f, decide(f, limits), limits)->needed, limits.reduction - 0.2, 1e-12);
    EXPECT_LT(all_confidence(decide(f, limits)), limits.right_above - 0.1)
        << "less certain than with a large reduction";
    f.proposals[0].reduction = 0.39;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect);
    f.held_out_noise = 0.45;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
    f.proposals[0].reduction = 0.99 * limits.min_reduction;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "whatever the noise";
    f.proposals[0].reduction = 0.39;
    f.placebo = 0.3;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "the placebo does nearly as much";
    f.placebo = 0;
    f.proposals[0].misfit_p = 0.99 * limits.only_noise;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "more than noise is left";
}

TEST(Decision, UnknownIfAPlaceboIsNearlyAsGood) {
    Findings f = clear_case();
    const Limits limits;
    f.placebo = f.proposals[0].reduction - 0.99 * limits.over_placebo;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect);
    f.placebo = f.proposals[0].reduction - 1.01 * limits.over_placebo;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
}

// An effect that removes most of a gap, but leaves a clear part of it, is not the cause.
TEST(Decision, UnknownIfASignificantPartOfTheGapRemains) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].reduction = 1 - 1.01 * limits.remainder;
    f.proposals[0].misfit_p = 0.99 * limits.misfit;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect);
    EXPECT_NEAR(all_confidence(decide(f, limits)), limits.right_refused, 1e-12);
    EXPECT_EQ(explanation_of(f, decide(f, limits), limits)->needed, 1 - limits.remainder);
    f.proposals[0].misfit_p = 1.01 * limits.misfit;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
    EXPECT_EQ(explanation_of(f, decide(f, limits), limits)->needed, limits.reduction);
    f.proposals[0].misfit_p = limits.another_form;
    f.proposals[0].reduction = 1 - 0.99 * limits.remainder;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
    f.proposals[0].misfit_p = 0.99 * limits.another_form;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect) << "another effect is more probable";
    f.proposals[0].reduction = 1 - 0.99 * limits.form_remainder;
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
}

// If numerics are best they must be refined first, whatever part of the gap remains.
TEST(Decision, NotConvergedEvenIfNumericsLeaveAGap) {
    Findings f = clear_case();
    f.proposals[0].reduction = 0.7;
    f.proposals[0].misfit_p = 1e-9;
    f.numerics = {1};
    EXPECT_EQ(decide(f, {}).verdict, Verdict::not_converged);
}

TEST(Decision, ASmallRemainderIsStatedAndDoesNotChangeTheVerdict) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].confirmed_reduction = 0.97;
    f.proposals[0].confirmed_misfit_p = 1e-30;
    const Decision d = decide(f, limits);
    EXPECT_EQ(d.verdict, Verdict::effect);
    const Explanation e = explanation_of(f, d, limits).value();
    EXPECT_EQ(e.reduction, 0.97);
    EXPECT_NEAR(e.remainder(), 0.03, 1e-12);
    EXPECT_TRUE(e.leaves_more_than_noise);
    EXPECT_TRUE(e.simulated);
    EXPECT_EQ(e.placebo, 0.1);
    EXPECT_EQ(e.needed, 1 - limits.form_remainder);
    f.p_value = 1;
    EXPECT_FALSE(explanation_of(f, decide(f, limits), limits)) << "no gap, nothing to explain";
}

TEST(Decision, AVerySignificantRemainderMayHaveAnotherCause) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].misfit_p = 2 * limits.another_form;
    expect_sum_of_known(decide(f, limits));
    f.proposals[0].misfit_p = limits.another_form / 2;
    const Decision d = decide(f, limits);
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_NEAR(all_confidence(d), limits.right_form, 1e-12);
}

TEST(Decision, ConfirmationRunsReplaceSignatures) {
    Findings f = clear_case();
    f.gain = {10, 50, 2, 0, 49};
    f.proposals = {proposal({1}, 50, 0.5), proposal({4}, 49, 0.5)};
    f.proposals[0].confirmed_gain = 30;
    f.proposals[1].confirmed_gain = 44;
    Decision d = decide(f, {});
    EXPECT_EQ(d.verdict, Verdict::calibration_suspect);
    EXPECT_EQ(d.proposal, 1);
    EXPECT_THAT(d.group, ElementsAre(4));
    f.proposals[1].confirmed_reduction = 0.2;
    EXPECT_EQ(decide(f, {}).verdict, Verdict::unknown_effect);
    f.proposals[1].reduction = 0.2;
    f.proposals[1].confirmed_reduction = 0.9;
    EXPECT_EQ(decide(f, {}).verdict, Verdict::calibration_suspect);
}

// Adhesion was not simulated. By signatures it was 1 behind the best effect, half of whose gain remained in
// the confirmation runs.
TEST(Decision, EffectsWithoutConfirmationKeepTheirDistanceBySignatures) {
    Findings f = clear_case();
    f.gain = {49, 50, 2, 0, 20};
    f.proposals[0].confirmed_gain = 25;
    const Decision d = decide(f, {});
    EXPECT_THAT(d.group, ElementsAre(1, 0));
    EXPECT_NEAR(d.confidence[0] / d.confidence[1], std::exp(-1.0), 1e-12);
    f.gain[0] = 30;  // more than the part of the best effect's 50 that remained in the confirmation runs
    EXPECT_THAT(decide(f, {}).group, ElementsAre(1));
}

TEST(Decision, IsAFunctionOfTheFindings) {
    const Findings f = clear_case();
    const Decision a = decide(f, {}), b = decide(f, {});
    EXPECT_EQ(a.verdict, b.verdict);
    EXPECT_EQ(a.group, b.group);
    EXPECT_EQ(a.confidence, b.confidence);
}

}  // namespace
}  // namespace mcdem
