// CSV files and example scripts, read and run by the programs for which they are meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "io/csv.h"
#include "io/result_folder.h"
#include "io/results.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;
const std::string source = MCDEM_SOURCE_DIR;

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> words;
    std::stringstream text(line);
    for (std::string word; std::getline(text, word, ',');) words.push_back(word);
    return words;
}

TEST(csv, a_row_per_scan_reads_back_exactly) {
    TestFolder folder;
    auto run = synthetic_run();
    run.recordings[0].label = "plain \"quoted\"";
    write_run(run_file(folder.path), run);
    write_csv(folder.path);
    std::ifstream in(folder / "plate.csv");
    std::string header, first, line;
    std::getline(in, header);
    std::getline(in, first);
    int rows = 1;
    while (std::getline(in, line)) ++rows;
    EXPECT_EQ(rows, 12);
    const auto names = cells(header), values = cells(first);
    ASSERT_EQ(names.size(), values.size());
    const Scan& scan = run.recordings[0].scans[0];
    const auto value = [&](const std::string& column) {
        const auto found = std::find(names.begin(), names.end(), column);
        return found == names.end() ? "no column " + column
                                    : values[static_cast<std::size_t>(found - names.begin())];
    };
    EXPECT_EQ(value("label"), "\"plain \"\"quoted\"\"\"");
    EXPECT_EQ(value("phase"), "load");
    EXPECT_EQ(std::stod(value("plate_z_m")), scan.plate_z);
    EXPECT_EQ(std::stod(value("displacement_m")), 0);
    EXPECT_EQ(std::stod(value("top_force_N")), scan.top_force());
    EXPECT_EQ(std::stod(value("floor_force_N")), -scan.wall_force[static_cast<int>(Wall::floor)].z());
    EXPECT_EQ(std::stod(value("x_min_force_N")), -scan.wall_force[static_cast<int>(Wall::x_min)].x());
    EXPECT_EQ(std::stod(value("y_max_force_N")), scan.wall_force[static_cast<int>(Wall::y_max)].y());
    EXPECT_EQ(std::stod(value("mean_force_N")), scan.mean_force);
    EXPECT_EQ(value("packing_fraction"), "nan");
    EXPECT_EQ(value("settled"), "1");
}

TEST(csv, side_forces_are_those_of_existing_walls) {
    auto run = synthetic_run({.replicas = 3, .scans = 1});
    run.recordings[1].box.shape = ContainerShape::cylinder;
    run.recordings[2].box.shape = ContainerShape::periodic;
    for (auto& recording : run.recordings) {
        recording.parameters.clear();
        recording.label = "a";
    }
    run.recordings[1].scans[0].wall_force[0] = Vec3(0.1, 0.2, -7.5);
    std::stringstream lines(csv_text(run));
    std::string header, box, cylinder, periodic;
    for (std::string* line : {&header, &box, &cylinder, &periodic}) std::getline(lines, *line);
    EXPECT_THAT(header, testing::EndsWith(",energy_error_J,side_force_z_N"));
    EXPECT_EQ(cells(header)[10], "x_min_force_N");
    EXPECT_NE(cells(box)[11], "nan");
    EXPECT_EQ(cells(box).back(), "nan");
    for (const auto& other : {cylinder, periodic})
        for (std::size_t column = 10; column < 14; ++column) EXPECT_EQ(cells(other)[column], "nan");
    EXPECT_EQ(cells(cylinder).back(), "-7.5");
    EXPECT_EQ(cells(periodic).back(), "nan");
}

TEST(csv, cells_have_strains_and_forces_through_their_faces) {
    auto run = synthetic_run({.replicas = 2, .scans = 1});
    run.recordings[1].box = {0.1, 0.1, ContainerShape::cell, 0.1};
    run.recordings[1].scans[0].strain = {0.1, 0.2, 0.3, 0.4, 0.5, 0.625};
    for (auto& recording : run.recordings) {
        recording.parameters.clear();
        recording.label = "a";
    }
    std::stringstream lines(csv_text(run));
    std::string header, box, cell;
    for (std::string* line : {&header, &box, &cell}) std::getline(lines, *line);
    EXPECT_THAT(header,
                testing::EndsWith(",energy_error_J,strain_x,strain_y,strain_z,shear_xy,shear_xz,shear_yz"));
    EXPECT_THAT(cell, testing::EndsWith(",0.1,0.2,0.3,0.4,0.5,0.625"));
    EXPECT_THAT(box, testing::EndsWith(",0,0,0,0,0,0"));
    for (std::size_t column = 10; column < 14; ++column) EXPECT_NE(cells(cell)[column], "nan");
}

TEST(csv, labels_and_values_never_start_a_formula) {
    auto run = synthetic_run();
    run.recordings[0].label = "=HYPERLINK(\"http://a\",1), mc_dem";
    run.recordings[1].label = "-0.5";
    run.recordings[0].parameters["packing.file"] = "\"@a.lammps\"";
    run.recordings[1].parameters["packing.file"] = "\"b.lammps\"";
    const std::string text = csv_text(run);
    EXPECT_NE(text.find("\n0,\"'=HYPERLINK(\"\"http://a\"\",1), mc_dem\",0,"), text.npos) << text;
    EXPECT_NE(text.find("\n1,\"-0.5\",0,"), text.npos) << text;
    EXPECT_NE(text.find(",\"'@a.lammps\","), text.npos) << text;
}

TEST(csv, keys_that_differ_between_replicas_have_columns) {
    auto run = synthetic_run();
    ASSERT_GE(run.recordings.size(), 2u);
    for (auto& recording : run.recordings) recording.parameters = {{"contact.gamma", "1"}, {"name", "\"a\""}};
    run.recordings[1].parameters["contact.gamma"] = "1.125";
    run.recordings[1].parameters["contact.model"] = "\"mc_dem\"";
    const std::string text = csv_text(run);
    EXPECT_NE(text.find(",energy_error_J,contact.gamma,contact.model\n"), std::string::npos) << text;
    EXPECT_NE(text.find(",1,\n"), std::string::npos);
    EXPECT_NE(text.find(",1.125,\"mc_dem\"\n"), std::string::npos);
}

class examples : public ::testing::Test {
protected:
    void SetUp() override {
        if (run_command("/usr/bin/python3 -c 'import h5py, numpy, matplotlib'").exit_code != 0)
            GTEST_SKIP() << "python3-h5py, python3-numpy or python3-matplotlib is not installed";
        write_run(folder / "run.h5", synthetic_run({.precision = "float"}));
    }
    Finished example(const std::string& script, const std::string& arguments) {
        return run_command("MPLCONFIGDIR=" + folder.path.string() + " /usr/bin/python3 " + source +
                           "/examples/" + script + " " + arguments);
    }
    void expect_picture(const std::string& script) {
        const auto picture = folder / (script + ".png");
        const Finished finished = example(script, folder.path.string() + " " + picture.string());
        EXPECT_EQ(finished.exit_code, 0) << finished.output;
        EXPECT_THAT(bytes_of_file(picture).substr(0, 8), HasSubstr("PNG"));
        EXPECT_GT(bytes_of_file(picture).size(), 5000u);
    }
    TestFolder folder;
};

TEST_F(examples, read_run_prints_a_row_for_each_replica_and_phase) {
    for (const auto& place : {folder.path, folder / "run.h5"}) {
        const Finished finished = example("read_run.py", place.string());
        EXPECT_EQ(finished.exit_code, 0) << finished.output;
        EXPECT_THAT(finished.output, HasSubstr("mc_dem, packing 1"));
        EXPECT_THAT(finished.output, HasSubstr("1.10"));  // largest top force of replica 1: 0.5 * 2 * 1.1 N
    }
}

TEST_F(examples, scan_table_prints_means_of_each_replica_and_phase) {
    if (run_command("/usr/bin/python3 -c 'import pandas'").exit_code != 0)
        GTEST_SKIP() << "python3-pandas is not installed";
    const Finished finished = example("scan_table.py", folder.path.string());
    EXPECT_EQ(finished.exit_code, 0) << finished.output;
    EXPECT_THAT(finished.output, HasSubstr("mc_dem, packing 1"));
    EXPECT_THAT(finished.output, HasSubstr("unload"));
}

TEST_F(examples, scripts_draw_figures) {
    expect_picture("plot_top_force.py");
    expect_picture("force_chains.py");
}

TEST_F(examples, scripts_report_errors) {
    for (const std::string script : {"read_run.py", "plot_top_force.py", "force_chains.py"}) {
        EXPECT_THAT(example(script, "").output, HasSubstr("usage")) << script;
        const Finished finished = example(script, "/nowhere");
        EXPECT_NE(finished.exit_code, 0);
        EXPECT_THAT(finished.output, HasSubstr("/nowhere: no run")) << script;
        EXPECT_THAT(finished.output, ::testing::Not(HasSubstr("Traceback"))) << script;
    }
}

}  // namespace
}  // namespace mcdem::test
