// A lattice of spheres in equilibrium has no warnings. Then one property at a time is made wrong.
#include "experiment/check_experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "experiment/instrument.h"

namespace mcdem::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int side = 5, grains = side * side * side;
constexpr double diameter = 0.02, width = side * 0.0193, density = 100, weight = 9.81 * density * 4.18879e-6;

int number(int x, int y, int z) { return (z * side + y) * side + x; }

/// Hertz force with E = 23.3 kPa and nu = 1/2.
double force_at(double spacing) {
    return 4.0 / 3 * 23300 / 1.5 * std::sqrt(diameter / 4) * std::pow(diameter - spacing, 1.5);
}

/// A chain along an axis: spheres pressed against each other and the walls by `force`, increased by `more`
/// with each sphere.
void add_chain(Scan& scan, int axis, int a, int b, double force, double more) {
    const auto grain = [&](int k) {
        return axis == 0 ? number(k, a, b) : axis == 1 ? number(a, k, b) : number(a, b, k);
    };
    const double half = 0.5 * (axis == 2 ? scan.plate_z : width) / side;
    for (int k = 0; k <= side; ++k) {
        const Vec3 push =
            (force + more * (side - k)) * Vec3::Unit(axis);  // by the lower sphere, on the upper one
        Contact contact;
        const bool at_low_wall = k == 0, at_high_wall = k == side;
        contact.grain = at_low_wall ? grain(0) : grain(k - 1);
        contact.partner = at_low_wall    ? wall_partner(static_cast<Wall>(2 * axis))
                          : at_high_wall ? wall_partner(static_cast<Wall>(2 * axis + 1))
                                         : grain(k);
        contact.force = at_low_wall ? push : Vec3(-push);
        const Vec3& centre = scan.position[static_cast<std::size_t>(contact.grain)];
        contact.point = centre + (at_low_wall ? -half : half) * Vec3::Unit(axis);
        scan.contacts.push_back(contact);
    }
}

Scan scan_at(double plate_z) {
    Scan scan;
    scan.plate_z = plate_z;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                scan.position.push_back(Vec3((x + 0.5) * width, (y + 0.5) * width, (z + 0.5) * plate_z) /
                                        side);
    for (int a = 0; a < side; ++a)
        for (int b = 0; b < side; ++b) {
            add_chain(scan, 0, a, b, force_at(width / side), 0);
            add_chain(scan, 1, a, b, force_at(width / side), 0);
            add_chain(scan, 2, a, b, force_at(plate_z / side), weight);
        }
    scan.wall_force[static_cast<int>(Wall::plate)].z() = side * side * force_at(plate_z / side);
    return scan;
}

/// Five levels of loading and unloading, as measured by an instrument.
Experiment lattice() {
    Recording truth;
    truth.label = "lattice";
    truth.box = {width, width};
    truth.diameter.assign(grains, diameter);
    truth.plate_start = side * 0.0194;
    for (int level : {0, 1, 2, 3, 4, 3, 2, 1, 0}) {
        truth.scans.push_back(scan_at(side * (0.0194 - 0.0005 * level)));
        truth.scans.back().phase = truth.scans.size() > 5 ? Phase::unload : Phase::load;
    }
    Experiment experiment = experiment_from(truth, {{1e-4, 5e-5, 0.05, 13.5e-3}}, 1);
    for (const auto& key : material_keys())
        experiment.materials[key] = 0.1, experiment.uncertainty[key] = 0.01;
    experiment.materials["grains.youngs_modulus"] = 23300;
    experiment.materials["grains.poisson_ratio"] = 0.5;
    experiment.materials["grains.excess_density"] = density;
    return experiment;
}

TEST(check_experiment, a_packing_at_rest_has_no_warnings) {
    const ExperimentCheck check = check_experiment(lattice());
    EXPECT_THAT(check.of(Severity::odd), IsEmpty());
    EXPECT_THAT(check.of(Severity::missing),
                ElementsAre(HasSubstr("forces at walls"), HasSubstr("forces between grains")));
}

TEST(check_experiment, notes_list_the_available_data) {
    const Experiment experiment = lattice();
    const auto notes = check_experiment(experiment).of(Severity::note);
    const std::string text = fmt::format("{}", fmt::join(notes, "\n"));
    std::size_t contacts = 0;
    for (const Scan& scan : experiment.recording.scans) contacts += scan.contacts.size();
    for (const std::string& part :
         {std::string("frames: 5 of loading, 4 of unloading, cycles 0 to 0; plate at 0.097 to 0.087 m"),
          std::string("displacements 0 to 10 mm"), std::string("125 grains of 19."),
          fmt::format("{} contacts in 9 of 9 frames, between grains and with x_min, x_max", contacts),
          std::string("errors of 0.1 mm in positions, 0.05 mm in diameters, 5 % in forces; contacts seen "
                      "from 13.5 mN"),
          std::string("grains.youngs_modulus = 23300 +- 0.01"), std::string("do not cancel (median)")})
        EXPECT_THAT(text, HasSubstr(part));
}

// Without noise all forces including the weight cancel, up to rounding of the sum.
TEST(check_experiment, weight_is_part_of_the_balance) {
    Experiment experiment = lattice();
    Recording truth;
    truth.box = {width, width};
    truth.diameter.assign(grains, diameter);
    truth.scans = {scan_at(side * 0.019)};
    experiment.recording = measured(truth, {}, 1);
    const auto balance = [&] {
        const auto notes = check_experiment(experiment).of(Severity::note);
        const auto found = std::find_if(notes.begin(), notes.end(), [](const std::string& note) {
            return note.find("do not cancel") != note.npos;
        });
        return found == notes.end() ? -1 : std::stod(found->substr(found->find("bulk, ") + 6));
    };
    EXPECT_LT(balance(), 0.01);  // volume and gravity are rounded to six digits here
    experiment.materials["grains.excess_density"] = 0;
    const double sum =
        std::sqrt(4 * std::pow(force_at(width / side), 2) + 2 * std::pow(force_at(0.019) + 2.5 * weight, 2));
    EXPECT_NEAR(balance(), 100 * weight / sum, 0.2);
}

struct Spoil {
    const char* name;
    Severity severity;
    void (*spoil)(Experiment&);
    const char* found;
};
void PrintTo(const Spoil& spoil, std::ostream* out) { *out << spoil.name; }

std::vector<Scan>& scans(Experiment& e) { return e.recording.scans; }
void for_contacts(Experiment& e, const std::function<void(Contact&)>& change) {
    for (Scan& scan : scans(e))
        for (Contact& contact : scan.contacts) change(contact);
}
void drop_contacts(Scan& scan, const std::function<bool(const Contact&)>& unwanted) {
    std::erase_if(scan.contacts, unwanted);
}
void drop_wall(Experiment& e, Wall wall) {
    for (Scan& scan : scans(e))
        drop_contacts(scan, [&](const Contact& c) { return c.partner == wall_partner(wall); });
}

void begin_with_cycle_1(Experiment& e) {
    for (Scan& scan : scans(e)) scan.cycle = 1;
}

void widen_box(Experiment& e) {
    e.recording.box.size_x *= 3;
    e.recording.box.size_y *= 3;
    drop_wall(e, Wall::x_max);
    drop_wall(e, Wall::y_max);
}

void swap_numbers(Experiment& e) {
    std::swap(scans(e)[8].position[31], scans(e)[8].position[32]);
    scans(e)[8].contacts.clear();
}

void leave_out_grains(Experiment& e) {
    e.recording.diameter.clear();
    for (Scan& scan : scans(e)) scan.position.clear();
}

void name_another_partner(Experiment& e) {
    for (Contact& c : scans(e)[4].contacts)
        if (c.grain == 62 && c.partner == 63) c.partner = 64;
}

void weaken_a_contact(Experiment& e) {
    scans(e)[4].contacts[7].force *= 0.003 / scans(e)[4].contacts[7].force.norm();
}

void double_the_gauge(Experiment& e) {
    for (Scan& scan : scans(e)) scan.wall_force[5].z() *= 2;
}

void leave_out_contacts(Experiment& e) {
    drop_contacts(scans(e)[4],
                  [](const Contact& c) { return c.partner == c.grain + 25 && c.grain / 25 % 2 == 0; });
}

void leave_out_all_contacts(Experiment& e) {
    for (Scan& scan : scans(e)) scan.contacts.clear();
}

void raise_grains(Experiment& e) {
    for (Scan& scan : scans(e))
        for (Vec3& centre : scan.position) centre.z() += 3e-3;
}

class spoiled_lattice : public ::testing::TestWithParam<Spoil> {};

TEST_P(spoiled_lattice, is_reported) {
    Experiment experiment = lattice();
    const auto before = check_experiment(experiment).of(GetParam().severity);
    GetParam().spoil(experiment);
    auto after = check_experiment(experiment).of(GetParam().severity);
    std::erase_if(after,
                  [&](const std::string& text) { return std::count(before.begin(), before.end(), text); });
    EXPECT_THAT(after, Contains(HasSubstr(GetParam().found)));
}

constexpr Severity odd = Severity::odd, missing = Severity::missing;

INSTANTIATE_TEST_SUITE_P(
    plate, spoiled_lattice,
    ::testing::Values(
        Spoil{"wrong_way", odd, [](Experiment& e) { std::swap(scans(e)[2].plate_z, scans(e)[3].plate_z); },
              "the plate goes against its phase: 1 in 1 frame, first in frame 3: 0.092 m after 0.0895 m in "
              "phase load"},
        Spoil{"phases", odd, [](Experiment& e) { scans(e)[0].phase = Phase::unload; },
              "a cycle is one loading and then one unloading: 2 in 2 frames, first in frame 0: unload of "
              "cycle 0"},
        Spoil{"cycles", odd, begin_with_cycle_1,
              "cycles are left out: 1 in 1 frame, first in frame 0: cycle 1 follows -1"},
        Spoil{"start_below", odd, [](Experiment& e) { e.recording.plate_start = 0.09; },
              "plate.start, 0.09 m, is below the plate of frame 0, 0.097 m"},
        Spoil{"start_above", odd, [](Experiment& e) { e.recording.plate_start = 0.2; },
              "plate.start, 0.2 m, is more than the whole stroke above"},
        Spoil{"sign", odd, [](Experiment& e) { scans(e)[5].wall_force[5].z() = -1; },
              "the top force is negative"},
        Spoil{"falls", odd, [](Experiment& e) { scans(e)[4].wall_force[5].z() = 0.5; },
              "the top force falls before loading ends"},
        Spoil{"no_touch", odd,
              [](Experiment& e) {
                  for (Scan& scan : scans(e)) scan.plate_z += 4e-3;
              },
              "the plate carries a force above the highest grain: is plate.start right, and do these frames "
              "of the grains belong to these rows of the plate? 9 in 9 frames, first in frame 0: 3.53 mm, at "
              "a top force of"},
        Spoil{"heights", odd, raise_grains, "times that of Hertz's law from the overlaps with the plate"},
        Spoil{"unit", odd,
              [](Experiment& e) {
                  for (Scan& scan : scans(e)) scan.wall_force[5].z() *= 1000;
              },
              "the top force is 9"},
        Spoil{"no_force", odd, [](Experiment& e) { scans(e)[3].wall_force[5].z() = 0; },
              "the plate overlaps with grains as under load, but measures hardly any force: are plate.start "
              "and the height of the grains right? 1 in 1 frame, first in frame 3: 0 N"},
        Spoil{"rest", missing, [](Experiment& e) { e.recording.plate_start += 1e-3; },
              "the packing at rest before the first stroke: frame 0 is 1 mm below"},
        Spoil{"unload", missing, [](Experiment& e) { scans(e).resize(5); }, "unloading: viscoelasticity"},
        Spoil{"few", missing, [](Experiment& e) { scans(e).resize(8); },
              "frames of unloading, there are only 3"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    grains, spoiled_lattice,
    ::testing::Values(Spoil{"position_error", odd, [](Experiment& e) { e.measurement.position_error = 0; },
                            "position_error is zero"},
                      Spoil{"diameter_error", odd, [](Experiment& e) { e.measurement.diameter_error = 0; },
                            "diameter_error is zero"},
                      Spoil{"rough", odd, [](Experiment& e) { e.measurement.diameter_error = 2e-3; },
                            "positions or diameters are known to 0.1 of a diameter only"},
                      Spoil{"left_out", odd, widen_box, "the grains fill 0.064 of the box"},
                      Spoil{"in_wall", odd, [](Experiment& e) { scans(e)[3].position[0].x() = 0.003; },
                            "grains reach into a wall by more than half their radius: 1 in 1 frame, first in "
                            "frame 3: grain 0 by 6.9"},
                      Spoil{"overlap", odd, [](Experiment& e) { scans(e)[3].position[62].x() += 0.008; },
                            "grains overlap by more than 0.3 of their radii together: 1 in 1 frame, first in "
                            "frame 3: grains 62 and 63"},
                      Spoil{"jump", odd, swap_numbers,
                            "grains jump by most of a diameter from frame to frame, are they numbered "
                            "consistently? 2 in 1 frame, first in frame 8: grain 31 by 19."},
                      Spoil{"few_positions", missing, [](Experiment& e) { scans(e)[2].position.clear(); },
                            "positions in 1 of 9 frames"},
                      Spoil{"no_grains", missing, leave_out_grains, "diameters and positions"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    contacts, spoiled_lattice,
    ::testing::Values(
        Spoil{"force_error", odd, [](Experiment& e) { e.measurement.force_error = 0; },
              "force_error is zero"},
        Spoil{"apart", odd, name_another_partner,
              "contacts of grains that do not touch, are grains and frames numbered as in grains.csv? 1 in 1 "
              "frame, first in frame 4: grains 62 and 64"},
        Spoil{"point", odd, [](Experiment& e) { scans(e)[4].contacts[7].point.y() += 0.05; },
              "contact points away from their grain: 1 in"},
        Spoil{"below", odd, weaken_a_contact,
              "forces below the stated threshold of 13.5 mN: 1 in 1 frame, first in frame 4"},
        Spoil{"above", odd, [](Experiment& e) { e.measurement.force_threshold = 4e-3; },
              "the threshold is higher than the stated 4 mN"},
        Spoil{"modulus", odd, [](Experiment& e) { e.materials["grains.youngs_modulus"] = 23.3; },
              "times those of Hertz at the measured overlaps"},
        Spoil{"gauge", odd, double_the_gauge, "the contacts with the plate add up to 0.49"},
        Spoil{"balance", odd, leave_out_contacts,
              "forces on the grains do not cancel, was the packing at rest, are contacts left out? Frames: 1 "
              "in 1 frame, first in frame 4"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    left_out, spoiled_lattice,
    ::testing::Values(Spoil{"no_contacts", missing, leave_out_all_contacts,
                            "contact forces: of the packing only the top force"},
                      Spoil{"few_contacts", missing, [](Experiment& e) { scans(e)[3].contacts.clear(); },
                            "contacts in 1 of 9 frames under load"},
                      Spoil{"plate", missing, [](Experiment& e) { drop_wall(e, Wall::plate); },
                            "contacts with plate: tilt of the plate"},
                      Spoil{"side", missing, [](Experiment& e) { drop_wall(e, Wall::y_min); },
                            "contacts with y_min: the side force"},
                      Spoil{"material", missing, [](Experiment& e) { e.materials.erase("walls.friction"); },
                            "walls.friction: a diagnosis warns if a stated value is not that of the scene"},
                      Spoil{"uncertainty", missing,
                            [](Experiment& e) { e.uncertainty.erase("grains.friction"); },
                            "[uncertainty] of grains.friction: "}),
    [](const auto& info) { return info.param.name; });

TEST(check_experiment, noise_of_plate_positions_is_not_a_motion) {
    Experiment experiment = lattice();
    scans(experiment)[3].plate_z = scans(experiment)[2].plate_z + 50e-6;  // of a stroke of 10 mm
    EXPECT_THAT(check_experiment(experiment).of(Severity::odd),
                Not(Contains(HasSubstr("against its phase"))));
}

TEST(check_experiment, slow_motion_is_not_a_jump) {
    Experiment experiment = lattice();
    for (std::size_t s = 0; s < scans(experiment).size(); ++s)
        scans(experiment)[s].position[31].x() += 0.0035 * static_cast<double>(s);
    EXPECT_THAT(check_experiment(experiment).of(odd), testing::Not(Contains(HasSubstr("grains jump"))));
}

TEST(check_experiment, missing_weak_contacts_at_a_weakly_loaded_plate_are_allowed) {
    Experiment experiment = lattice();
    for (Scan& scan : scans(experiment)) scan.wall_force[5].z() = 0.5;
    for_contacts(experiment, [](Contact& contact) {
        if (contact.partner == wall_partner(Wall::plate)) contact.force *= 0.01;
    });
    EXPECT_THAT(check_experiment(experiment).of(odd), testing::Not(Contains(HasSubstr("add up to"))));
}

TEST(check_experiment, forces_with_the_wrong_sign_are_reported) {
    Experiment experiment = lattice();
    for_contacts(experiment, [](Contact& contact) { contact.force = -contact.force; });
    const auto found = check_experiment(experiment).of(odd);
    EXPECT_THAT(found, Contains(HasSubstr("many pull their grain: the force must be that on `grain`")));
    EXPECT_THAT(found, Contains(HasSubstr("the contacts with the plate add up to -0.9")));
}

TEST(check_experiment, radii_instead_of_diameters_are_reported) {
    Experiment experiment = lattice();
    for (double& d : experiment.recording.diameter) d /= 2;
    EXPECT_THAT(check_experiment(experiment).of(odd), Contains(HasSubstr("are diameters radii")));
    for (double& d : experiment.recording.diameter) d *= 2.5;
    EXPECT_THAT(check_experiment(experiment).of(odd), Contains(HasSubstr("are diameters too large")));
}

TEST(check_experiment, tangential_forces_are_reported) {
    Experiment experiment = lattice();
    for_contacts(experiment,
                 [](Contact& contact) { contact.force += 0.05 * contact.force.norm() * Vec3::Ones(); });
    EXPECT_THAT(check_experiment(experiment).of(missing), IsEmpty());
}

TEST(experiment_from, states_the_parameters_of_the_run) {
    Recording truth;
    truth.label = "run, replica";
    truth.parameters = {
        {"grains.youngs_modulus", "23300"}, {"walls.friction", "0.05"}, {"effects.adhesion", "0.1"}};
    truth.diameter = {0.02};
    truth.scans.resize(2);
    truth.scans[1].position = {Vec3::Ones()};
    truth.scans[1].contacts = {{0, wall_partner(Wall::floor), Vec3::Zero(), Vec3::UnitZ(), 0}};
    const Experiment bare = experiment_from(truth, {{0, 0, 0, 0.1}}, 1);
    EXPECT_EQ(bare.name, "run, replica");
    const std::map<std::string, double> expected{{"grains.youngs_modulus", 23300}, {"walls.friction", 0.05}};
    EXPECT_EQ(bare.materials, expected);
    EXPECT_EQ(bare.measurement.force_threshold, 0.1);
    EXPECT_TRUE(bare.recording.diameter.empty()) << "frame 0 names no grains";
    EXPECT_TRUE(bare.recording.scans[1].contacts.empty());
    truth.scans[0].position = {Vec3::Ones()};
    EXPECT_EQ(experiment_from(truth, {}, 1).recording.scans[1].contacts.size(), 1u);
}

}  // namespace
}  // namespace mcdem::test
