// Figures of merit compared with hand counts, and the choice of limits.
#include "challenge/merits.h"

#include <gtest/gtest.h>

#include "challenge/limits.h"

namespace mcdem {
namespace {

ChallengeCase truth(CaseKind kind, const std::vector<std::string>& effects = {},
                    const std::vector<std::string>& struck = {}) {
    ChallengeCase c;
    c.kind = kind;
    for (const std::string& name : effects) c.effects.push_back({name, 1});
    c.struck = struck;
    return c;
}

Answer named(const std::vector<std::string>& group, double confidence = 1) {
    return {group.size() > 1 ? Verdict::group : Verdict::effect, group, confidence};
}

void expect_share(const Share& share, int hits, int of) {
    EXPECT_EQ(share.hits, hits);
    EXPECT_EQ(share.of, of);
}

TEST(Merits, WithoutAnEffectAreCountedCorrectly) {
    const ChallengeCase none = truth(CaseKind::none);
    const Merits m = merits_of(std::vector<ScoredCase>{
        {&none, {}}, {&none, {Verdict::unknown_effect, {}, 0}}, {&none, named({"friction"})}});
    expect_share(m.false_alarms, 2, 3);
    expect_share(m.right_leaders, 0, 1);
    EXPECT_EQ(m.brier, 1);
}

TEST(Merits, AProbabilityCountsAlsoIfTheEffectIsNotNamed) {
    const ChallengeCase adhesion = truth(CaseKind::effect, {"adhesion"}),
                        soft = truth(CaseKind::unknown, {"soft_walls"});
    const Merits m =
        merits_of(std::vector<ScoredCase>{{&adhesion, {Verdict::unknown_effect, {"adhesion"}, 0.3}, 2},
                                          {&soft, {Verdict::unknown_effect, {"adhesion"}, 0.1}},
                                          {&soft, {Verdict::calibration_suspect, {"modulus"}, 0.5}},
                                          {&adhesion, named({"adhesion"}, 0.9), 2}});
    expect_share(m.right_leaders, 2, 3);
    EXPECT_NEAR(m.brier, (0.49 + 0.01 + 0.01) / 3, 1e-15);
    expect_share(m.led_by_truth, 1, 2);
    expect_share(m.truth_in_group, 1, 2);
    expect_share(m.named_unknown, 0, 2);
}

TEST(Merits, WithOneEffectAreCountedCorrectly) {
    const ChallengeCase adhesion = truth(CaseKind::effect, {"adhesion"}),
                        tilt = truth(CaseKind::effect, {"plate_tilt"});
    const Merits m = merits_of(std::vector<ScoredCase>{
        {&adhesion, named({"adhesion"}, 0.9), 2},                  // right
        {&adhesion, named({"friction", "adhesion"}, 0.6), 1.6},    // in the group
        {&adhesion, named({"friction"}, 0.8), 5},                  // wrong
        {&tilt, {Verdict::unknown_effect, {}, 0}, 3},              // detected, not named
        {&tilt, {}, 2},                                            // missed
        {&tilt, {}, 0.5},                                          // too small
        {&tilt, named({"plate_tilt", "adhesion", "friction"}), 1}  // small and named
    });
    expect_share(m.detected, 5, 7);
    expect_share(m.detected_clear, 4, 5);
    expect_share(m.led_by_truth, 1, 4);
    expect_share(m.truth_in_group, 2, 4);
    expect_share(m.named, 2, 7);
    EXPECT_DOUBLE_EQ(m.group_size, (1 + 2 + 1) / 3.0);
    EXPECT_DOUBLE_EQ(m.sharpness, (1 + 0.5) / 5);
    EXPECT_NEAR(m.brier, (0.01 + 0.36 + 0.64 + 0) / 4, 1e-15);
    expect_share(m.detected_by_effect.at("plate_tilt"), 2, 4);
    expect_share(m.named_by_effect.at("plate_tilt"), 1, 4);
}

TEST(Merits, WithTwoEffectsAreCountedCorrectly) {
    const ChallengeCase pair = truth(CaseKind::pair, {"adhesion", "plate_tilt"});
    const Merits m = merits_of(std::vector<ScoredCase>{{&pair, named({"plate_tilt"})},
                                                       {&pair, named({"plate_tilt", "adhesion"})},
                                                       {&pair, named({"plate_tilt", "adhesion", "friction"})},
                                                       {&pair, named({"friction", "adhesion"})},
                                                       {&pair, {}}});
    expect_share(m.pair_led, 3, 5);
    expect_share(m.pair_found, 1, 5);
    expect_share(m.detected, 0, 0);
}

TEST(Merits, WithAnUnknownEffectAreCountedCorrectly) {
    const ChallengeCase soft = truth(CaseKind::unknown, {"soft_walls"}),
                        struck = truth(CaseKind::unknown, {"friction"}, {"friction"});
    const ChallengeCase shifted = truth(CaseKind::outside_prior);
    const Merits m = merits_of(std::vector<ScoredCase>{{&soft, named({"adhesion"})},
                                                       {&soft, {Verdict::unknown_effect, {}, 0}},
                                                       {&struck, {}},
                                                       {&shifted, {Verdict::calibration_suspect, {}, 0}},
                                                       {&shifted, named({"adhesion"})}});
    expect_share(m.named_unknown, 1, 3);
    expect_share(m.named_by_unknown.at("soft_walls"), 1, 2);
    expect_share(m.named_by_unknown.at("struck"), 0, 1);
    expect_share(m.named_outside_prior, 1, 2);
    expect_share(m.suspected, 1, 2);
    expect_share(m.right_leaders, 0, 2);
}

/// A diagnosis of two candidates.
Findings findings(double p, double gain, double other_gain, double reduction) {
    return {p,
            {"adhesion", "friction"},
            2,
            {gain, other_gain},
            {{{0}, {1}, {0.1}, gain, 0.5, {}, {}, reduction}}};
}

TEST(ChooseLimits, UnknownEffectsGetNoNameWithoutLosingKnownOnes) {
    // Known effects remove 0.9 of their gap; effects of the library remove 0.65 of the gap of an unknown
    // one.
    const ChallengeCase known = truth(CaseKind::effect, {"adhesion"}),
                        unknown = truth(CaseKind::unknown, {"soft_walls"});
    const Findings fits = findings(1e-6, 50, 0, 0.9), does_not = findings(1e-6, 50, 0, 0.65);
    const std::vector<LimitCase> cases{{&known, &fits, 3}, {&unknown, &does_not, 0}};
    ASSERT_EQ(merits_with(cases, {}).named_unknown.hits, 1);
    const Limits limits = choose_limits(cases);
    EXPECT_EQ(merits_with(cases, limits).named_unknown.hits, 0);
    EXPECT_EQ(merits_with(cases, limits).led_by_truth.hits, 1);
    EXPECT_EQ(limits.false_alarm, Limits{}.false_alarm) << "what does not matter stays";
}

TEST(ChooseLimits, FalseAlarmsAreLimited) {
    const ChallengeCase none = truth(CaseKind::none);
    const Findings chance = findings(0.03, 5, 0, 0.9);
    const std::vector<LimitCase> cases{{&none, &chance, 0}};
    EXPECT_EQ(merits_with(cases, choose_limits(cases)).false_alarms.hits, 0);
}

}  // namespace
}  // namespace mcdem
