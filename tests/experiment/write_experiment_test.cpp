#include <gtest/gtest.h>

#include <cmath>

#include "experiment/experiment_folder.h"
#include "experiment/from_recording.h"

namespace mcdem::test {
namespace {

void expect_same(const Experiment& a, const Experiment& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.materials, b.materials);
    EXPECT_EQ(a.uncertainty, b.uncertainty);
    EXPECT_EQ(a.plate_speed, b.plate_speed);
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

/// Numbers that no short decimal stands for, and every kind of contact.
Experiment awkward() {
    Experiment experiment;
    experiment.name = "quotes \" and \\ and µ";
    experiment.materials = {{"grains.youngs_modulus", 1e5 / 3}, {"walls.friction", 0.1 + 0.2}};
    experiment.uncertainty = {{"grains.friction", 0.01}, {"walls.youngs_modulus", 1e6}};
    experiment.plate_speed = 1e-4 / 7;
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

TEST(write_experiment, comes_back_to_the_last_digit) {
    ExperimentFolder folder;
    for (Packed packed : {Packed::plain, Packed::gzip, Packed::plain}) {
        write_experiment(folder.path(), awkward(), packed);
        expect_same(awkward(), read_experiment(folder.path()));
    }
}

TEST(write_experiment, other_containers_than_boxes_are_refused) {
    ExperimentFolder folder;
    folder["experiment.toml"] += "[container]\nshape = \"cylinder\"\n";
    EXPECT_NE(folder.error().find("container.shape must be \"box\""), std::string::npos) << folder.error();
    ExperimentFolder of_a_box;
    of_a_box["experiment.toml"] += "[container]\nshape = \"box\"\n";
    EXPECT_EQ(of_a_box.error(), "no error");
    Recording truth = awkward().recording;
    EXPECT_NO_THROW(experiment_from(truth, Instrument{}, 1));
    truth.box.shape = ContainerShape::periodic;
    EXPECT_THROW(experiment_from(truth, Instrument{}, 1), InputError);
}

TEST(write_experiment, contacts_below_the_stated_threshold_are_kept) {
    ExperimentFolder folder;
    Experiment experiment = awkward();
    experiment.recording.scans[1].contacts[0].force = Vec3(0, 0, 0.999e-3);
    write_experiment(folder.path(), experiment);
    expect_same(experiment, read_experiment(folder.path()));
}

TEST(write_experiment, without_grains_and_contacts_leaves_those_tables_out) {
    ExperimentFolder folder;
    Experiment experiment = awkward();
    write_experiment(folder.path(), experiment, Packed::gzip);
    experiment.recording.diameter.clear();
    for (Scan& scan : experiment.recording.scans) {
        scan.position.clear();
        scan.contacts.clear();
    }
    write_experiment(folder.path(), experiment);  // over the packed one: no old table may stay
    expect_same(experiment, read_experiment(folder.path()));
}

}  // namespace
}  // namespace mcdem::test
