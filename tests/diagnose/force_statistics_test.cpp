// Statistics of the forces of one scan, compared with values computed by hand.
#include "diagnose/observe/force_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "diagnose/synthetic_scan.h"

namespace mcdem {
namespace {

constexpr double near = 1e-12;

Contact at_wall(Wall wall, const Vec3& point, const Vec3& force) {
    return {0, wall_partner(wall), point, force};
}

TEST(WallLoads, AreCorrectForAFewContacts) {
    Recording recording;
    recording.box = {0.2, 0.1};
    Scan scan;
    scan.contacts = {at_wall(Wall::plate, Vec3(0.05, 0.075, 0.1), Vec3(0.5, 0, -3)),
                     at_wall(Wall::plate, Vec3(0.15, 0.075, 0.1), Vec3(0, 0, -1)),
                     at_wall(Wall::floor, Vec3::Zero(), Vec3(0.1, 0.2, 5)),
                     at_wall(Wall::x_min, Vec3::Zero(), Vec3(0.8, 0.3, 0.3)),
                     at_wall(Wall::y_max, Vec3::Zero(), Vec3(0.3, -0.4, 0.3)),
                     {0, 1, Vec3(0.01, 0.01, 0), Vec3(9, 9, -9)}};
    scan.wall_force[static_cast<int>(Wall::plate)].z() = 4.4;
    const auto loads = wall_loads(recording, scan);
    EXPECT_NEAR(loads[0], 5 / 4.4, near);
    EXPECT_NEAR(loads[1], (0.8 + 0.4) / 4 / 4.4, near);
    EXPECT_NEAR(loads[2], 4 / 4.4, near);
    EXPECT_NEAR(loads[3], (3 * -0.5 + 1 * 0.5) / 4, near);
    EXPECT_NEAR(loads[4], 0.5, near);
}

TEST(WallLoads, RequireAForceOnThePlate) {
    Recording recording;
    recording.box = {0.2, 0.1};
    Scan scan;
    scan.contacts = {at_wall(Wall::floor, Vec3::Zero(), Vec3(0, 0, 5))};
    for (const double load : wall_loads(recording, scan)) EXPECT_TRUE(std::isnan(load));
    scan.wall_force[static_cast<int>(Wall::plate)].z() = 4.4;  // measured, but without a contact
    for (const double load : wall_loads(recording, scan)) EXPECT_TRUE(std::isnan(load));
}

TEST(ForceDistribution, IsCorrectForForcesFromOneToAHundred) {
    Recording recording;
    recording.diameter.assign(50, 0.02);
    Scan scan;
    for (int k = 1; k <= 100; ++k)
        scan.contacts.push_back(
            {0, k <= 40 ? wall_partner(Wall::floor) : 1, Vec3::Zero(), k * Vec3(2, 1, -2) / 3});
    ReferenceMaterial material = soft_material();
    material.force_threshold = 5;
    const auto d = force_distribution_numbers(recording, scan, material);
    EXPECT_NEAR(d[0], (40 + 2 * 60) / 50.0, near);
    EXPECT_NEAR(d[1], 9 / 50.0, near);  // below twice the threshold
    EXPECT_NEAR(d[2], std::log(50.5), near);
    EXPECT_NEAR(d[3], std::sqrt((100.0 * 100 - 1) / 12) / 50.5, near);
    EXPECT_NEAR(d[4], 0.15, near);  // below 15.15
    EXPECT_NEAR(d[5], 0, near);     // from 101
    EXPECT_NEAR(d[6], 95 / 50.5, near);
}

TEST(ForceDistribution, IsCorrectForStrongForces) {
    Recording recording;
    recording.diameter.assign(10, 0.02);
    Scan scan;
    for (int k = 0; k < 100; ++k) scan.contacts.push_back({0, 1, Vec3::Zero(), Vec3(k % 10 ? 1 : 11, 0, 0)});
    const auto d = force_distribution_numbers(recording, scan, soft_material());
    EXPECT_NEAR(d[5], 0.1, near);
    EXPECT_NEAR(d[6], 5.5, near);
    EXPECT_NEAR(d[3], 3 / 2.0, near);  // variance 0.9 * 1 + 0.1 * 81
}

ContactResidual residual(int grain, int partner, const Vec3& normal, double normal_force,
                         double tangential = 0) {
    ContactResidual c;
    c.grain = grain;
    c.partner = partner;
    c.normal = normal;
    c.normal_force = normal_force;
    c.tangential = tangential;
    return c;
}

/// A lattice at rest; its side walls exert 1 mN upwards on each grain that touches them.
Lattice lattice_with_wall_friction(int n) {
    constexpr double normal_force = 0.01, carried = 0.001;
    Lattice lattice(n);
    std::vector<int> side_walls(lattice.scan.position.size(), 0);
    for (Contact& contact : lattice.scan.contacts)
        if (is_wall(contact.partner) && std::abs(contact.force.z()) == 0) {
            contact.force.z() = carried;
            ++side_walls[static_cast<std::size_t>(contact.grain)];
        }
    for (Contact& contact : lattice.scan.contacts) {
        const bool from_below = contact.partner == wall_partner(Wall::floor);
        if (std::abs(contact.force.z()) < carried * 1.5 || contact.partner == wall_partner(Wall::plate))
            continue;
        const int layers_above = n - contact.grain / (n * n) - (from_below ? 0 : 1);
        const int walls = side_walls[static_cast<std::size_t>(contact.grain)];
        contact.force.z() = (from_below ? 1 : -1) * (normal_force - carried * walls * layers_above);
    }
    return lattice;
}

TEST(SectionLoad, EqualsThePlatesForceWhateverTheWallsCarry) {
    Lattice lattice = lattice_with_wall_friction(4);
    EXPECT_LT(wall_loads(lattice.recording, lattice.scan)[0], 0.8);  // the walls carry the rest
    EXPECT_NEAR(section_load(lattice.scan), 1, near);
    for (std::size_t i = 0; i < lattice.scan.position.size(); ++i)
        lattice.scan.position[i].z() += 1e-3 * std::sin(static_cast<double>(i));
    EXPECT_NEAR(section_load(lattice.scan), 1, near);
    for (Contact& contact : lattice.scan.contacts) contact.force *= 1.1;
    EXPECT_NEAR(section_load(lattice.scan), 1.1, near);
    lattice.scan.wall_force[static_cast<int>(Wall::plate)].z() *= 1.1;
    EXPECT_NEAR(section_load(lattice.scan), 1, near);
    lattice.scan.wall_force = no_wall_forces();
    EXPECT_TRUE(std::isnan(section_load(lattice.scan)));
}

// Four of a column's six vertical contacts are a fifth of the height apart, those at both ends half of that.
// The error is sqrt(4 + 2/4)/5 of the plate's, which is 5 % / sqrt(25). 400 draws determine it within 3.5 %.
TEST(SectionLoad, AveragesOverAllContacts) {
    const Lattice exact(5);
    Random random(7, Stream::measured_forces);
    double at_plate = 0, all = 0;
    for (int draw = 0; draw < 400; ++draw) {
        Scan scan = exact.scan;
        for (Contact& contact : scan.contacts) contact.force *= 1 + 0.05 * random.normal();
        at_plate += std::pow(wall_loads(exact.recording, scan)[2] - 1, 2);
        all += std::pow(section_load(scan) - 1, 2);
    }
    EXPECT_NEAR(std::sqrt(at_plate / 400), 0.01, 0.0015);
    EXPECT_NEAR(std::sqrt(all / at_plate), std::sqrt(4.5) / 5, 0.06);
}

TEST(Fabric, AnisotropyAndAttractionAreFound) {
    const Lattice lattice(2);
    Recording recording = lattice.recording;
    recording.scans = {lattice.scan};
    const std::vector<ContactResidual> alike{
        residual(0, 1, Vec3::UnitX(), 1), residual(0, 2, Vec3::UnitY(), 1), residual(0, 4, Vec3::UnitZ(), 1)};
    EXPECT_NEAR(fabric(recording, lattice.scan, alike)[0], 0, near);
    const std::vector<ContactResidual> steep{
        residual(0, 1, Vec3::UnitX(), 1), residual(0, 4, Vec3::UnitZ(), 5), residual(0, 4, Vec3::UnitX(), -1),
        residual(0, 2, Vec3::UnitX(), -1)};
    EXPECT_NEAR(fabric(recording, lattice.scan, steep)[0], 5.0 / 4 - 1.0 / 3, near);
    EXPECT_NEAR(fabric(recording, lattice.scan, steep)[3], 0.5, near);
}

TEST(Fabric, GradientWithDepthIsFound) {
    const Lattice lattice(4);
    Recording recording = lattice.recording;
    recording.scans = {lattice.scan};
    std::vector<ContactResidual> contacts;
    double sum = 0, number = 0;
    for (const Contact& contact : lattice.scan.contacts) {
        const bool wall = is_wall(contact.partner);
        const double normal_force =
            wall ? 7 : 3 - 20 * contact.point.z();  // contacts with walls do not count
        contacts.push_back(
            residual(contact.grain, contact.partner, -contact.force.normalized(), normal_force));
        if (!wall) sum += normal_force, ++number;
    }
    // In the lattice the contact point is half an edge from the centre, not half a diameter.
    recording.diameter.assign(recording.diameter.size(), Lattice::edge);
    EXPECT_NEAR(fabric(recording, lattice.scan, contacts)[1], 20 * lattice.scan.plate_z / (sum / number),
                1e-9);
}

TEST(Fabric, NonAffineDisplacementsAreFound) {
    Lattice lattice(2);
    Recording recording = lattice.recording;
    recording.scans = {lattice.scan};
    Eigen::Matrix3d map;
    map << 0.9, 0.1, 0, 0.02, 1.05, 0.03, 0, -0.04, 0.8;
    for (Vec3& position : lattice.scan.position) position = map * position + Vec3(1e-3, 2e-3, 3e-3);
    EXPECT_NEAR(fabric(recording, lattice.scan, {})[2], 0, 1e-9);
    // The signs of x y z at the corners of a cube are orthogonal to every affine function.
    const double length = 5e-4;
    for (int grain = 0; grain < 8; ++grain) {
        const int sign = (grain & 1 ? -1 : 1) * (grain & 2 ? -1 : 1) * (grain & 4 ? -1 : 1);
        lattice.scan.position[static_cast<std::size_t>(grain)] += sign * length * Vec3(2, 1, -2) / 3;
    }
    EXPECT_NEAR(fabric(recording, lattice.scan, {})[2], length / recording.diameter[0], 1e-9);
    recording.scans[0].position.clear();
    EXPECT_TRUE(std::isnan(fabric(recording, lattice.scan, {})[2]));
}

TEST(FrictionNumbers, UseOnlyStrongEnoughContacts) {
    Recording recording;
    recording.diameter.assign(2, 0.02);
    std::vector<ContactResidual> contacts;
    for (int k = 0; k < 10; ++k) {
        contacts.push_back(residual(0, 1, Vec3::UnitX(), 1, 0.03));
        contacts.push_back(residual(0, 1, Vec3::UnitX(), 1, 0.01));
        contacts.push_back(residual(0, 1, Vec3::UnitX(), 0.1, 0.09));  // too weak to count
        contacts.push_back(residual(0, wall_partner(Wall::floor), -Vec3::UnitZ(), 2, 0.1));
        contacts.push_back(residual(0, wall_partner(Wall::floor), -Vec3::UnitZ(), 2, 0.02));
    }
    const auto f = friction_numbers(recording, {}, contacts, soft_material());
    EXPECT_NEAR(f[0], 0.02, near);
    EXPECT_NEAR(f[1], 0.03, near);
    EXPECT_NEAR(f[2], 0.5, near);  // within 20 % of 0.03
    EXPECT_NEAR(f[3], 0.03, near);
    EXPECT_NEAR(f[4], 0.05, near);
    ReferenceMaterial smooth = soft_material();
    smooth.friction = 0;
    EXPECT_TRUE(std::isnan(friction_numbers(recording, {}, contacts, smooth)[2]));
}

TEST(FrictionNumbers, TorqueOfBalancedGrainsIsZero) {
    Recording recording;
    recording.diameter.assign(2, 0.02);
    ContactResidual left = residual(0, wall_partner(Wall::x_min), -Vec3::UnitX(), 1);
    ContactResidual right = residual(0, wall_partner(Wall::x_max), Vec3::UnitX(), 1);
    left.force = Vec3(1, 0.02, 0);
    right.force = Vec3(-1, 0.02, 0);
    EXPECT_NEAR(friction_numbers(recording, {}, std::vector{left, right}, soft_material())[5], 0, near);
    right.force.y() = -0.02;
    EXPECT_NEAR(friction_numbers(recording, {}, std::vector{left, right}, soft_material())[5], 1, near);
    right.force.y() = 0.01;
    EXPECT_NEAR(friction_numbers(recording, {}, std::vector{left, right}, soft_material())[5], 1.0 / 3, near);
    // Two grains in contact have torques of the same sign, which nothing balances.
    ContactResidual pair = residual(0, 1, Vec3::UnitX(), 1);
    pair.force = Vec3(-1, 0, 0.03);
    EXPECT_NEAR(friction_numbers(recording, {}, std::vector{pair}, soft_material())[5], 1, near);
    // The middle one of three has opposite torques.
    recording.diameter.assign(3, 0.02);
    ContactResidual next = residual(1, 2, Vec3::UnitX(), 1);
    next.force = Vec3(-1, 0, -0.03);
    EXPECT_NEAR(friction_numbers(recording, {}, std::vector{pair, next}, soft_material())[5], 0.5, near);
}

}  // namespace
}  // namespace mcdem
