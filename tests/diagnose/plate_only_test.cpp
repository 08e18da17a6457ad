// An experiment with only the force on its plate.
#include <gmock/gmock.h>

#include "core/errors.h"
#include "diagnose/decide/diagnose.h"
#include "diagnose/observe/needed_to_diagnose.h"
#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(NotMeasured, NamesTheFilesThatAreMissing) {
    Eigen::VectorXd observed =
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(cells_of(synthetic_grid).size()), not_available);
    observed[0] = 1;
    EXPECT_THAT(not_measured(observed, synthetic_grid),
                ElementsAre(HasSubstr("contacts.csv: "), HasSubstr("grains.csv beyond frame 0")));
    observed[8] = 1;  // floor_force
    EXPECT_THAT(not_measured(observed, synthetic_grid), ElementsAre(HasSubstr("grains.csv beyond frame 0")));
    observed[8 * 13] = 1;  // section_load
    EXPECT_THAT(not_measured(observed, synthetic_grid), IsEmpty());
}

/// Only the top force, on which the effect has the signature of the modulus.
Evidence plate_evidence(double shift, std::uint64_t seed) {
    SyntheticWorld world(1, seed);
    Evidence evidence = world.evidence(1, 32);
    const Eigen::VectorXd modulus = world.pattern(1);
    world.add_effect(evidence, "diameter_error", modulus);
    world.add_nuisance(evidence, "modulus", modulus, 1);
    evidence.observed += shift * modulus;
    return evidence;
}

TEST(PlateOnly, WithinThePriorOfTheModulusThereIsNoGap) {
    int alarms = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Evidence evidence = plate_evidence(1, seed);
        alarms += DiagnosisBuilder(evidence, {}).diagnosis().detected;
    }
    EXPECT_LE(alarms, 4);
}

TEST(PlateOnly, FarBeyondThePriorNoSingleCauseIsNamed) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Evidence evidence = plate_evidence(9, seed);
        const Diagnosis d = DiagnosisBuilder(evidence, {}).diagnosis();
        ASSERT_TRUE(d.detected) << seed;
        // With eight cells a placebo may be as good.
        EXPECT_NE(d.verdict, Verdict::effect) << seed;
        ASSERT_EQ(d.causes.size(), 2u) << seed;
        EXPECT_THAT(d.causes[0].group, ::testing::UnorderedElementsAre("diameter_error", "modulus")) << seed;
        EXPECT_NEAR(d.causes[0].confidence, d.causes[1].confidence, 1e-3) << seed;
        EXPECT_EQ(d.not_measured.size(), 2u);
        EXPECT_EQ(d.cells.size(), 8u);
    }
}

TEST(PlateOnly, LimitsStateThatTheModulusAbsorbsTheEffect) {
    const Evidence evidence = plate_evidence(0, 1);
    const Diagnosis d = DiagnosisBuilder(evidence, {}).diagnosis();
    ASSERT_EQ(d.detection_limits.size(), 1u);
    EXPECT_GT(d.detection_limits[0].absorbed_by_calibration, 0.5);
    EXPECT_THAT(d.detection_limits[0].group, Contains("modulus"));
}

TEST(PlateOnly, RequiresAFewCells) {
    Evidence evidence = plate_evidence(0, 1);
    evidence.observed.head(5).setConstant(not_available);
    EXPECT_THROW(DiagnosisBuilder(evidence, {}), InputError);
    evidence.observed[0] = 0;
    EXPECT_NO_THROW(DiagnosisBuilder(evidence, {}));
}

}  // namespace
}  // namespace mcdem
