// Averages of a scan, compared with values computed by hand.
#include "sim/averages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mcdem {
namespace {

Contact contact(int grain, int partner, const Vec3& force) {
    Contact contact;
    contact.grain = grain;
    contact.partner = partner;
    contact.force = force;
    return contact;
}

Scan scan_of_three() {
    Scan scan;
    scan.plate_z = 1;
    scan.position = {{0.3, 0.5, 0.5}, {0.4, 0.5, 0.5}, {0.4, 0.62, 0.5}};
    scan.contacts = {contact(0, wall_partner(Wall::x_min), {3, 4, 0}), contact(0, 1, {-1, 0, 0}),
                     contact(1, 2, {0, 0, -0.5})};
    return scan;
}

TEST(Averages, ContactsForcesAndBranchesAreCounted) {
    Scan scan = scan_of_three();
    fill_averages(scan, {1, 1}, {0.1, 0.1, 0.1}, 0);
    EXPECT_DOUBLE_EQ(scan.coordination_number, 5.0 / 3) << "two ends of two contacts and one at the wall";
    EXPECT_DOUBLE_EQ(scan.mean_force, (5 + 1 + 0.5) / 3);
    EXPECT_DOUBLE_EQ(scan.branch_length, (0.1 + 0.12) / 2);
}

TEST(Averages, DeepestOverlapOfTwoGrainsIsFound) {
    Scan scan = scan_of_three();
    fill_averages(scan, {1, 1}, {0.15, 0.1, 0.16}, 0);
    EXPECT_NEAR(scan.max_overlap, (0.125 - 0.1) / 0.125 * 1.5, 1e-12)
        << "times the ratio of the radii; 0.01 of 0.13 times 1.6 for the other pair";
    fill_averages(scan, {1, 1}, {0.1, 0.08, 0.1}, 0);
    EXPECT_EQ(scan.max_overlap, 0) << "contacts made by surface displacement have no geometric overlap";
    scan.position[1].x() = 0.9;
    Box cell{0.51, 1};
    cell.shape = ContainerShape::periodic;
    fill_averages(scan, cell, {0.15, 0.1, 0.1}, 0);
    EXPECT_NEAR(scan.max_overlap, (0.125 - 0.09) / 0.125 * 1.5, 1e-12);
}

TEST(Averages, ContactsBelowTheThresholdAreExcluded) {
    Scan scan = scan_of_three();
    fill_averages(scan, {1, 1}, {0.1, 0.1, 0.1}, 1);
    EXPECT_DOUBLE_EQ(scan.coordination_number, 1) << "a force at the threshold counts";
    EXPECT_DOUBLE_EQ(scan.mean_force, 3);
    EXPECT_DOUBLE_EQ(scan.branch_length, 0.1);
    fill_averages(scan, {1, 1}, {0.1, 0.1, 0.1}, 10);
    EXPECT_EQ(scan.coordination_number, 0);
    EXPECT_TRUE(std::isnan(scan.mean_force));
    EXPECT_TRUE(std::isnan(scan.branch_length));
}

// Diameter 0.2 in a unit box: the averaging region extends from 0.2 to 0.8 along each axis.
TEST(Averages, PackingFractionCountsOnlyTheInnerRegion) {
    const double inner = 0.6 * 0.6 * 0.6, ball = std::numbers::pi / 6 * 0.008;
    const auto fraction = [&](const Vec3& centre) {
        return packing_fraction({centre}, {0.2}, {1, 1}, 1) * inner / ball;
    };
    EXPECT_DOUBLE_EQ(fraction({0.5, 0.5, 0.5}), 1);
    EXPECT_DOUBLE_EQ(fraction({0.3, 0.3, 0.7}), 1) << "touches the border from inside";
    EXPECT_EQ(fraction({0.09, 0.5, 0.5}), 0);
    EXPECT_NEAR(fraction({0.2, 0.5, 0.5}), 0.5, 0.01) << "cut in half by a face";
    EXPECT_NEAR(fraction({0.5, 0.8, 0.8}), 0.25, 0.01) << "by an edge";
    EXPECT_NEAR(fraction({0.2, 0.2, 0.8}), 0.125, 0.01) << "by a corner";
    // a cap of height h = R/2 has 5/32 of the sphere's volume
    EXPECT_NEAR(fraction({0.15, 0.5, 0.5}), 5.0 / 32, 0.01);
}

TEST(Averages, PackingFractionOfACylinderUsesItsInnerRegion) {
    const Box cylinder{1, 1, ContainerShape::cylinder};
    const double inner = std::numbers::pi * 0.3 * 0.3 * 0.6, ball = std::numbers::pi / 6 * 0.008;
    const auto fraction = [&](const Vec3& centre) {
        return packing_fraction({centre}, {0.2}, cylinder, 1) * inner / ball;
    };
    EXPECT_NEAR(fraction({0.5, 0.5, 0.5}), 1, 1e-12);
    EXPECT_NEAR(fraction({0.64, 0.64, 0.5}), 1, 1e-12) << "0.198 from the axis";
    EXPECT_EQ(fraction({0.8, 0.8, 0.5}), 0);
    const double a_third = 0.447;  // fraction of a sphere inside a cylinder of three times its radius, with
                                   // the centre on its surface
    EXPECT_NEAR(fraction({0.5, 0.8, 0.5}), a_third, 0.02);
    EXPECT_NEAR(fraction({0.5, 0.5, 0.8}), 0.5, 0.01);
}

TEST(Averages, PeriodicContainerUsesNearestImages) {
    const Box cell{1, 1, ContainerShape::periodic};
    const double ball = std::numbers::pi / 6 * 0.008;
    for (const Vec3& centre : {Vec3(0, 0.99, 0.5), Vec3(0.5, 0.5, 0.5), Vec3(-3.1, 0.2, 0.3)})
        EXPECT_NEAR(packing_fraction({centre}, {0.2}, cell, 1) * 0.6 / ball, 1, 1e-12);
    EXPECT_NEAR(packing_fraction({{0, 0, 0.2}}, {0.2}, cell, 1) * 0.6 / ball, 0.5, 0.01);
    Scan scan;
    scan.plate_z = 1;
    scan.position = {{0.05, 0.5, 0.5}, {1.98, -2.42, 0.5}};
    scan.contacts = {contact(0, 1, {1, 0, 0})};
    fill_averages(scan, cell, {0.1, 0.1}, 0);
    EXPECT_NEAR(scan.branch_length, std::hypot(0.07, 0.08), 1e-12);
}

TEST(Averages, PackingFractionFollowsThePlate) {
    const double whole = packing_fraction({{0.5, 0.5, 0.5}}, {0.2}, {1, 1}, 1);
    EXPECT_NEAR(packing_fraction({{0.5, 0.5, 0.5}}, {0.2}, {1, 1}, 0.9), whole * 0.6 / 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(packing_fraction({{0.5, 0.5, 0.2}}, {0.2}, {1, 1}, 0.4))) << "nothing is inside";
}

}  // namespace
}  // namespace mcdem
