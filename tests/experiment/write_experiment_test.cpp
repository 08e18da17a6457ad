#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "core/container.h"
#include "experiment/experiment_folder.h"
#include "experiment/instrument.h"

namespace mcdem::test {
namespace {

void expect_same(const Experiment& a, const Experiment& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.materials, b.materials);
    EXPECT_EQ(a.uncertainty, b.uncertainty);
    EXPECT_EQ(a.plate_speed, b.plate_speed);
    EXPECT_EQ(a.plate_pause, b.plate_pause);
    EXPECT_EQ(a.plate_hold, b.plate_hold);
    EXPECT_EQ(a.measurement.position_error, b.measurement.position_error);
    EXPECT_EQ(a.measurement.diameter_error, b.measurement.diameter_error);
    EXPECT_EQ(a.measurement.force_error, b.measurement.force_error);
    EXPECT_EQ(a.measurement.force_threshold, b.measurement.force_threshold);
    const Recording &x = a.recording, &y = b.recording;
    EXPECT_EQ(x.box.size_x, y.box.size_x);
    EXPECT_EQ(x.box.size_y, y.box.size_y);
    EXPECT_EQ(x.plate_start, y.plate_start);
    EXPECT_EQ(x.diameter, y.diameter);
    ASSERT_EQ(x.scans.size(), y.scans.size());
    for (std::size_t s = 0; s < x.scans.size(); ++s) {
        const Scan &p = x.scans[s], &q = y.scans[s];
        EXPECT_EQ(p.cycle, q.cycle);
        EXPECT_EQ(p.phase, q.phase);
        EXPECT_EQ(p.plate_z, q.plate_z);
        EXPECT_EQ(p.top_force(), q.top_force());
        EXPECT_EQ(p.position, q.position);
        ASSERT_EQ(p.contacts.size(), q.contacts.size());
        for (std::size_t c = 0; c < p.contacts.size(); ++c) {
            EXPECT_EQ(p.contacts[c].grain, q.contacts[c].grain);
            EXPECT_EQ(p.contacts[c].partner, q.contacts[c].partner);
            EXPECT_EQ(p.contacts[c].point, q.contacts[c].point);
            EXPECT_EQ(p.contacts[c].force, q.contacts[c].force);
        }
    }
}

/// Numbers without a short decimal representation, and all kinds of contacts.
Experiment awkward() {
    Experiment experiment;
    experiment.name = "quotes \" and \\ and µ";
    experiment.materials = {{"grains.youngs_modulus", 1e5 / 3}, {"walls.friction", 0.1 + 0.2}};
    experiment.uncertainty = {{"grains.friction", 0.01}, {"walls.youngs_modulus", 1e6}};
    experiment.plate_speed = 1e-4 / 7;
    experiment.plate_pause = 100.0 / 3;
    experiment.plate_hold = 200.0 / 3;
    experiment.measurement = {1e-4 / 3, 5e-5, 0.05, 1e-3};
    Recording& recording = experiment.recording;
    recording.box = {0.1 / 3, 0.2 / 3};
    recording.plate_start = 0.1 / 7;
    recording.diameter = {0.02 / 3, 0.01, 0.011};
    for (int s = 0; s < 4; ++s) {
        Scan scan;
        scan.frame = s;
        scan.cycle = s / 2;
        scan.phase = s % 2 ? Phase::unload : Phase::load;
        scan.plate_z = 0.1 / (7 + s);
        scan.wall_force[static_cast<int>(Wall::plate)].z() = s / 3.0;
        if (s != 2)
            for (int i = 0; i < 3; ++i) scan.position.emplace_back(0.01 * i / 3, 0.01, 0.005 / (s + 1));
        if (s > 0)
            for (int partner : {1, 2, wall_partner(Wall::x_min), wall_partner(Wall::plate)})
                scan.contacts.push_back(
                    {0, partner, Vec3(0.01 / 3, 0, 0.001), Vec3(s, partner / 3.0, 1e-3), 0});
        recording.scans.push_back(scan);
    }
    return experiment;
}

TEST(write_experiment, is_read_back_to_the_last_digit) {
    ExperimentFolder folder;
    for (Packed packed : {Packed::plain, Packed::gzip, Packed::plain}) {
        write_experiment(folder.path(), awkward(), packed);
        expect_same(awkward(), read_experiment(folder.path()));
    }
}

TEST(write_experiment, containers_are_read_back_with_their_walls) {
    ExperimentFolder folder;
    for (const ContainerShape shape : {ContainerShape::cylinder, ContainerShape::periodic}) {
        Experiment experiment = awkward();
        Recording& recording = experiment.recording;
        recording.box.shape = shape;
        recording.box.size_y = recording.box.size_x = 0.1 / 3;
        if (shape == ContainerShape::periodic)
            for (Scan& scan : recording.scans)
                std::erase_if(scan.contacts, [](const Contact& contact) {
                    return contact.partner == wall_partner(Wall::x_min);
                });
        else
            for (Scan& scan : recording.scans)
                for (Vec3& centre : scan.position) centre.y() = 0.05 / 3;
        write_experiment(folder.path(), experiment);
        const Experiment back = read_experiment(folder.path());
        EXPECT_EQ(back.recording.box.shape, shape);
        expect_same(experiment, back);
        std::ifstream contacts(folder.path() / "contacts.csv");
        const std::string text(std::istreambuf_iterator<char>(contacts), {});
        EXPECT_EQ(text.find("x_min"), std::string::npos);
        EXPECT_EQ(text.find(",side,") != std::string::npos, shape == ContainerShape::cylinder);
    }
    Recording cell;
    cell.box.shape = ContainerShape::cell;
    EXPECT_THROW(experiment_from(cell, {}, 1), InputError);
}

/// The two grains, in a cylinder with a radius of 20 mm.
class InACylinder : public ExperimentFolder {
public:
    InACylinder() {
        replace("experiment.toml", "[box]\nsize = [0.04, 0.03]\n",
                "[container]\nshape = \"cylinder\"\nradius = 0.02\n");
        replace("contacts.csv", "x_min", "side");
    }
};

TEST(read_experiment, a_cylinder_is_read) {
    InACylinder folder;
    const Recording read = folder.read().recording;
    EXPECT_EQ(read.box.size_x, 0.04);
    EXPECT_EQ(read.scans[1].contacts.back().partner, wall_partner(curved_wall));
    folder.replace("contacts.csv", "side", "x_min");
    EXPECT_NE(
        folder.error().find("partner must be a grain's number or one of side, floor, plate, got \"x_min\""),
        std::string::npos)
        << folder.error();
}

TEST(read_experiment, a_cylinder_without_radius_or_with_grains_outside_is_refused) {
    InACylinder outside;
    outside.replace("grains.csv", "1,0,0.0095,0.015", "1,0,0.0095,0.001");
    EXPECT_NE(outside.error().find("grains.csv:4: centres must lie in the cylinder with a radius of 20 mm"),
              std::string::npos)
        << outside.error();
    InACylinder without;
    without.replace("experiment.toml", "radius = 0.02\n", "");
    EXPECT_NE(without.error().find("container.radius must be the inner radius"), std::string::npos)
        << without.error();
    InACylinder cell;
    cell.replace("experiment.toml", "cylinder", "cell");
    EXPECT_NE(cell.error().find("container.shape must be \"box\", \"cylinder\" or \"periodic\""),
              std::string::npos)
        << cell.error();
}

// Grains of a periodic container may be wrapped differently in each frame.
TEST(read_experiment, follows_grains_across_periodic_boundaries) {
    ExperimentFolder folder;
    folder["experiment.toml"] += "[container]\nshape = \"periodic\"\n";
    folder.replace("contacts.csv", "1,0,x_min,0,0.015,0.0095,0.004,0,0\n", "");
    folder.replace("grains.csv", "1,1,0.0305", "1,1,-0.0095");
    const Recording read = folder.read().recording;
    EXPECT_NEAR(read.scans[1].position[1].x(), 0.0305, 1e-15);
    EXPECT_EQ(read.scans[0].position[1].x(), 0.03);
    folder.replace("grains.csv", "1,1,-0.0095", "1,1,-9.5");
    EXPECT_NE(folder.error().find("centres must lie in the periodic container of 40 by 30 mm"),
              std::string::npos)
        << folder.error();
}

TEST(write_experiment, contacts_below_the_stated_threshold_are_kept) {
    ExperimentFolder folder;
    Experiment experiment = awkward();
    experiment.recording.scans[1].contacts[0].force = Vec3(0, 0, 0.999e-3);
    write_experiment(folder.path(), experiment);
    expect_same(experiment, read_experiment(folder.path()));
}

TEST(write_experiment, without_grains_and_contacts_those_tables_are_not_written) {
    ExperimentFolder folder;
    Experiment experiment = awkward();
    write_experiment(folder.path(), experiment, Packed::gzip);
    experiment.recording.diameter.clear();
    for (Scan& scan : experiment.recording.scans) {
        scan.position.clear();
        scan.contacts.clear();
    }
    write_experiment(folder.path(), experiment);  // replaces the compressed table: no old table may remain
    expect_same(experiment, read_experiment(folder.path()));
}

}  // namespace
}  // namespace mcdem::test
