// Exports for ParaView and OVITO: the contents of the files, and which files are written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/container.h"
#include "core/errors.h"
#include "io/export_run.h"
#include "io/hdf5.h"
#include "io/result_folder.h"
#include "io/results.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;
constexpr int module_missing = 77;
const std::string project = MCDEM_SOURCE_DIR;
const std::string first_name = "replica_00000_mc_dem_packing_0";

TEST(export_name, contains_the_label_in_shell_safe_characters) {
    EXPECT_EQ(export_name(3, "mc_dem, friction=0.03 #2"), "replica_00003_mc_dem_friction=0.03_2");
    EXPECT_EQ(export_name(0, ""), "replica_00000");
    EXPECT_EQ(export_name(0, "../$(rm -r) `x`/."), "replica_00000_.._rm_-r_x");
    EXPECT_EQ(export_name(0, std::string(300, 'a')).size(), 13u + 1 + 80);
}

TEST(vtk, the_guide_lists_the_replicas_with_their_differences) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 2, .scans = 1});
    for (auto& recording : run.recordings) recording.parameters = {{"contact.gamma", "1"}, {"name", "a"}};
    run.recordings[1].parameters["contact.gamma"] = "1.125";
    write_run(folder / "run.h5", run);
    export_vtk(folder / "run.h5", folder / "all");
    export_xyz(folder / "run.h5", folder / "one", {.replicas = {1}});
    const std::string second = "replica_00001_mc_dem_packing_1  contact.gamma = 1.125\n";
    EXPECT_THAT(read_bytes(folder / "all/README.txt"),
                testing::EndsWith("\n" + first_name + "  contact.gamma = 1\n" + second));
    EXPECT_THAT(read_bytes(folder / "one/OVITO.txt"), testing::EndsWith(":\n" + second));
}

TEST(vtk, grains_and_contacts_are_read_by_vtk) {
    TemporaryFolder folder;
    const auto run = synthetic_run({.replicas = 2, .scans = 3});
    write_run(folder / "run.h5", run);
    EXPECT_EQ(export_vtk(folder / "run.h5", folder / "view"), 24);
    EXPECT_TRUE(std::filesystem::exists(folder / "view/README.txt"));
    const Scan& scan = run.recordings[1].scans[2];
    const Contact& last = scan.contacts.back();
    std::stringstream command;
    command.precision(17);
    command << "/usr/bin/python3 " << project << "/tests/io/read_vtk.py "
            << (folder / "view/replica_00001_mc_dem_packing_1").string() << " 000002 " << scan.position.size()
            << ' ' << scan.contacts.size() << ' ' << last.force.z() << ' ' << scan.plate_z << " species";
    const Finished finished = run_command(command.str());
    if (finished.exit_code == module_missing)
        GTEST_SKIP() << "neither python3-paraview nor python3-vtk9 is installed";
    EXPECT_EQ(finished.exit_code, 0) << finished.output;
}

TEST(vtk, scans_without_positions_are_omitted) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 4});
    run.recordings[0].scans[1].position.clear();
    auto results = ResultFolder::create(folder / "out");
    results.append_segment(part_of(run, 0, 2));
    results.append_segment(part_of(run, 2, 4));
    EXPECT_EQ(export_vtk(folder / "out", folder / "a"), 12);
    EXPECT_FALSE(std::filesystem::exists(folder / "a" / first_name / "grains_000001.hdf"));
}

// ParaView shows all numbered files as one time series.
TEST(vtk, files_of_an_earlier_export_do_not_remain) {
    TemporaryFolder folder;
    write_run(folder / "long.h5", synthetic_run({.replicas = 1, .scans = 4}));
    write_run(folder / "short.h5", synthetic_run({.replicas = 1, .scans = 2}));
    export_vtk(folder / "long.h5", folder / "view");
    export_vtk(folder / "short.h5", folder / "view");
    const auto files = std::filesystem::directory_iterator(folder / "view" / first_name);
    EXPECT_EQ(std::ranges::count_if(files, [](const auto& f) { return f.path().extension() == ".hdf"; }), 8);
    for (const char* name : {"mine.hdf", "grains_filtered.hdf", "grains_1.vtu"}) {
        std::ofstream(folder / "view" / first_name / name) << "something else";
        export_vtk(folder / "short.h5", folder / "view");
        EXPECT_TRUE(std::filesystem::exists(folder / "view" / first_name / name)) << name;
    }
}

int frames_in(const std::filesystem::path& file, const std::string& mark) {
    const std::string text = read_bytes(file);
    int count = 0;
    for (auto at = text.find(mark); at != text.npos; at = text.find(mark, at + 1)) ++count;
    return count;
}

std::vector<double> point_data(const std::filesystem::path& file, const std::string& name) {
    return h5::File::open(file).dataset("/VTKHDF/PointData/" + name).read_all<double>();
}

TEST(vtk, displacements_are_relative_to_the_first_and_to_the_previous_scan) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 3});
    auto& scans = run.recordings[0].scans;
    for (int s : {1, 2})
        for (auto& at : scans[s].position) at = scans[0].position[0] + Vec3(0.01 * s * s, 0, -0.02 * s);
    scans[0].position.assign(scans[0].position.size(), scans[0].position[0]);
    write_run(folder / "run.h5", run);
    EXPECT_EQ(export_vtk(folder / "run.h5", folder.path(), {.scans = {2}}), 4);
    const auto file = folder / first_name / "grains_000002.hdf";
    const auto all = point_data(file, "displacement"),
               last = point_data(file, "displacement_since_last_scan");
    EXPECT_NEAR(all[0], 0.04, 1e-7);
    EXPECT_NEAR(all[2], -0.04, 1e-7);
    EXPECT_NEAR(last[0], 0.03, 1e-7);
    EXPECT_NEAR(last[2], -0.02, 1e-7);
}

TEST(vtk, rotations_are_relative_to_the_start_and_to_the_previous_scan) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 3});
    auto& scans = run.recordings[0].scans;
    scans[1].rotation.assign(scans[1].rotation.size(), {0.5, 0, 0});
    scans[2].rotation.assign(scans[2].rotation.size(), {0.8, 0, 0});
    scans[2].rotation[1] =
        2 * std::numbers::pi / 3 * Vec3(1, 1, -1).normalized();  // a quarter turn about x, then about y
    scans[1].rotation[1] = {std::numbers::pi / 2, 0, 0};
    write_run(folder / "run.h5", run);
    EXPECT_EQ(export_vtk(folder / "run.h5", folder.path(), {.scans = {2}}), 4);
    const auto file = folder / first_name / "grains_000002.hdf";
    const auto all = point_data(file, "rotation"), last = point_data(file, "rotation_since_last_scan");
    EXPECT_NEAR(all[0], 0.8, 1e-7);
    EXPECT_NEAR(last[0], 0.3, 1e-7);
    EXPECT_NEAR(last[3], 0, 1e-6);
    EXPECT_NEAR(last[4], std::numbers::pi / 2, 1e-6);
    EXPECT_NEAR(last[5], 0, 1e-6);
    for (Scan& scan : scans) scan.rotation.clear();
    write_run(folder / "measured.h5", run);
    export_vtk(folder / "measured.h5", folder / "measured", {.scans = {2}});
    EXPECT_THROW(point_data(folder / "measured" / first_name / "grains_000002.hdf", "rotation"),
                 std::exception);
}

TEST(vtk, only_selected_scans_are_written) {
    TemporaryFolder folder;
    write_run(folder / "run.h5", synthetic_run({.replicas = 2, .scans = 4}));
    EXPECT_EQ(export_vtk(folder / "run.h5", folder / "a", {.replicas = {1}, .scans = {1, 3}}), 8);
    EXPECT_FALSE(std::filesystem::exists(folder / "a" / first_name));
    EXPECT_TRUE(std::filesystem::exists(folder / "a/replica_00001_mc_dem_packing_1/contacts_000003.hdf"));
    EXPECT_EQ(export_xyz(folder / "run.h5", folder / "b", {.replicas = {1}, .scans = {1, 3}}), 2);
    EXPECT_EQ(frames_in(folder / "b/replica_00001_mc_dem_packing_1.xyz", "Lattice="), 2);
    EXPECT_THROW(export_xyz(folder / "run.h5", folder / "c", {.replicas = {2}}), InputError);
}

/// End points of the contacts in an exported file, two per contact.
std::vector<double> points_in(const std::filesystem::path& file) {
    return h5::File::open(file).dataset("/VTKHDF/Points").read_all<double>();
}

TEST(vtk, contacts_end_at_curved_walls_and_at_nearest_images) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 2, .scans = 1});
    for (auto& recording : run.recordings) {
        recording.box = {0.1, 0.1, ContainerShape::cylinder};
        recording.scans[0].position[0] = {0.08, 0.09, 0.03};
        recording.scans[0].position[1] = {0.01, 0.015, 0.03};
        recording.scans[0].contacts.resize(1);
        recording.scans[0].contacts[0].grain = 0;
        recording.scans[0].contacts[0].partner = wall_partner(Wall::x_min);
    }
    run.recordings[1].box.shape = ContainerShape::periodic;
    run.recordings[1].scans[0].contacts[0].partner = 1;
    write_run(folder / "run.h5", run);
    export_vtk(folder / "run.h5", folder / "view");
    const auto round = points_in(folder / "view" / first_name / "contacts_000000.hdf");
    ASSERT_EQ(round.size(), 6u);
    EXPECT_NEAR(round[3], 0.05 + 0.05 * 0.6, 1e-12);
    EXPECT_NEAR(round[4], 0.05 + 0.05 * 0.8, 1e-12);
    EXPECT_EQ(round[5], 0.03);
    const auto image = points_in(folder / "view/replica_00001_mc_dem_packing_1/contacts_000000.hdf");
    EXPECT_NEAR(image[3], 0.11, 1e-12);
    EXPECT_NEAR(image[4], 0.115, 1e-12);
}

std::vector<int> cell_data(const std::filesystem::path& file, const std::string& name) {
    return h5::File::open(file).dataset("/VTKHDF/CellData/" + name).read_all<int>();
}

TEST(vtk, forces_are_at_the_contacts) {
    TemporaryFolder folder;
    const auto run = synthetic_run({.replicas = 1, .scans = 1});
    write_run(folder / "run.h5", run);
    export_vtk(folder / "run.h5", folder.path());
    const auto file = folder / first_name / "forces_000000.hdf";
    const auto points = points_in(file), force = point_data(file, "force");
    const auto& contacts = run.recordings[0].scans[0].contacts;
    ASSERT_EQ(points.size(), 3 * contacts.size());
    for (std::size_t c = 0; c < contacts.size(); ++c)
        for (int a = 0; a < 3; ++a) {
            EXPECT_EQ(points[3 * c + static_cast<std::size_t>(a)], contacts[c].point[a]);
            EXPECT_EQ(force[3 * c + static_cast<std::size_t>(a)], contacts[c].force[a]);
        }
}

/// Walls of a container 0.1 m wide; the plate is at 0.08 m after a start at 0.09 m.
std::filesystem::path walls_of(const TemporaryFolder& folder, ContainerShape shape,
                               const Strain& strain = {}) {
    auto run = synthetic_run({.replicas = 1, .scans = 1});
    Recording& recording = run.recordings[0];
    recording.box = {0.1, 0.1, shape, shape == ContainerShape::cell ? 0.1 : 0};
    recording.plate_start = shape == ContainerShape::cell ? 0.1 : 0.09;
    recording.scans[0].plate_z = 0.08;
    recording.scans[0].strain = strain;
    write_run(folder / "run.h5", run);
    export_vtk(folder / "run.h5", folder.path());
    return folder / first_name / "walls_000000.hdf";
}

TEST(vtk, walls_are_surfaces_with_their_forces) {
    TemporaryFolder folder;
    const auto file = walls_of(folder, ContainerShape::box);
    EXPECT_THAT(cell_data(file, "wall"), testing::ElementsAre(2, 1, 3, 0, 4, 5));
    const auto points = points_in(file);
    ASSERT_EQ(points.size(), 6u * 4 * 3);
    EXPECT_THAT((std::vector(points.begin() + 12, points.begin() + 24)),
                testing::ElementsAre(0.1, 0, 0, 0.1, 0.1, 0, 0.1, 0.1, 0.09, 0.1, 0, 0.09));  // x_max
    EXPECT_EQ(points.back(), 0.08);
    const auto force = h5::File::open(file).dataset("/VTKHDF/CellData/force").read_all<double>();
    EXPECT_EQ(force.back(), synthetic_run({.replicas = 1, .scans = 1}).recordings[0].scans[0].top_force());
}

TEST(vtk, a_cylinder_is_round_and_periodic_containers_have_edges) {
    TemporaryFolder round, open, cell;
    const auto points = points_in(walls_of(round, ContainerShape::cylinder));
    for (std::size_t n = 0; n < points.size(); n += 3)
        EXPECT_NEAR(std::hypot(points[n] - 0.05, points[n + 1] - 0.05), 0.05, 1e-12);
    EXPECT_THAT(cell_data(walls_of(open, ContainerShape::periodic), "wall"),
                testing::ElementsAre(-1, -1, -1, -1, 4, 5));
    const auto edges = walls_of(cell, ContainerShape::cell, {0.1, 0, 0.2, 0, 0.3, 0});
    EXPECT_EQ(cell_data(edges, "wall"), std::vector<int>(12, -1));
    const auto ends = points_in(edges);
    for (std::size_t n = 0; n < ends.size(); n += 3) {
        EXPECT_TRUE(ends[n] == 0 || std::fabs(ends[n] - 0.09) < 1e-15);
        EXPECT_TRUE(ends[n + 2] == 0 || std::fabs(ends[n + 2] - 0.08) < 1e-15);
    }
    EXPECT_EQ(h5::File::open(edges).dataset("/VTKHDF/FieldData/shear_xz").read_all<double>().at(0), 0.3);
}

TEST(vtk, displacements_in_a_cell_are_relative_to_its_own_motion) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 2});
    Recording& recording = run.recordings[0];
    recording.box = {0.1, 0.1, ContainerShape::cell, 0.1};
    const Vec3 moved(0.003, -0.002, 0.001);
    Scan &before = recording.scans[0], &after = recording.scans[1];
    before.strain = {0.02, 0, 0, 0, 0.3, 0};
    after.strain = {0.05, 0.1, -0.02, 0.1, 0.9, -0.2};
    for (std::size_t i = 0; i < before.position.size(); ++i) {
        const Vec3 place(0.1 * static_cast<double>(i) / 30, 0.05, 0.09);
        before.position[i] =
            into_cell(deformed(recording.box, before.strain), deformation(before.strain) * place);
        after.position[i] =
            into_cell(deformed(recording.box, after.strain), deformation(after.strain) * place + moved);
    }
    write_run(folder / "run.h5", run);
    export_vtk(folder / "run.h5", folder / "view");
    const auto found = h5::File::open(folder / "view" / first_name / "grains_000001.hdf")
                           .dataset("/VTKHDF/PointData/displacement")
                           .read_all<double>();
    ASSERT_EQ(found.size(), 3 * before.position.size());
    for (std::size_t n = 0; n < found.size(); ++n)
        EXPECT_NEAR(found[n], moved[static_cast<int>(n % 3)], 1e-12);
}

TEST(vtk, a_scan_without_contacts_gives_files) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 1});
    run.recordings[0].scans[0].contacts.clear();
    write_run(folder / "run.h5", run);
    EXPECT_EQ(export_vtk(folder / "run.h5", folder / "view"), 4);
    std::stringstream command;
    command << "/usr/bin/python3 " << project << "/tests/io/read_vtk.py "
            << (folder / "view" / first_name).string() << " 000000 27 0 0 "
            << run.recordings[0].scans[0].plate_z;
    const Finished finished = run_command(command.str());
    if (finished.exit_code == module_missing)
        GTEST_SKIP() << "neither python3-paraview nor python3-vtk9 is installed";
    EXPECT_EQ(finished.exit_code, 0) << finished.output;
}

TEST(vtk, grains_without_contacts_have_zero_stress) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 1});
    run.recordings[0].scans[0].contacts.clear();
    run.recordings[0].scans[0].coordination_number = 0;
    write_run(folder / "run.h5", run);
    export_vtk(folder / "run.h5", folder.path());
    EXPECT_THAT(point_data(folder / first_name / "grains_000000.hdf", "stress"), testing::Each(0));
}

TEST(vtk, the_type_of_grid_is_written_as_paraview_requires) {
    TemporaryFolder folder;
    write_run(folder / "run.h5", synthetic_run({.replicas = 1, .scans = 1}));
    export_vtk(folder / "run.h5", folder.path());
    const auto file = folder / first_name / "grains_000000.hdf";
    const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t attribute = H5Aopen_by_name(id, "/VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    EXPECT_EQ(H5Tget_cset(type), H5T_CSET_ASCII);
    H5Tclose(type);
    H5Aclose(attribute);
    H5Fclose(id);
}

TEST(xyz, scans_without_positions_are_omitted) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 2, .scans = 4});
    run.recordings[0].scans[1].position.clear();
    for (Scan& scan : run.recordings[1].scans) scan.position.clear();
    write_run(folder / "run.h5", run);
    EXPECT_EQ(export_xyz(folder / "run.h5", folder / "a"), 2);
    EXPECT_EQ(frames_in(folder / "a/replica_00000_mc_dem_packing_0.xyz", "Lattice="), 3);
    EXPECT_EQ(frames_in(folder / "a/replica_00000_mc_dem_packing_0.contacts.dump", "ITEM: TIMESTEP"), 3);
    EXPECT_FALSE(std::filesystem::exists(folder / "a/replica_00001_mc_dem_packing_1.xyz"));
}

TEST(xyz, a_label_cannot_end_its_quotes_or_its_line) {
    TemporaryFolder folder;
    auto run = synthetic_run({.replicas = 1, .scans = 1});
    run.recordings[0].label = "a \"b\"\nc";
    write_run(folder / "run.h5", run);
    export_xyz(folder / "run.h5", folder.path());
    EXPECT_THAT(read_bytes(folder / "replica_00000_a_b_c.xyz"), HasSubstr(" label=\"a 'b' c\"\nX "));
}

TEST(xyz, failed_writes_are_errors) {
    TemporaryFolder folder;
    write_bytes(folder / "file", "");
    write_run(folder / "run.h5", synthetic_run());
    EXPECT_THROW(export_xyz(folder / "run.h5", folder / "file"), RunError);
}

}  // namespace
}  // namespace mcdem::test
