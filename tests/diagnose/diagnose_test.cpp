// A planted effect from evidence to what the diagnosis says of it.
#include "diagnose/diagnose.h"

#include <gmock/gmock.h>

#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Draft, FindsAndMeasuresAPlantedEffect) {
    SyntheticWorld world(6, 3);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    world.add_effect(evidence, "friction", world.pattern(1));
    world.add_nuisance(evidence, "modulus", world.pattern(0.5), 1);
    evidence.candidates[0].unit = "J/m2";
    evidence.observed += 4 * evidence.library.effects[0].linear;
    const Draft draft(evidence, {});
    const Diagnosis d = draft.diagnosis();
    EXPECT_EQ(d.verdict, Verdict::effect);
    ASSERT_EQ(d.causes.size(), 1u);
    EXPECT_EQ(d.causes[0].effect, "adhesion");
    EXPECT_EQ(d.causes[0].unit, "J/m2");
    EXPECT_NEAR(d.causes[0].amplitude, 4, 4 * d.causes[0].amplitude_error);
    EXPECT_GT(d.causes[0].explained, 0.5);
    EXPECT_LT(d.p_value, 1e-3);
    EXPECT_FALSE(d.where.empty());
    ASSERT_EQ(d.ranking.size(), 3u);
    EXPECT_EQ(d.ranking[0].effect, "adhesion");
    ASSERT_EQ(d.nuisances.size(), 1u);
    ASSERT_TRUE(d.shrink);
    EXPECT_GT(d.shrink->fraction, 0.9);
    EXPECT_THAT(d.not_measured, ElementsAre(HasSubstr("grains.csv")));
}

TEST(Draft, AParameterPulledFarOutIsASymptom) {
    SyntheticWorld world(6, 4);
    Evidence evidence = world.evidence(1, 32);
    world.add_effect(evidence, "adhesion", world.pattern(1));
    world.add_nuisance(evidence, "modulus", world.pattern(2), 1);
    evidence.observed += 9 * evidence.library.nuisances[0].linear;
    const Diagnosis d = Draft(evidence, {}).diagnosis();
    EXPECT_EQ(d.verdict, Verdict::calibration_suspect);
    EXPECT_TRUE(d.nuisances[0].at_bound);
    EXPECT_EQ(d.causes.at(0).effect, "modulus");
}

}  // namespace
}  // namespace mcdem
