#include "io/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "core/errors.h"
#include "io/hdf5.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

TEST(results, double_run_is_read_back_bit_for_bit) {
    TestFolder folder;
    const auto run = synthetic_run();
    write_run(folder / "run.h5", run);
    expect_same(run, read_run(folder / "run.h5"));
}

TEST(results, float_run_keeps_observables_exactly_and_geometry_to_float) {
    TestFolder folder;
    const auto run = synthetic_run({.precision = "float"});
    write_run(folder / "run.h5", run);
    const auto found = read_run(folder / "run.h5");
    expect_same(run, found, 6e-8);
    EXPECT_NE(run.recordings[0].scans[1].position[1].x(), found.recordings[0].scans[1].position[1].x());
}

TEST(results, containers_are_read_back) {
    TestFolder folder;
    auto run = synthetic_run();
    for (const ContainerShape shape : {ContainerShape::cylinder, ContainerShape::periodic}) {
        run.recordings[0].box.shape = shape;
        write_run(folder / "run.h5", run);
        expect_same(run, read_run(folder / "run.h5"));
    }
}

TEST(results, cells_are_read_back_with_their_strains) {
    TestFolder folder;
    auto run = synthetic_run();
    Recording& cell = run.recordings[0];
    cell.box = {0.1, 0.11, ContainerShape::cell, cell.plate_start};
    for (std::size_t k = 0; k < 6; ++k) cell.scans[1].strain[k] = 0.1 * static_cast<double>(k) - 0.2;
    write_run(folder / "run.h5", run);
    const auto found = read_run(folder / "run.h5");
    expect_same(run, found);
    EXPECT_EQ(found.recordings[0].box.height, cell.plate_start);
    EXPECT_EQ(found.recordings[0].scans[1].strain, cell.scans[1].strain);
    EXPECT_EQ(found.recordings[0].scans[0].strain, Strain{});
}

TEST(results, comparison_detects_a_changed_bit) {
    const auto run = synthetic_run();
    auto other = run;
    double& x = other.recordings[1].scans[2].contacts[3].force.x();
    x = std::nextafter(x, 1.0);
    ::testing::TestPartResultArray failures;
    {
        ::testing::ScopedFakeTestPartResultReporter reporter(
            ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &failures);
        expect_same(run, other);
    }
    EXPECT_EQ(failures.size(), 1);
}

TEST(results, ragged_and_missing_parts_are_read_back) {
    TestFolder folder;
    auto run = synthetic_run({.replicas = 4});
    run.recordings[0].scans.clear();
    run.recordings[0].failure = Failure{1234567890123, 17, "overlap past the limit"};
    run.recordings[1].scans[0].position.clear();
    run.recordings[1].scans[3].position.clear();
    run.recordings[1].scans[2].contacts.clear();
    run.recordings[2].scans.resize(1);
    run.recordings[3].diameter.clear();
    run.recordings[3].species.clear();
    run.recordings[3].parameters.clear();
    for (auto& scan : run.recordings[3].scans) {
        scan.position.clear();
        scan.rotation.clear();
        scan.contacts.clear();
    }
    write_run(folder / "run.h5", run);
    expect_same(run, read_run(folder / "run.h5"));
}

TEST(results, files_of_earlier_versions_have_no_rotations) {
    TestFolder folder;
    auto run = synthetic_run();
    write_run(folder / "run.h5", run);
    {
        const h5::Handle file(H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        for (std::size_t r = 0; r < run.recordings.size(); ++r)
            H5Ldelete(file, ("/particles/replica_0000" + std::to_string(r) + "/rotation").c_str(),
                      H5P_DEFAULT);
    }
    for (auto& recording : run.recordings)
        for (auto& scan : recording.scans) scan.rotation.clear();
    expect_same(run, read_run(folder / "run.h5"));
    EXPECT_TRUE(RunReader(folder / "run.h5").read_scan(0, 1).rotation.empty());
}

TEST(results, empty_run_is_read_back) {
    TestFolder folder;
    write_run(folder / "run.h5", mcdem::Run{});
    expect_same(mcdem::Run{}, read_run(folder / "run.h5"));
}

TEST(results, partial_reading_leaves_out_what_was_not_requested) {
    TestFolder folder;
    const auto run = synthetic_run();
    write_run(folder / "run.h5", run);
    for (ReadWhat what : {ReadWhat::observables, ReadWhat::positions, ReadWhat::contacts}) {
        auto expected = run;
        for (auto& recording : expected.recordings)
            for (auto& scan : recording.scans) {
                if (what != ReadWhat::positions) {
                    scan.position.clear();
                    scan.rotation.clear();
                }
                if (what != ReadWhat::contacts) scan.contacts.clear();
            }
        expect_same(expected, read_run(folder / "run.h5", what));
    }
}

TEST(results, reader_gives_single_scans) {
    TestFolder folder;
    auto run = synthetic_run();
    run.recordings[0].scans[2].position.clear();
    write_run(folder / "run.h5", run);
    RunReader reader(folder / "run.h5");
    auto found = reader.run();
    EXPECT_TRUE(found.recordings[0].scans[1].position.empty());
    for (std::size_t r = 0; r < found.recordings.size(); ++r)
        for (std::size_t s = found.recordings[r].scans.size(); s-- > 0;)
            found.recordings[r].scans[s] = reader.read_scan(r, s);
    expect_same(run, found);
}

TEST(results, a_wrong_number_of_positions_is_refused_and_nothing_is_written) {
    TestFolder folder;
    auto run = synthetic_run();
    run.recordings[1].scans[3].position.pop_back();
    EXPECT_THROW(write_run(folder / "run.h5", run), RunError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(results, unknown_species_are_refused) {
    for (const std::vector<int>& wrong :
         {std::vector<int>(27, 2), std::vector<int>(27, -1), std::vector<int>(26, 0)}) {
        TestFolder folder;
        auto run = synthetic_run({.replicas = 2, .grains = 27, .scans = 2});
        run.recordings[1].species = wrong;
        write_run(folder / "run.h5", run);
        try {
            read_run(folder / "run.h5");
            ADD_FAILURE() << wrong.front();
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(
                                          "species: must be a species of 0 to 1 for each of the 27 grains"));
        }
    }
}

TEST(results, a_missing_file_and_a_folder_without_a_run_are_reported) {
    TestFolder folder;
    for (const auto& path : {folder / "nowhere", folder.path}) {
        try {
            read_run(path);
            ADD_FAILURE() << path;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(path.string()));
        }
    }
}

TEST(results, the_same_run_gives_the_same_bytes_later) {
    TestFolder folder;
    write_run(folder / "a.h5", synthetic_run());
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // times in files are in seconds
    write_run(folder / "b.h5", synthetic_run());
    EXPECT_TRUE(bytes_of_file(folder / "a.h5") == bytes_of_file(folder / "b.h5"));
}

TEST(results, long_texts_are_read_back) {
    TestFolder folder;
    auto run = synthetic_run({.replicas = 1});
    run.scene = std::string(300000, 'x') + "end";
    run.recordings[0].parameters["packing.file"] = std::string(5000, 'y');
    write_run(folder / "run.h5", run);
    expect_same(run, read_run(folder / "run.h5"));
}

}  // namespace
}  // namespace mcdem::test
