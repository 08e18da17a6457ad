// Stress and fabric, compared with hand calculations.
#include "core/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mcdem {
namespace {

Contact contact(int grain, int partner, const Vec3& point, const Vec3& force) {
    Contact contact;
    contact.grain = grain;
    contact.partner = partner;
    contact.point = point;
    contact.force = force;
    return contact;
}

const Box box{0.5, 0.4};
const std::vector<double> diameters{0.2, 0.2};

/// Two grains side by side, with 3 N along x and friction of 1 N along y; the first also has 5 N from the
/// floor.
Scan pair() {
    Scan scan;
    scan.plate_z = 0.3;
    scan.position = {{0.1, 0.2, 0.09}, {0.29, 0.2, 0.09}};
    scan.contacts = {contact(0, wall_partner(Wall::floor), {0.1, 0.2, 0}, {0, 0, 5}),
                     contact(0, 1, {0.195, 0.2, 0.09}, {-3, 1, 0})};
    return scan;
}

TEST(Stress, OfAGrainIsTheSumOverItsContactsPerVolume) {
    const auto stress = grain_stress(box, diameters, pair());
    const double volume = std::numbers::pi / 6 * 0.008;
    Mat3 first;
    first << 0.095 * 3, -0.095, 0, 0, 0, 0, 0, 0, 0.09 * 5;
    Mat3 second;
    second << 0.095 * 3, -0.095, 0, 0, 0, 0, 0, 0, 0;
    EXPECT_TRUE(stress[0].isApprox(first / volume, 1e-12)) << stress[0];
    EXPECT_TRUE(stress[1].isApprox(second / volume, 1e-12)) << stress[1];
}

TEST(Stress, OfThePackingIsTheSumPerVolume) {
    Mat3 sum;
    sum << 0.19 * 3, -0.19, 0, 0, 0, 0, 0, 0, 0.09 * 5;
    EXPECT_TRUE(packing_stress(box, pair()).isApprox(sum / (0.5 * 0.4 * 0.3), 1e-12));
}

TEST(Stress, FabricCountsContactsBetweenGrains) {
    EXPECT_TRUE(packing_fabric(box, pair()).isApprox(Vec3(1, 0, 0).asDiagonal().toDenseMatrix(), 1e-12));
    Scan alone = pair();
    alone.contacts.resize(1);
    EXPECT_TRUE(std::isnan(packing_fabric(box, alone)(0, 0)));
}

// The contact crosses the boundary: the second grain is 0.41 to the right of the first, and 0.09 to the left
// of its image.
TEST(Stress, OfAPeriodicContainerUsesNearestImages) {
    const Box cell{0.5, 0.4, ContainerShape::periodic};
    Scan scan = pair();
    scan.position[1].x() = 0.1 - 0.19 + 3 * 0.5;
    scan.contacts = {contact(0, 1, {0.005, 0.2, 0.09}, {3, 0, 0})};
    Mat3 sum = Mat3::Zero();
    sum(0, 0) = 0.19 * 3;
    EXPECT_TRUE(packing_stress(cell, scan).isApprox(sum / (0.5 * 0.4 * 0.3), 1e-12));
    EXPECT_TRUE(packing_fabric(cell, scan).isApprox(Vec3(1, 0, 0).asDiagonal().toDenseMatrix(), 1e-12));
}

TEST(Stress, OfACylinderUsesItsVolume) {
    const Box cylinder{0.5, 0.5, ContainerShape::cylinder};
    const double share = packing_stress({0.5, 0.5}, pair())(2, 2) / packing_stress(cylinder, pair())(2, 2);
    EXPECT_NEAR(share, std::numbers::pi / 4, 1e-12);
}

}  // namespace
}  // namespace mcdem
