// Regressions find the coefficients from which data were generated.
#include "diagnose/observe/overlap_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "diagnose/synthetic_scan.h"

namespace mcdem::overlap_regression {
namespace {

ContactResidual contact(int grain, int partner, double implied, double cross_contact, double residual) {
    ContactResidual c;
    c.grain = grain;
    c.partner = partner;
    c.implied = implied;
    c.cross_contact = cross_contact;
    c.measured = implied - residual;
    return c;
}

/// Six contacts per grain with random partners; overlaps from forces are uniform in 0.02 to 0.14.
std::vector<ContactResidual> random_contacts(int grains, std::uint64_t seed) {
    Random random(seed, Stream::positions);
    std::vector<ContactResidual> contacts;
    for (int k = 0; k < 3 * grains; ++k) {
        const int here = k % grains,
                  there = (here + 1 + static_cast<int>(random.uniform() * (grains - 1))) % grains;
        contacts.push_back(contact(here, there, random.uniform(0.02, 0.14), 0.05 * random.normal(), 0));
    }
    return contacts;
}

Recording grains_of(std::size_t number) {
    Recording recording;
    recording.diameter.assign(number, 0.02);
    return recording;
}

TEST(GrainOverlaps, CoefficientsAreFound) {
    auto contacts = random_contacts(50, 1);
    for (ContactResidual& c : contacts)
        c.measured =
            c.implied - (0.01 + 0.2 * c.implied - 1.5 * c.implied * c.implied + 0.7 * c.cross_contact);
    for (int k = 0; k < 30; ++k)
        contacts.push_back(contact(k, wall_partner(Wall::floor), 0.1, 0.3, 5));  // ignored
    const auto fit = grain_overlaps(grains_of(50), contacts);
    EXPECT_NEAR(fit[0], 0.01, 1e-9);
    EXPECT_NEAR(fit[1], 0.2, 1e-8);
    EXPECT_NEAR(fit[2], -1.5, 1e-7);
    EXPECT_NEAR(fit[3], 0.7, 1e-9);
    EXPECT_NEAR(fit[4], 0, 1e-9);
}

TEST(GrainOverlaps, ScatterOfContactsAndOfGrainsIsSeparated) {
    const int grains = 2000;
    auto contacts = random_contacts(grains, 2);
    Random random(3, Stream::positions);
    std::vector<double> own(static_cast<std::size_t>(grains));
    for (double& value : own) value = 0.004 * random.normal();
    for (ContactResidual& c : contacts)
        c.measured = c.implied - own[static_cast<std::size_t>(c.grain)] -
                     own[static_cast<std::size_t>(c.partner)] - 0.003 * random.normal();
    const auto fit = grain_overlaps(grains_of(own.size()), contacts);
    // 2000 values of `own` determine their standard deviation to 1.6 %; four of those errors.
    EXPECT_NEAR(fit[4], std::sqrt(2 * 0.004 * 0.004 + 0.003 * 0.003), 0.065 * 0.0064);
    EXPECT_NEAR(fit[5], 0.004, 0.065 * 0.004);
    EXPECT_LT(fit[6], 0.0012);
}

TEST(GrainOverlaps, ScatterProportionalToTheOverlapIsFound) {
    const int grains = 2000;
    auto contacts = random_contacts(grains, 2);
    Random random(3, Stream::positions);
    std::vector<double> own(static_cast<std::size_t>(grains));
    for (double& value : own) value = 0.02 * random.normal();
    const double mean = 0.08, variance = 0.12 * 0.12 / 12;
    for (ContactResidual& c : contacts)
        c.measured =
            c.implied - (own[static_cast<std::size_t>(c.grain)] + own[static_cast<std::size_t>(c.partner)]) *
                            (c.implied / mean - 1);
    const auto fit = grain_overlaps(grains_of(own.size()), contacts);
    EXPECT_NEAR(fit[6], 0.02 * variance / (mean * mean), 0.1 * 0.02 * variance / (mean * mean));
    EXPECT_LT(fit[5], 0.2 * 0.02 * variance / (mean * mean) + 0.0005);
}

// Half of the contacts pull as much as the others push: the mean overlap is zero.
TEST(GrainOverlaps, ScatterInProportionToTheOverlapIsFiniteIfGrainsAttract) {
    auto contacts = random_contacts(200, 5);
    Random random(6, Stream::positions);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        if (k % 2) contacts[k].implied = -contacts[k - 1].implied;
        contacts[k].measured = contacts[k].implied - 0.001 * random.normal();
    }
    EXPECT_LT(std::abs(grain_overlaps(grains_of(200), contacts)[6]), 0.002);
}

TEST(GrainOverlaps, RequireFiveContactsPerTerm) {
    auto contacts = random_contacts(50, 1);
    contacts.resize(19);
    for (const double value : grain_overlaps(grains_of(50), contacts)) EXPECT_TRUE(std::isnan(value));
    contacts = random_contacts(50, 1);
    contacts.resize(20);
    for (const double value : grain_overlaps(grains_of(50), contacts)) EXPECT_TRUE(std::isfinite(value));
}

TEST(ContactOccurrence, ContactsAcrossGapsAndOverlapsWithoutForceAreCounted) {
    const double d = 0.02;
    Recording recording = grains_of(5);
    recording.box = {0.2, 0.2};
    Scan scan;
    scan.plate_z = 0.2;
    const Vec3 start(0.05, 0.05, 0.05);
    scan.position = {start, start + Vec3(0.97 * d, 0, 0), start + Vec3(1.99 * d, 0, 0),
                     start + Vec3(0, 0.97 * d, 0), start + Vec3(1.99 * d, 0.997 * d, 0)};
    // 0-1 overlap and touch, 2-1 touch across a gap, 0-3 overlap without force, 2-4 hardly overlap.
    const std::vector<ContactResidual> contacts{contact(0, 1, 0.1, 0, 0), contact(2, 1, 0.01, 0, 0.05),
                                                contact(3, wall_partner(Wall::floor), 0.01, 0, 0.05),
                                                contact(4, 1, 0.1, 0, 0)};
    const auto occurrence = contact_occurrence(recording, scan, contacts);
    EXPECT_NEAR(occurrence[0], 1 / 5.0, 1e-12);
    EXPECT_NEAR(occurrence[1], 1 / 5.0, 1e-12);
}

TEST(WallOverlaps, OffsetsAndSlopesAreFound) {
    Recording recording = grains_of(40);
    recording.box = {0.2, 0.1};
    Scan scan;
    Random random(4, Stream::positions);
    std::vector<ContactResidual> contacts;
    for (int k = 0; k < 40; ++k) {
        scan.position.emplace_back(random.uniform(0, 0.2), random.uniform(0, 0.1), 0.05);
        const double u = random.uniform(0.02, 0.1), displaced = 0.05 * random.normal();
        const double x = scan.position.back().x() / 0.1 - 1, y = scan.position.back().y() / 0.05 - 1;
        contacts.push_back(
            contact(k, wall_partner(Wall::plate), u, displaced, displaced + 0.01 + 0.02 * x - 0.03 * y));
        contacts.push_back(contact(k, wall_partner(Wall::floor), u, displaced, displaced - 0.04));
        contacts.push_back(contact(k, wall_partner(k % 2 ? Wall::x_min : Wall::y_max), u, displaced,
                                   displaced + 0.005 - 0.3 * u));
        contacts.push_back(contact(k, (k + 1) % 40, u, displaced, 9));
    }
    const auto fit = wall_overlaps(recording, scan, contacts);
    const double put_in[] = {0.005, -0.3, -0.04, 0.01, 0.02, -0.03};
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(fit[static_cast<std::size_t>(k)], put_in[k], 1e-10) << k;
    contacts.resize(
        4 * 14);  // 14 plate contacts are too few for three terms, 14 side contacts are sufficient for two
    const auto fewer = wall_overlaps(recording, scan, contacts);
    EXPECT_TRUE(std::isnan(fewer[3]));
    EXPECT_NEAR(fewer[0], 0.005, 1e-10);
}

TEST(WallOverlaps, TiltOfThePlateIsFound) {
    const double radius = 0.01, slope = 0.02, overlap = 0.05;  // over R
    Lattice lattice(5, 2 * radius);
    const auto material = soft_material();
    const double compliance = (1 - 0.25) / 20e3 + (1 - 0.09) / 60e3;
    const double push = 4.0 / 3 / compliance * radius * radius * std::pow(overlap, 1.5);
    lattice.scan.contacts.clear();
    for (int grain = 100; grain < 125; ++grain) {
        Vec3& centre = lattice.scan.position[static_cast<std::size_t>(grain)];
        centre.z() = lattice.scan.plate_z + slope * (centre.x() - 0.05) - radius + overlap * radius;
        lattice.scan.contacts.push_back({grain, wall_partner(Wall::plate), Vec3::Zero(), Vec3(0, 0, -push)});
    }
    const auto fit = wall_overlaps(lattice.recording, lattice.scan,
                                   contact_residuals(lattice.recording, lattice.scan, material));
    EXPECT_NEAR(fit[3], 0, 1e-10);
    EXPECT_NEAR(fit[4], -slope * 0.05 / radius,
                1e-10);  // where the plate is higher, the overlap is smaller than measured
    EXPECT_NEAR(fit[5], 0, 1e-10);
}

}  // namespace
}  // namespace mcdem::overlap_regression
