#include "metrics/stress_strain.h"

#include <gmock/gmock.h>

#include <numbers>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

TEST(StressStrain, TriaxialCompressionFollowsSoilMechanics) {
    const Mat3 stress = Vec3(1, 1, 4).asDiagonal();
    EXPECT_NEAR(mean_stress(stress), 2, 1e-15);
    EXPECT_NEAR(deviatoric_stress(stress), 3, 1e-15);
    const Strain strain{0, 0, 1 - std::exp(-0.3), 0, 0, 0};
    EXPECT_NEAR(volume_strain(strain), 1 - std::exp(-0.3), 1e-15);
    EXPECT_NEAR(deviatoric_strain(strain), 0.2, 1e-15);
}

TEST(StressStrain, ShearGivesRootThreeTimesTheStress) {
    Mat3 stress = Mat3::Zero();
    stress(0, 2) = stress(2, 0) = -5;
    EXPECT_NEAR(deviatoric_stress(stress), 5 * std::numbers::sqrt3, 1e-14);
    EXPECT_NEAR(deviatoric_strain({0, 0, 0, 0, 1e-4, 0}), 1e-4 / std::numbers::sqrt3, 1e-12);
    EXPECT_NEAR(volume_strain({0, 0, 0, 0.3, 0.1, -0.2}), 0, 1e-15);
}

TEST(StressStrain, AnIsotropicStateHasNoDeviator) {
    Mat3 stress = 3 * Mat3::Identity();
    stress(0, 1) = 1, stress(1, 0) = -1;  // the antisymmetric part is ignored
    EXPECT_NEAR(deviatoric_stress(stress), 0, 1e-15);
    EXPECT_NEAR(deviatoric_strain({0.1, 0.1, 0.1, 0, 0, 0}), 0, 1e-15);
}

TEST(StrongestScan, HasTheLargestForceOrInACellTheLargestMeanStress) {
    auto pressed = synthetic::recording({.levels = 3});
    EXPECT_EQ(strongest_scan(pressed), 2u);
    auto cell = synthetic::cell("mc_dem");
    EXPECT_EQ(strongest_scan(cell), 1u);
    cell.scans[3].stress *= 2;
    EXPECT_EQ(strongest_scan(cell), 3u);
    for (Scan& scan : cell.scans) scan.stress = unknown_tensor();
    EXPECT_FALSE(strongest_scan(cell));
}

}  // namespace
}  // namespace mcdem
