#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "experiment/experiment_folder.h"

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Vec3 on(const Scan& scan, Wall wall) { return scan.wall_force[static_cast<std::size_t>(wall)]; }

TEST(read_experiment, settings_and_plate_are_read) {
    ExperimentFolder folder;
    const Experiment experiment = folder.read();
    EXPECT_EQ(experiment.name, "two grains");
    EXPECT_EQ(experiment.recording.label, "two grains");
    EXPECT_EQ(experiment.recording.box.size_y, 0.03);
    EXPECT_EQ(experiment.recording.plate_start, 0.022);  // the highest position, if none is given
    const std::map<std::string, double> materials{{"grains.youngs_modulus", 23300},
                                                  {"grains.poisson_ratio", 0.5},
                                                  {"grains.friction", 0.03},
                                                  {"walls.youngs_modulus", 50e6}};
    EXPECT_EQ(experiment.materials, materials);
    const std::map<std::string, double> sigma{{"grains.youngs_modulus", 500}, {"walls.youngs_modulus", 1e6}};
    EXPECT_EQ(experiment.uncertainty, sigma);
    EXPECT_EQ(experiment.measurement.position_error, 1e-4);
    EXPECT_EQ(experiment.measurement.force_error, 0);
    EXPECT_EQ(experiment.measurement.force_threshold, 0.005);
    EXPECT_EQ(experiment.recording.parameters.at("grains.youngs_modulus"), "23300");

    const auto& scans = experiment.recording.scans;
    ASSERT_EQ(scans.size(), 3u);
    EXPECT_EQ(scans[2].frame, 2);
    EXPECT_EQ(scans[1].phase, Phase::load);
    EXPECT_EQ(scans[2].phase, Phase::unload);
    EXPECT_EQ(scans[1].top_force(), 0.4);
    EXPECT_EQ(experiment.recording.displacement(scans[1]), 0.022 - 0.019);
}

TEST(read_experiment, averages_use_only_contacts_above_the_threshold) {
    ExperimentFolder folder;
    const auto recording = folder.read().recording;
    const Scan& scan = recording.scans[1];
    ASSERT_EQ(scan.contacts.size(), 5u);
    EXPECT_DOUBLE_EQ(scan.coordination_number,
                     (2 + 3) / 2.0);  // one pair, three walls; the contact at x_min is below 5 mN
    EXPECT_DOUBLE_EQ(scan.mean_force, (0.05 + 0.2 + 0.3 + 0.2) / 4);
    EXPECT_DOUBLE_EQ(scan.branch_length, 0.0305 - 0.0095);
    EXPECT_TRUE(std::isnan(scan.packing_fraction));
    EXPECT_TRUE(std::isnan(scan.elastic_energy));
    EXPECT_TRUE(std::isnan(scan.contacts[0].overlap));
    EXPECT_DOUBLE_EQ(on(scan, Wall::floor).z(), -0.5);
    EXPECT_DOUBLE_EQ(on(scan, Wall::x_min).x(), -0.004);
    EXPECT_EQ(on(scan, Wall::plate).z(), 0.4);           // from the gauge, not from the contacts
    EXPECT_TRUE(std::isnan(on(scan, Wall::x_max).x()));  // no contact with this wall was measured
}

TEST(read_experiment, a_contact_from_the_other_side_is_reversed) {
    ExperimentFolder folder;
    const auto recording = folder.read().recording;
    const Contact& contact = recording.scans[1].contacts[0];
    EXPECT_EQ(contact.grain, 0);
    EXPECT_EQ(contact.partner, 1);
    EXPECT_EQ(contact.force, Vec3(-0.03, 0, -0.04));
}

TEST(read_experiment, frames_without_contacts_or_positions_have_unknown_values) {
    ExperimentFolder folder;
    const auto recording = folder.read().recording;
    EXPECT_TRUE(std::isnan(recording.scans[2].coordination_number));
    EXPECT_TRUE(std::isnan(on(recording.scans[2], Wall::floor).z()));
    EXPECT_TRUE(recording.scans[2].position.empty());
    EXPECT_EQ(recording.scans[0].position.size(), 2u);
}

TEST(read_experiment, the_plate_alone_is_sufficient) {
    ExperimentFolder folder;
    folder.remove("grains.csv");
    folder.remove("contacts.csv");
    folder["experiment.toml"] = "[box]\nsize = [0.04, 0.03]\n";
    const Experiment experiment = folder.read();
    EXPECT_EQ(experiment.recording.scans.size(), 3u);
    EXPECT_TRUE(experiment.recording.diameter.empty());
    EXPECT_FALSE(experiment.name.empty());
}

TEST(read_experiment, compressed_tables_comments_other_columns_and_line_ends_are_read) {
    ExperimentFolder folder;
    const auto expected = folder.read().recording;
    folder["plate.csv"] =
        "# by hand\r\n\r\ntop_force_N, plate_z_m ,operator,phase,cycle,frame\r\n0,0.022,A,load,0,0\r\n"
        "# pause\r\n0.4,0.019,B,load,0,1\r\n+1e-2,0.021,,unload,0,2";
    folder.read();
    ASSERT_EQ(std::system(("gzip " + (folder.path() / "contacts.csv").string()).c_str()), 0);
    const auto found = read_experiment(folder.path()).recording;
    ASSERT_EQ(found.scans.size(), 3u);
    EXPECT_EQ(found.scans[2].top_force(), 0.01);
    EXPECT_EQ(found.scans[2].phase, Phase::unload);
    EXPECT_EQ(found.scans[1].contacts.size(), expected.scans[1].contacts.size());
    EXPECT_EQ(found.scans[1].mean_force, expected.scans[1].mean_force);
}

struct Spoiled {
    std::string file, from, to, message;
};
class spoiled_experiment : public ::testing::TestWithParam<Spoiled> {};

TEST_P(spoiled_experiment, is_reported_with_line_and_remedy) {
    ExperimentFolder folder;
    folder.replace(GetParam().file, GetParam().from, GetParam().to);
    EXPECT_THAT(folder.error(), StartsWith(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    plate, spoiled_experiment,
    ::testing::Values(
        Spoiled{"plate.csv", "top_force_N", "force",
                "plate.csv:1: the header must name top_force_N once, got it 0 times"},
        Spoiled{"plate.csv", "cycle", "frame",
                "plate.csv:1: the header must name frame once, got it 2 times"},
        Spoiled{"plate.csv", "0.022", "22", "plate.csv:2: plate_z_m must be in metres"},
        Spoiled{"plate.csv", "0.022", "-0.022", "plate.csv:2: plate_z_m must be > 0 [m]"},
        Spoiled{"plate.csv", "2,0,unload", "3,0,unload", "plate.csv:4: frame must be 2, got 3"},
        Spoiled{"plate.csv", "0,0,load", "0,1,load", "plate.csv:3: cycle must not fall, got 0 after 1"},
        Spoiled{"plate.csv", "unload", "release",
                "plate.csv:4: phase must be one of load, unload, got \"release\""},
        Spoiled{"plate.csv", "0.4", "400", "plate.csv:3: top_force_N must be in newtons: 400 is a pressure"},
        Spoiled{"plate.csv", "0.4", "nan", "plate.csv:3: top_force_N must be a finite number, got \"nan\""},
        Spoiled{"plate.csv", "0.4", "", "plate.csv:3: top_force_N must be a finite number, got \"\""},
        Spoiled{"plate.csv", ",0.4", "", "plate.csv:3: must have 5 columns as the header, got 4"},
        Spoiled{"plate.csv", "1,0,load", "1.5,0,load",
                "plate.csv:3: frame must be a whole number from 0 on, got \"1.5\""}));

INSTANTIATE_TEST_SUITE_P(
    grains, spoiled_experiment,
    ::testing::Values(
        Spoiled{"grains.csv", "0,1,0.03", "0,2,0.03", "grains.csv:3: grain must be 0 to 1, got 2"},
        Spoiled{"grains.csv", "0,1,0.03", "0,0,0.03", "grains.csv:3: grain 0 is there twice in frame 0"},
        Spoiled{"grains.csv", "1,1,0.0305,0.015,0.0095,0.02\n", "",
                "grains.csv:4: frame 1 must list all 2 grains, but grain 1"},
        Spoiled{"grains.csv", "1,1,0.0305", "0,1,0.0305",
                "grains.csv:5: frames must be in order, got 0 after 1"},
        Spoiled{"grains.csv", "1,1,0.0305", "7,1,0.0305",
                "grains.csv:5: frame must be one of plate.csv, 0 to 2, got 7"},
        Spoiled{"grains.csv", "0.01,0.02\n", "0.01,20\n", "grains.csv:2: diameter_m must be in metres"},
        Spoiled{"grains.csv", "0.01,0.02\n", "0.01,0\n", "grains.csv:2: diameter_m must be > 0 [m]"},
        Spoiled{"grains.csv", "0,0,0.01", "0,0,10", "grains.csv:2: centres must lie in the box"},
        Spoiled{"grains.csv", "0.015,0.01,", "0.015,10,",
                "grains.csv:2: centres must lie in the box of 40 by 30 mm"},
        Spoiled{"grains.csv", "0.015,0.01,", "0.015,-0.01,", "grains.csv:2: centres must lie in the box"},
        Spoiled{"grains.csv", "0.0095,0.02\n", "0.0095,0.03\n",
                "grains.csv:4: grain 0 must be as large as in frame 0, 0.02 m, got 0.03: number the grains"},
        Spoiled{"grains.csv", "1,1,0.0305", "1,0,0.0305", "grains.csv:5: grain 0 is there twice in frame 1"},
        Spoiled{"grains.csv", "0,0,0.01", "1,0,0.01", "grains.csv:2: the first frame must be 0"},
        Spoiled{"grains.csv", "0,0,0.01", "0,0,inf", "grains.csv:2: x_m must be a finite number"}));

INSTANTIATE_TEST_SUITE_P(
    contacts, spoiled_experiment,
    ::testing::Values(Spoiled{"contacts.csv", "1,0,floor", "1,5,floor",
                              "contacts.csv:3: grain must be a grain of grains.csv, 0 to 1, got 5"},
                      Spoiled{"contacts.csv", "1,1,0,", "1,1,9,",
                              "contacts.csv:2: partner must be a grain of grains.csv, 0 to 1, got 9"},
                      Spoiled{"contacts.csv", "1,1,0,", "1,1,1,",
                              "contacts.csv:2: grain 1 cannot touch itself"},
                      Spoiled{"contacts.csv", "floor", "bottom",
                              "contacts.csv:3: partner must be a grain's number or one of x_min"},
                      Spoiled{"contacts.csv", "1,1,floor", "1,0,floor",
                              "contacts.csv:4: this contact is there twice in frame 1, first in line 3"},
                      Spoiled{"contacts.csv", "1,0,floor", "1,0,1",
                              "contacts.csv:3: this contact is there twice in frame 1, first in line 2"},
                      Spoiled{"contacts.csv", "0,0,0.2", "0,0,200",
                              "contacts.csv:3: fx_N, fy_N and fz_N must be in newtons: 200 is more than"},
                      Spoiled{"contacts.csv", "0.015,0.0095,0.03", "0.015,9.5,0.03",
                              "contacts.csv:2: x_m, y_m and z_m must lie in the box"},
                      Spoiled{"contacts.csv", "0,0,0.2", "0,0,NaN",
                              "contacts.csv:3: fz_N must be a finite number, got \"NaN\""},
                      Spoiled{"contacts.csv", "1,1,floor", "0,1,floor",
                              "contacts.csv:4: frames must be in order, got 0 after 1"},
                      Spoiled{"contacts.csv", "1,0,floor", "3,0,floor",
                              "contacts.csv:3: frame must be one of plate.csv, 0 to 2, got 3"},
                      Spoiled{"contacts.csv", "1,1,0,0.02", "1,1,0,20",
                              "contacts.csv:2: x_m, y_m and z_m must lie in the box"}));

INSTANTIATE_TEST_SUITE_P(
    settings, spoiled_experiment,
    ::testing::Values(
        Spoiled{"experiment.toml", "[0.04, 0.03]", "[40.0, 30.0]",
                "experiment.toml:3: box.size must be > 0 and <= 20 [m], got 40"},
        Spoiled{"experiment.toml", "[0.04, 0.03]", "[0.04]",
                "experiment.toml:3: box.size must be the inner width and depth"},
        Spoiled{"experiment.toml", "size", "sizes", "experiment.toml: box.size must be"},
        Spoiled{"experiment.toml", "[box]\nsize = [0.04, 0.03]",
                "[container]\nshape = \"cylinder\"\nradius = 60",
                "experiment.toml:4: container.radius must be a number > 0 and <= 10 [m], got 60"},
        Spoiled{"experiment.toml", "[grains]", "[plate]\nstart = 156\n[grains]",
                "experiment.toml:5: plate.start must be a number > 0 and <= 100 [m], got 156"},
        Spoiled{"experiment.toml", "0.5", "0.6",
                "experiment.toml:6: grains.poisson_ratio must be a number between 0 and 0.5, got 0.6"},
        Spoiled{"experiment.toml", "23300.0", "\"soft\"",
                "experiment.toml:5: grains.youngs_modulus must be a number > 0"},
        Spoiled{"experiment.toml", "friction", "fricton",
                "experiment.toml:7: grains.fricton is not a key of an experiment"},
        Spoiled{"experiment.toml", "walls.youngs", "wall.youngs",
                "experiment.toml:12: uncertainty.wall is not a key"},
        Spoiled{"experiment.toml", "500.0", "-1.0",
                "experiment.toml:11: uncertainty.youngs_modulus must be a number between 0 and 1e+15 [Pa], "
                "got -1"},
        Spoiled{"experiment.toml", "[grains]", "[grains", "experiment.toml:4: "}));

TEST(read_experiment, all_problems_are_reported_at_once_up_to_a_limit) {
    ExperimentFolder folder;
    folder.replace("experiment.toml", "0.5", "0.7");
    folder.replace("plate.csv", "unload", "up");
    folder.replace("contacts.csv", "floor", "roof");
    const std::string error = folder.error();
    for (const auto* part : {"experiment.toml:6", "plate.csv:4", "contacts.csv:3"})
        EXPECT_THAT(error, HasSubstr(part));

    std::string rows = "frame,cycle,phase,plate_z_m,top_force_N\n";
    for (int i = 0; i < 100; ++i) rows += std::to_string(i) + ",0,load,0.02,?\n";
    folder["plate.csv"] = rows;
    const std::string many = folder.error();
    EXPECT_EQ(std::count(many.begin(), many.end(), '\n'), 20);
    EXPECT_THAT(many, HasSubstr(".. and 82 more"));
}

TEST(read_experiment, a_column_in_millimetres_is_reported_once) {
    ExperimentFolder folder;
    folder["plate.csv"] =
        "frame,cycle,phase,plate_z_m,top_force_N\n0,0,load,22,0\n1,0,load,19,0.4\n2,0,unload,21,0\n";
    const std::string error = folder.error();
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
}

TEST(read_experiment, missing_and_empty_files_are_reported) {
    {
        ExperimentFolder folder;
        folder.remove("plate.csv");
        EXPECT_THAT(folder.error(), HasSubstr("must hold plate.csv"));
    }
    {
        ExperimentFolder folder;
        folder.remove("grains.csv");
        EXPECT_THAT(folder.error(), StartsWith("contacts.csv: needs grains.csv"));
    }
    {
        ExperimentFolder folder;
        folder.remove("experiment.toml");
        EXPECT_THAT(folder.error(), HasSubstr("contains no experiment.toml"));
    }
    for (const std::string name : {"plate.csv", "grains.csv", "contacts.csv"}) {
        ExperimentFolder folder;
        folder[name] = "";
        EXPECT_THAT(folder.error(), StartsWith(name + ": is empty: it must begin with the header frame,"));
    }
    ExperimentFolder folder;
    folder["plate.csv"] = "frame,cycle,phase,plate_z_m,top_force_N\n";
    EXPECT_THAT(folder.error(), StartsWith("plate.csv: must have at least one row"));
    folder["plate.csv.gz"] = "";
    EXPECT_THAT(folder.error(), HasSubstr("is there twice"));
    EXPECT_THROW(read_experiment("/nowhere"), InputError);
}

}  // namespace
}  // namespace mcdem::test
