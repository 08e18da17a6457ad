// When two effects are named instead of one.
#include <gmock/gmock.h>

#include "diagnose/decision_cases.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;

void leave_out_a_place(Proposal& p, double rest) {
    p.left_out = 2;
    p.rest_misfit_p = rest;
}

TEST(PairDecision, APlaceThatIsLeftOutForAPairMayBeLeftOutForOneEffect) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].misfit_p = 1e-6;
    f.proposals.push_back(proposal({1, 3}, 80, 1e-6));
    Proposal &single = f.proposals[0], &pair = f.proposals[2];
    leave_out_a_place(pair, 0.3);
    EXPECT_EQ(decide(f, limits).proposal, 2);
    leave_out_a_place(single, 0.1);
    EXPECT_EQ(decide(f, limits).proposal, 0);
    pair.left_out.reset();
    pair.misfit_p = 0.3;
    EXPECT_EQ(decide(f, limits).proposal, 2) << "two effects explain all places";
}

TEST(PairDecision, NamesAPairIfOneEffectIsNotSufficient) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].misfit_p = 1e-6;
    f.proposals[0].reduction = 0.7;
    f.proposals.push_back(proposal({1, 3}, 58.5, limits.pair_misfit));
    const Decision d = decide(f, limits);
    EXPECT_EQ(d.verdict, Verdict::effect);
    EXPECT_EQ(d.proposal, 2);
    EXPECT_THAT(d.group, ElementsAre(1, 3));
    EXPECT_THAT(contenders(f, limits), ElementsAre(0, 2));
    EXPECT_GT(d.confidence[1], 0.8) << "both are probable";
    EXPECT_EQ(d.confidence[3], d.confidence[1]);
    EXPECT_EQ(d.confidence[0], 0);

    Findings single_is_enough = f;
    single_is_enough.proposals[0].misfit_p = 0.5;
    EXPECT_EQ(decide(single_is_enough, limits).proposal, 0);
    Findings too_little = f;
    too_little.proposals[2].gain = 57.9;  // 8 more are needed
    EXPECT_EQ(decide(too_little, limits).proposal, 0);
    EXPECT_THAT(contenders(too_little, limits), ElementsAre(0));
    Findings takes_little_away = f;
    takes_little_away.proposals[0].reduction = takes_little_away.proposals[2].reduction = 0.5;
    EXPECT_EQ(decide(takes_little_away, limits).verdict, Verdict::unknown_effect);
    Findings takes_too_little_away = f;
    takes_too_little_away.proposals[2].reduction = limits.pair_reduction;
    EXPECT_EQ(decide(takes_too_little_away, limits).proposal, 2);
    takes_too_little_away.proposals[2].reduction = 0.99 * limits.pair_reduction;
    EXPECT_EQ(decide(takes_too_little_away, limits).proposal, 0);
    Findings large = f;
    large.proposals[0].gain = large.gain[1] = 1000;
    large.proposals[2].gain = 1000 + 990 * limits.second_share;
    EXPECT_EQ(decide(large, limits).proposal, 0);
    large.proposals[2].gain = 1000 + 1010 * limits.second_share;
    EXPECT_EQ(decide(large, limits).proposal, 2);
    large.proposals[0].gain = large.gain[1] = 1e5;
    large.proposals[2].gain = 1e5 + 0.99 * limits.second_certain;
    EXPECT_EQ(decide(large, limits).proposal, 0);
    large.proposals[2].gain = 1e5 + 1.01 * limits.second_certain;
    EXPECT_EQ(decide(large, limits).proposal, 2) << "whatever the first one's gain";
}

// One effect leaves only noise, but two describe the data much better.
TEST(PairDecision, NamesAPairIfTheSecondEffectGainsMuch) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].misfit_p = 0.5;
    f.proposals.push_back(proposal({1, 3}, 50 + 0.99 * limits.second_certain, 0.9));
    EXPECT_EQ(decide(f, limits).proposal, 0);
    f.proposals[2].gain = 50 + 1.01 * limits.second_certain;
    EXPECT_EQ(decide(f, limits).proposal, 2);
}

// One effect removes 69 %, two remove 99 % and leave more than noise: some other cause, or a third one.
TEST(PairDecision, APairThatLeavesMoreThanNoiseIsNotNamed) {
    Findings f = clear_case();
    const Limits limits;
    f.proposals[0].misfit_p = 1e-6;
    f.proposals[0].reduction = 0.69;
    f.proposals.push_back(proposal({1, 3}, 80, 0.99 * limits.pair_misfit, 0.99));
    EXPECT_EQ(decide(f, limits).verdict, Verdict::unknown_effect);
    EXPECT_EQ(decide(f, limits).proposal, 0);
    f.proposals[2].misfit_p = 1.01 * limits.pair_misfit;
    EXPECT_EQ(decide(f, limits).proposal, 2);
    EXPECT_EQ(decide(f, limits).verdict, Verdict::effect);
}

}  // namespace
}  // namespace mcdem
