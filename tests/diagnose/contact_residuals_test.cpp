// Overlaps from forces and from positions, compared with Hertz's formula and with published values computed
// by hand.
#include "diagnose/observe/contact_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnose/synthetic_scan.h"

namespace mcdem {
namespace {

constexpr double pi = std::numbers::pi;

Recording grains_of(const std::vector<double>& radii) {
    Recording recording;
    recording.box = {0.2, 0.3};
    for (const double radius : radii) recording.diameter.push_back(2 * radius);
    return recording;
}

double compliance(double youngs_modulus, double nu) { return (1 - nu * nu) / youngs_modulus; }

double hertz(double effective_modulus, double reduced_radius, double overlap) {
    return 4.0 / 3 * effective_modulus * std::sqrt(reduced_radius * overlap) * overlap;
}

TEST(ContactResiduals, AgreeWithHertzForTwoUnequalGrains) {
    const ReferenceMaterial material = soft_material();
    const double here = 0.010, there = 0.015, reduced = 0.006, seen = 4e-4, implied = 5e-4;
    Scan scan;
    const Vec3 direction = Vec3(1, 2, -2) / 3;
    scan.position = {Vec3(0.1, 0.1, 0.1), Vec3(0.1, 0.1, 0.1) + (here + there - seen) * direction};
    const double force = hertz(1 / (2 * compliance(20e3, 0.5)), reduced, implied);
    scan.contacts = {{0, 1, Vec3::Zero(), -force * direction}};
    const auto residuals = contact_residuals(grains_of({here, there}), scan, material);
    ASSERT_EQ(residuals.size(), 1u);
    const ContactResidual& c = residuals[0];
    EXPECT_EQ(c.grain, 0);
    EXPECT_EQ(c.partner, 1);
    EXPECT_LT((c.normal - direction).norm(), 1e-12);
    EXPECT_NEAR(c.normal_force, force, 1e-12 * force);
    EXPECT_NEAR(c.reduced_radius, reduced, 1e-15);
    EXPECT_NEAR(c.implied, implied / reduced, 1e-12);
    EXPECT_NEAR(c.measured, seen / reduced, 1e-12);
    EXPECT_NEAR(c.residual(), (implied - seen) / reduced, 1e-12);
    EXPECT_EQ(c.cross_contact, 0);  // no other contacts
}

TEST(ContactResiduals, AgreeWithHertzAtEveryWall) {
    const ReferenceMaterial material = soft_material();
    const double radius = 0.01, seen = 3e-4, implied = 5e-4;
    const double force = hertz(1 / (compliance(20e3, 0.5) + compliance(60e3, 0.3)), radius, implied);
    const Vec3 box(0.2, 0.3, 0.15);
    for (int wall = 0; wall < wall_count; ++wall) {
        SCOPED_TRACE(name(static_cast<Wall>(wall)));
        const int axis = wall / 2;
        const bool far = wall % 2 == 1;
        Scan scan;
        scan.plate_z = box.z();
        Vec3 centre = 0.5 * box;
        centre[axis] = far ? box[axis] - radius + seen : radius - seen;
        const Vec3 outward = far ? Vec3(Vec3::Unit(axis)) : Vec3(-Vec3::Unit(axis));
        scan.position = {centre};
        scan.contacts = {{0, wall_partner(static_cast<Wall>(wall)), Vec3::Zero(), -force * outward}};
        const ContactResidual c = contact_residuals(grains_of({radius}), scan, material).at(0);
        EXPECT_EQ(c.normal, outward);
        EXPECT_EQ(c.reduced_radius, radius);
        EXPECT_NEAR(c.normal_force, force, 1e-12 * force);
        EXPECT_NEAR(c.implied, implied / radius, 1e-12);
        EXPECT_NEAR(c.measured, seen / radius, 1e-12);
    }
}

// In a cylinder of radius 2 R, 1/R* = sqrt(1/R (1/R - 1/(2 R))).
TEST(ContactResiduals, AgreeWithHertzAtTheSideOfACylinder) {
    const ReferenceMaterial material = soft_material();
    const double radius = 0.05, seen = 3e-4;
    Recording recording = grains_of({radius});
    recording.box = {0.2, 0.2};
    recording.box.shape = ContainerShape::cylinder;
    const Vec3 outward(0.6, -0.8, 0);
    Scan scan;
    scan.plate_z = 0.2;
    scan.position = {Vec3(0.1, 0.1, 0.1) + (0.1 - radius + seen) * outward};
    scan.contacts = {{0, wall_partner(Wall::x_min), Vec3::Zero(), -0.02 * outward}};
    const ContactResidual c = contact_residuals(recording, scan, material).at(0);
    EXPECT_LT((c.normal - outward).norm(), 1e-12);
    EXPECT_NEAR(c.normal_force, 0.02, 1e-15);
    EXPECT_NEAR(c.reduced_radius, radius * std::sqrt(2), 1e-12);
    EXPECT_NEAR(c.measured * c.reduced_radius, seen, 1e-12);
}

TEST(ContactResiduals, UseNearestImagesInAPeriodicContainer) {
    const double radius = 0.01, seen = 4e-4;
    Recording recording = grains_of({radius, radius});
    recording.box.shape = ContainerShape::periodic;
    Scan scan;
    scan.position = {Vec3(0.005, 0.1, 0.1), Vec3(0.2 - 0.015 + seen, 0.1 + 0.3, 0.1)};
    scan.contacts = {{0, 1, Vec3::Zero(), Vec3(0.01, 0, 0)}};
    const ContactResidual c = contact_residuals(recording, scan, soft_material()).at(0);
    EXPECT_LT((c.normal + Vec3::UnitX()).norm(), 1e-12);
    EXPECT_NEAR(c.measured * c.reduced_radius, seen, 1e-12);
}

/// Cross-contact displacement of contact 0 of a grain with two partners at an angle, in F/(E R) of the other
/// force.
double cross_contact_at(double degrees, double nu) {
    ReferenceMaterial material = soft_material();
    material.poisson_ratio = nu;
    const double radius = 0.01, first = 0.02, second = 0.05, angle = degrees * pi / 180;
    const Vec3 centre(0.1, 0.1, 0.1),
        directions[] = {Vec3::UnitX(), Vec3(std::cos(angle), 0, std::sin(angle))};
    Scan scan;
    scan.position = {centre, centre + 2 * radius * directions[0], centre + 2 * radius * directions[1]};
    scan.contacts = {{0, 1, Vec3::Zero(), -first * directions[0]},
                     {0, 2, Vec3::Zero(), -second * directions[1]}};
    const auto c = contact_residuals(grains_of({radius, radius, radius}), scan, material);
    EXPECT_NEAR(c[1].cross_contact / first, c[0].cross_contact / second, 1e-12);
    return c[0].cross_contact * c[0].reduced_radius / (second / (material.youngs_modulus * radius));
}

TEST(ContactResiduals, CrossContactAgreesWithSphereToSphere) {
    // Gonzalez & Cuitino 2012 at nu = 1/2: 3/(8 pi) (3 s^2 - 1)/s, to the tabulated digits.
    EXPECT_NEAR(cross_contact_at(60, 0.5), -0.0597, 5e-5);
    EXPECT_NEAR(cross_contact_at(90, 0.5), 0.0844, 5e-5);
    EXPECT_NEAR(cross_contact_at(120, 0.5), 0.1723, 5e-5);
    EXPECT_NEAR(cross_contact_at(180, 0.5), 0.2387, 5e-5);
    EXPECT_NEAR(cross_contact_at(180, 0.3), 1.3 / (4 * pi) * (-1.4 - 0.8 + 4.6), 1e-12);
}

TEST(ContactResiduals, CrossContactIsBoundedForVeryCloseContacts) {
    EXPECT_NEAR(cross_contact_at(0.1, 0.5), cross_contact_at(10, 0.5), 1e-12);
    EXPECT_LT(cross_contact_at(18, 0.5), 0);
}

TEST(ContactResiduals, CrossContactAddsBothGrains) {
    const double radius = 0.01, force = 0.04;
    const ReferenceMaterial material = soft_material();
    Scan scan;
    for (int grain = 0; grain < 4; ++grain) scan.position.emplace_back(0.05 + 2 * radius * grain, 0.1, 0.1);
    for (int grain = 0; grain < 3; ++grain)
        scan.contacts.push_back({grain, grain + 1, Vec3::Zero(), Vec3(-force, 0, 0)});
    const auto c = contact_residuals(grains_of({radius, radius, radius, radius}), scan, material);
    const double one_side = 3 / (4 * pi) * force / (material.youngs_modulus * radius) / (radius / 2);
    EXPECT_NEAR(c[0].cross_contact, one_side, 1e-12);
    EXPECT_NEAR(c[1].cross_contact, 2 * one_side, 1e-12);
    EXPECT_NEAR(c[2].cross_contact, one_side, 1e-12);
}

TEST(ContactResiduals, FrictionIsSeparatedAndAttractionIsNegative) {
    const double radius = 0.01;
    Scan scan;
    scan.position = {Vec3(0.1, 0.1, 0.1), Vec3(0.1, 0.1, 0.1205), Vec3(0.1, 0.1, 0.0805)};
    scan.contacts = {{0, 1, Vec3::Zero(), Vec3(0.003, 0.004, -0.02)},
                     {0, 2, Vec3::Zero(), Vec3(0, 0, -0.01)}};
    const auto c = contact_residuals(grains_of({radius, radius, radius}), scan, soft_material());
    EXPECT_NEAR(c[0].normal_force, 0.02, 1e-15);
    EXPECT_NEAR(c[0].tangential, 0.005, 1e-15);
    EXPECT_NEAR(c[0].measured, -0.0005 / 0.005, 1e-12);  // a gap
    EXPECT_NEAR(c[1].normal_force, -0.01, 1e-15);
    const double effective = 1 / (2 * compliance(20e3, 0.5));
    EXPECT_NEAR(c[1].implied, -std::pow(3 * 0.01 / (4 * effective * 0.005 * 0.005), 2.0 / 3), 1e-12);
    EXPECT_EQ(c[0].cross_contact, 0);  // attraction does not displace surfaces
    EXPECT_GT(c[1].cross_contact, 0);
}

}  // namespace
}  // namespace mcdem
