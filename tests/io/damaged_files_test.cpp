// Damaged, foreign and incomplete result files: a clear error, no crash, no wrong numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "io/hdf5.h"
#include "io/result_file.h"
#include "io/result_folder.h"
#include "io/results.h"
#include "io/synthetic_run.h"

/// HDF5 1.10 leaks memory when it reads damaged metadata; these leaks are not checked here.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;

std::string read_error(const std::filesystem::path& file) {
    try {
        read_run(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(damaged_files, truncation_at_every_tenth_is_detected) {
    TestFolder folder;
    const auto file = folder / "run.h5";
    write_run(file, synthetic_run());
    const std::string whole = bytes_of_file(file);
    for (int tenth = 0; tenth < 10; ++tenth) {
        write_bytes(file, whole.substr(0, whole.size() * static_cast<std::size_t>(tenth) / 10));
        EXPECT_THAT(read_error(file), HasSubstr("run.h5: cannot be opened as HDF5")) << tenth;
    }
}

TEST(damaged_files, flipped_bits_are_detected_or_harmless) {
    TestFolder folder;
    const auto file = folder / "run.h5";
    const auto run = synthetic_run();
    write_run(file, run);
    const std::string whole = bytes_of_file(file);
    std::mt19937_64 random(11);
    int noticed = 0;
    for (int trial = 0; trial < 400; ++trial) {
        std::string bytes = whole;
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
        write_bytes(file, bytes);
        try {
            expect_same(run, read_run(file));
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("run.h5"));
            ++noticed;
        }
        ASSERT_FALSE(HasFailure()) << "trial " << trial;
    }
    EXPECT_GT(noticed, 100);
}

TEST(damaged_files, scrambled_ranges_are_detected) {
    TestFolder folder;
    const auto file = folder / "run.h5";
    const auto run = synthetic_run();
    write_run(file, run);
    const std::string whole = bytes_of_file(file);
    std::mt19937_64 random(13);
    for (int trial = 0; trial < 100; ++trial) {
        std::string bytes = whole;
        const std::size_t first = random() % bytes.size(),
                          last = std::min(bytes.size(), first + random() % 4096);
        for (std::size_t i = first; i < last; ++i) bytes[i] = static_cast<char>(random());
        write_bytes(file, bytes);
        try {
            expect_same(run, read_run(file));
        } catch (const InputError&) {
        }
        ASSERT_FALSE(HasFailure()) << "trial " << trial;
    }
}

TEST(damaged_files, foreign_files_are_named) {
    TestFolder folder;
    write_bytes(folder / "text.h5", "frame,cycle\n0,0\n");
    EXPECT_THAT(read_error(folder / "text.h5"), HasSubstr("cannot be opened as HDF5"));
    replace_file(folder / "other.h5", [](NewFile& out) {
        auto other = h5::File::create(out);
        other.write("/measurement/height", std::vector<double>{1, 2});
        other.close();
    });
    EXPECT_THAT(read_error(folder / "other.h5"), HasSubstr("not a result of this program"));
}

TEST(damaged_files, missing_tables_are_named) {
    for (const std::string object :
         {"/observables/replica_00000", "/contacts/replica_00000/offset", "/contacts/replica_00000/contact",
          "/particles/replica_00000/diameter", "/particles/replica_00000/position/value",
          "/parameters/replica_00000"}) {
        TestFolder folder;
        write_run(folder / "run.h5", synthetic_run({.replicas = 1, .scans = 2}));
        {
            const h5::Handle file(H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
            H5Lmove(file, object.c_str(), file, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT);
        }
        const bool is_replica = object.starts_with("/observables");
        EXPECT_THAT(read_error(folder / "run.h5"), HasSubstr(is_replica ? "/observables: must hold 1 replicas"
                                                                        : object + ": cannot be found"));
    }
}

/// Writes a result file, replaces the object `path` by `values`, and returns the error of reading it.
template <class Number>
std::string error_with(const std::string& path, const std::vector<Number>& values) {
    TestFolder folder;
    write_run(folder / "run.h5", synthetic_run({.replicas = 1, .scans = 2}));
    {
        const h5::Handle file(H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        H5Ldelete(file, path.c_str(), H5P_DEFAULT);
        const hsize_t size = values.size();
        const h5::Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
        const h5::Handle type = h5::number_type<Number>();
        const h5::Handle table(
            H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
        H5Dwrite(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    return read_error(folder / "run.h5");
}

TEST(damaged_files, wrong_types_and_sizes_are_reported) {
    EXPECT_THAT(error_with("/observables/replica_00000", std::vector<double>{1, 2}),
                HasSubstr("named fields"));
    EXPECT_THAT(error_with("/parameters/scene", std::vector<double>{1}),
                HasSubstr("/parameters/scene: must hold texts"));
    EXPECT_THAT(error_with("/contacts/replica_00000/offset", std::vector<long>{0, 5}),
                HasSubstr("offset must rise"));
    EXPECT_THAT(error_with("/contacts/replica_00000/offset", std::vector<long>{0, 1000000000, 36}),
                HasSubstr("offset must rise"));
    EXPECT_THAT(error_with("/particles/replica_00000/diameter", std::vector<double>{0.02}),
                HasSubstr("position/value: has rows of another size"));
    EXPECT_THAT(error_with("/particles/replica_00000/position/step", std::vector<long>{0, 2}),
                HasSubstr("must be the row of a scan"));
    EXPECT_THAT(error_with("/particles/replica_00000/position/step", std::vector<long>{0}),
                HasSubstr("one row for each of step"));
}

TEST(damaged_files, invalid_sizes_are_refused) {
    TestFolder folder;
    const auto error_after = [&](const std::function<void(Recording&)>& change) {
        auto run = synthetic_run({.replicas = 1, .scans = 2});
        change(run.recordings.front());
        write_run(folder / "run.h5", run);
        return read_error(folder / "run.h5");
    };
    for (const double bad : {0.0, -0.01, double(NAN), double(INFINITY)}) {
        EXPECT_THAT(error_after([&](Recording& recording) { recording.diameter[1] = bad; }),
                    HasSubstr("/particles/replica_00000/diameter: must be numbers > 0 [m]"));
        for (const auto& change : std::vector<std::function<void(Recording&)>>{
                 [&](Recording& recording) { recording.box.size_x = bad; },
                 [&](Recording& recording) { recording.box.size_y = bad; },
                 [&](Recording& recording) { recording.plate_start = bad; }})
            EXPECT_THAT(error_after(change), HasSubstr("/box: edges must be 3 numbers > 0 [m]"));
    }
}

/// Changes a result file by `change` with the HDF5 library alone, and returns the error of reading it.
std::string error_after(const std::function<void(hid_t file, const std::filesystem::path& folder)>& change) {
    TestFolder folder;
    write_run(folder / "run.h5", synthetic_run({.replicas = 1, .scans = 2}));
    {
        const h5::Handle file(H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
        change(file, folder.path);
    }
    return read_error(folder / "run.h5");
}

h5::Handle one_row() {
    const hsize_t one = 1;
    return {H5Screate_simple(1, &one, nullptr), H5Sclose};
}

TEST(damaged_files, external_links_and_files_are_not_read) {
    const std::string scene = "/parameters/scene", refused = scene + ": lies outside this file";
    const h5::Handle text = h5::text_type(20);
    EXPECT_THAT(
        error_after([&](hid_t file, const std::filesystem::path& folder) {
            write_bytes(folder / "secret", "a text of twenty byte");
            H5Ldelete(file, scene.c_str(), H5P_DEFAULT);
            const h5::Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
            H5Pset_external(layout, (folder / "secret").c_str(), 0, H5F_UNLIMITED);
            H5Dclose(H5Dcreate2(file, scene.c_str(), text, one_row(), H5P_DEFAULT, layout, H5P_DEFAULT));
        }),
        HasSubstr(refused));
    EXPECT_THAT(error_after([&](hid_t file, const std::filesystem::path&) {
                    H5Ldelete(file, scene.c_str(), H5P_DEFAULT);
                    H5Lcreate_external("other.h5", "/scene", file, scene.c_str(), H5P_DEFAULT, H5P_DEFAULT);
                }),
                HasSubstr(refused));
    EXPECT_THAT(error_after([&](hid_t file, const std::filesystem::path&) {
                    H5Lmove(file, "/parameters", file, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT);
                    H5Lcreate_soft("/elsewhere", file, "/parameters", H5P_DEFAULT, H5P_DEFAULT);
                }),
                HasSubstr("/parameters: lies outside this file"));
    EXPECT_THAT(
        error_after([&](hid_t file, const std::filesystem::path&) {
            H5Ldelete(file, scene.c_str(), H5P_DEFAULT);
            const h5::Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
            H5Pset_virtual(layout, one_row(), "other.h5", "/scene", one_row());
            H5Dclose(H5Dcreate2(file, scene.c_str(), text, one_row(), H5P_DEFAULT, layout, H5P_DEFAULT));
        }),
        HasSubstr(refused));
}

TEST(damaged_files, contacts_of_missing_grains_are_refused) {
    TestFolder folder;
    auto run = synthetic_run();
    run.recordings[1].scans[0].contacts[0].partner = 27;
    write_run(folder / "run.h5", run);
    EXPECT_THAT(read_error(folder / "run.h5"), HasSubstr("contact of grain 0 with partner 27"));
}

long files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(damaged_files, killed_while_writing_leaves_the_old_file) {
    TestFolder folder;
    const auto file = folder / "run.h5";
    write_run(file, synthetic_run());
    const std::string before = bytes_of_file(file);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        replace_file(file, [](NewFile& out) {
            ResultWriter writer(out, synthetic_run({.replicas = 9}));
            raise(SIGKILL);
        });
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(files_in(folder.path), 2);
    EXPECT_EQ(bytes_of_file(file), before);
    remove_temporaries(folder.path);
    EXPECT_EQ(files_in(folder.path), 1);
    write_run(file, synthetic_run({.replicas = 1}));  // the left-over file is not in the way
    EXPECT_EQ(read_run(file).recordings.size(), 1u);
}

TEST(damaged_files, files_being_written_are_not_removed) {
    TestFolder folder;
    {
        NewFile out(folder / "run.h5");
        remove_temporaries(folder.path);
        EXPECT_EQ(files_in(folder.path), 1);
        out.close();  // before it is moved into place
        remove_temporaries(folder.path);
        EXPECT_EQ(files_in(folder.path), 1);
        out.put_in_place();
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "run.h5"));
    EXPECT_EQ(files_in(folder.path), 1);
}

TEST(damaged_files, full_disk_is_an_error_and_leaves_the_old_file) {
    TestFolder folder;
    const auto file = folder / "run.h5";
    write_run(file, synthetic_run({.replicas = 1}));
    const std::string before = bytes_of_file(file);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{20000, 20000};
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            write_run(file, synthetic_run({.replicas = 9, .grains = 1000}));
        } catch (const RunError& error) {
            _exit(std::string(error.what()).find("run.h5") != std::string::npos ? 7 : 8);
        }
        _exit(9);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(bytes_of_file(file), before);
    EXPECT_EQ(files_in(folder.path), 1);
}

TEST(damaged_files, an_unwritable_folder_is_named) {
    EXPECT_THROW(write_run("/proc/nowhere/run.h5", synthetic_run()), RunError);
    EXPECT_THROW(replace_file("/proc/nowhere/text", "text"), RunError);
}

}  // namespace
}  // namespace mcdem::test
