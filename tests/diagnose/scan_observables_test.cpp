// The observables of one scan: their positions in the vector, and NaN where data are missing.
#include "diagnose/observe/scan_observables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/input_file.h"
#include "diagnose/observe/force_statistics.h"
#include "diagnose/synthetic_scan.h"

namespace mcdem {
namespace {

/// A lattice with nonzero values of all observables: friction, and some attractive contacts.
Lattice rubbed_lattice() {
    Lattice lattice(5);
    for (std::size_t k = 0; k < lattice.scan.contacts.size(); ++k) {
        Contact& contact = lattice.scan.contacts[k];
        const double size = 1 + 0.2 * static_cast<double>(k % 7);
        contact.force *= size;
        contact.force += 1e-4 * size * Vec3(1, 1, 1);
    }
    lattice.recording.scans = {lattice.scan};
    return lattice;
}

double value_of(const Eigen::VectorXd& row, std::string_view name) {
    const auto found = std::ranges::find(observables(), name, &Observable::name);
    EXPECT_NE(found, observables().end()) << name;
    return row[found - observables().begin()];
}

void expect_known(const Eigen::VectorXd& row, const std::set<Needs>& known) {
    for (std::size_t q = 0; q < observables().size(); ++q)
        EXPECT_EQ(std::isfinite(row[static_cast<Eigen::Index>(q)]), known.contains(observables()[q].needs))
            << observables()[q].name;
}

TEST(ScanObservables, NamesAreUniqueAndComplete) {
    std::set<std::string_view> names;
    for (const Observable& observable : observables()) {
        EXPECT_TRUE(names.insert(observable.name).second) << observable.name;
        EXPECT_GT(observable.resolution, 0) << observable.name;
        EXPECT_FALSE(observable.meaning.empty()) << observable.name;
    }
}

TEST(ScanObservables, AFullScanHasAllValues) {
    const Lattice lattice = rubbed_lattice();
    const auto row = scan_observables(lattice.recording, lattice.scan, soft_material());
    ASSERT_EQ(row.size(), static_cast<Eigen::Index>(observables().size()));
    expect_known(row, {Needs::plate, Needs::contacts, Needs::positions});
}

TEST(ScanObservables, ValuesAreInTheOrderOfTheTable) {
    Lattice lattice = rubbed_lattice();
    for (Vec3& position : lattice.scan.position) position.z() += 1e-4 * position.x() / 0.05;
    for (Contact& contact : lattice.scan.contacts)
        if (contact.partner == wall_partner(Wall::plate) && contact.grain % 5 == 0) contact.force *= 2;
    const auto row = scan_observables(lattice.recording, lattice.scan, soft_material());
    const auto loads = wall_loads(lattice.recording, lattice.scan);
    EXPECT_EQ(value_of(row, "top_force"), std::log(lattice.scan.top_force()));
    EXPECT_EQ(value_of(row, "floor_force"), loads[0]);
    EXPECT_EQ(value_of(row, "plate_couple_x"), loads[3]);
    EXPECT_LT(value_of(row, "plate_couple_x"), -0.05);  // the row of grains at x = 0 carries twice as much
    EXPECT_NEAR(value_of(row, "coordination_number"), 6, 1e-12);
    EXPECT_NEAR(value_of(row, "mean_force"), std::log(0.01 * 1.6), 0.02);
    EXPECT_NEAR(value_of(row, "force_anisotropy"), 0, 0.02);
    EXPECT_EQ(value_of(row, "attraction"), 0);
    EXPECT_NEAR(value_of(row, "friction_ratio"), 0.01 * std::sqrt(2.0), 1e-3);
    EXPECT_NEAR(value_of(row, "wall_friction_ratio"), 0.01 * std::sqrt(2.0), 1e-3);
    EXPECT_EQ(value_of(row, "gap_contacts"), 0);
    EXPECT_EQ(value_of(row, "silent_overlaps"), 0);
    // At the plate and the floor, half of the lattice was shifted up by 0.1 mm, which is 0.0098 R.
    EXPECT_GT(value_of(row, "floor_overlap_offset"), value_of(row, "plate_overlap_offset"));
    EXPECT_LT(value_of(row, "plate_overlap_tilt_x"), value_of(row, "plate_overlap_tilt_y"));
}

TEST(ScanObservables, WithoutContacts) {
    Lattice lattice = rubbed_lattice();
    lattice.scan.contacts.clear();
    expect_known(scan_observables(lattice.recording, lattice.scan, soft_material()), {Needs::plate});
}

TEST(ScanObservables, WithoutPositions) {
    Lattice lattice = rubbed_lattice();
    lattice.scan.position.clear();
    expect_known(scan_observables(lattice.recording, lattice.scan, soft_material()),
                 {Needs::plate, Needs::contacts});
}

TEST(ScanObservables, WithTooFewContacts) {
    Lattice lattice = rubbed_lattice();
    const auto full = lattice.scan.contacts;
    lattice.scan.contacts.assign(full.end() - min_contacts + 1, full.end());
    expect_known(scan_observables(lattice.recording, lattice.scan, soft_material()), {Needs::plate});
    lattice.scan.contacts.assign(full.end() - min_contacts, full.end());
    EXPECT_TRUE(std::isfinite(
        value_of(scan_observables(lattice.recording, lattice.scan, soft_material()), "mean_force")));
}

TEST(ScanObservables, AllAreInTheReadme) {
    const std::string readme = read_file(MCDEM_SOURCE_DIR "/host/diagnose/README.md");
    const char* const needs[] = {"plate", "contacts", "positions", "programme"};
    std::string rows;
    for (const Observable& observable : observables())
        rows += fmt::format("| `{}` | {} | {} |\n", observable.name,
                            needs[static_cast<std::size_t>(observable.needs)], observable.meaning);
    EXPECT_NE(readme.find(rows), std::string::npos) << "host/diagnose/README.md must list:\n" << rows;
}

TEST(ScanObservables, WithoutAForceOnThePlate) {
    Lattice lattice = rubbed_lattice();
    lattice.scan.wall_force = no_wall_forces();
    const auto row = scan_observables(lattice.recording, lattice.scan, soft_material());
    for (const char* name :
         {"top_force", "floor_force", "side_force", "plate_contacts", "plate_couple_x", "plate_couple_y"})
        EXPECT_TRUE(std::isnan(value_of(row, name))) << name;
    for (const char* name : {"coordination_number", "mean_force", "cross_contact", "plate_overlap_offset"})
        EXPECT_TRUE(std::isfinite(value_of(row, name))) << name;
}

}  // namespace
}  // namespace mcdem
