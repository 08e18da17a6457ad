#include "io/result_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/errors.h"
#include "io/result_file.h"
#include "io/results.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void append_segment(ResultFolder&& folder, const Run& run) {
    auto scans = stored_scans(run);
    for (std::size_t r = 0; r < scans.size(); ++r)
        for (const Scan& scan : run.recordings[r].scans) scans[r].append(scan);
    folder.append_segment(run, scans);
}
void append_segment(ResultFolder& folder, const Run& run) { append_segment(std::move(folder), run); }

/// Appends `run` in segments that end at these scans.
void append_in_parts(ResultFolder& folder, const Run& run, const std::vector<std::size_t>& ends) {
    std::size_t first = 0;
    for (std::size_t end : ends) {
        append_segment(folder, part_of(run, first, end));
        first = end;
    }
}

TEST(result_folder, segments_read_the_same_as_the_merged_run_and_the_run_itself) {
    TestFolder place;
    auto run = synthetic_run({.replicas = 3, .scans = 8});
    run.recordings[1].scans.resize(3);  // a replica that stopped
    run.recordings[1].failure = Failure{77, 3, "lost a grain"};
    auto folder = ResultFolder::create(place / "out");
    append_in_parts(folder, run, {2, 2, 5, 8});
    EXPECT_EQ(folder.segments(), 4);
    expect_same(run, read_run(place / "out"));
    RunReader reader(place / "out");
    for (std::size_t s = 0; s < 8; ++s)
        EXPECT_EQ(reader.read_scan(2, s).position, run.recordings[2].scans[s].position) << s;

    folder.finish();
    expect_same(run, read_run(place / "out"));
    EXPECT_TRUE(folder.is_finished());
    EXPECT_TRUE(segment_files(place / "out").empty());
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place / "out"), {}), 1);
}

TEST(result_folder, merged_bytes_do_not_depend_on_the_segments) {
    TestFolder place;
    auto run = synthetic_run({.replicas = 3, .grains = 600, .scans = 120});  // more than one block of scans
    run.recordings[1].failure = Failure{77, 3, "lost a grain"};
    write_run(place / "whole.h5", run);
    const std::vector<std::vector<std::size_t>> cuts{{120}, {1, 2, 120}, {60, 119, 119, 120}};
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        const std::string name = std::to_string(k);
        auto folder = ResultFolder::create(place / name);
        append_in_parts(folder, run, cuts[k]);
        folder.finish();
        EXPECT_TRUE(bytes_of_file(place / "whole.h5") == bytes_of_file(run_file(place / name))) << k;
    }
}

TEST(result_folder, one_segment_becomes_the_run) {
    TestFolder place;
    const auto run = synthetic_run({.precision = "float"});
    auto folder = ResultFolder::create(place / "out");
    append_segment(folder, run);
    folder.finish();
    expect_same(run, read_run(run_file(place / "out")), 6e-8);
}

TEST(result_folder, resuming_deletes_segments_newer_than_the_checkpoint) {
    TestFolder place;
    const auto run = synthetic_run();
    {
        auto folder = ResultFolder::create(place / "out");
        append_in_parts(folder, run, {1, 2, 4});
    }
    auto folder = ResultFolder::open_for_resume(place / "out");
    EXPECT_EQ(folder.segments(), 3);
    folder.drop_segments_from(1);
    append_segment(folder, part_of(run, 1, 6));
    EXPECT_EQ(folder.segments(), 2);
    folder.finish();
    expect_same(run, read_run(place / "out"));
}

TEST(result_folder, an_interrupted_finish_is_completed_by_resuming) {
    TestFolder place;
    const auto run = synthetic_run();
    { append_segment(ResultFolder::create(place / "out"), run); }
    write_run(place / "out/run.h5", run);
    const auto folder = ResultFolder::open_for_resume(place / "out");
    EXPECT_TRUE(folder.is_finished());
    EXPECT_FALSE(std::filesystem::exists(place / "out/segment-000000.h5"));
}

/// Files of others that are called like segments, and links.
TEST(result_folder, removes_only_segments) {
    TestFolder place;
    { append_segment(ResultFolder::create(place / "out"), synthetic_run()); }
    write_bytes(place / "out/segment-000001.h5", "my measurement");
    {
        auto folder = ResultFolder::open_for_resume(place / "out");
        EXPECT_THAT(message_of([&] { folder.drop_segments_from(0); }),
                    HasSubstr("segment-000001.h5: is not a segment of a run, and is not removed"));
    }
    std::filesystem::create_symlink(place / "out/segment-000000.h5", place / "out/segment-000002.h5");
    write_run(place / "out/run.h5", synthetic_run());
    ResultFolder::open_for_resume(place / "out");
    EXPECT_FALSE(std::filesystem::exists(place / "out/segment-000000.h5"));
    EXPECT_TRUE(std::filesystem::exists(place / "out/segment-000001.h5"));
    EXPECT_TRUE(std::filesystem::is_symlink(place / "out/segment-000002.h5"));
}

TEST(result_folder, refuses_to_mix_runs) {
    TestFolder place;
    const auto run = synthetic_run();
    { append_segment(ResultFolder::create(place / "out"), run); }
    EXPECT_THAT(message_of([&] { ResultFolder::create(place / "out"); }), HasSubstr("already holds a run"));
    { ResultFolder::open_for_resume(place / "out").finish(); }
    EXPECT_THAT(message_of([&] { ResultFolder::create(place / "out"); }), HasSubstr("run.h5"));
    write_bytes(place / "file", "");
    EXPECT_THAT(message_of([&] { ResultFolder::create(place / "file"); }), HasSubstr("is a file"));
    EXPECT_THAT(message_of([&] { ResultFolder::open_for_resume(place / "none"); }),
                HasSubstr("nothing to resume"));
    std::filesystem::create_directories(place / "notes");
    write_bytes(place / "notes/mine.txt", "keep");
    EXPECT_NO_THROW(ResultFolder::create(place / "notes"));
}

TEST(result_folder, refuses_a_second_writer) {
    TestFolder place;
    const auto first = ResultFolder::create(place / "out");
    EXPECT_THAT(message_of([&] { ResultFolder::open_for_resume(place / "out"); }),
                HasSubstr("another program"));
}

TEST(result_folder, names_a_missing_or_foreign_segment) {
    TestFolder place;
    const auto run = synthetic_run();
    {
        auto folder = ResultFolder::create(place / "out");
        append_in_parts(folder, run, {1, 2, 4});
    }
    write_run(place / "out/segment-000001.h5", synthetic_run({.replicas = 1}));
    EXPECT_THAT(message_of([&] { read_run(place / "out"); }),
                HasSubstr("segment-000001.h5: belongs to another run"));
    std::filesystem::remove(place / "out/segment-000001.h5");
    EXPECT_THAT(message_of([&] { read_run(place / "out"); }), HasSubstr("segment-000001.h5: is missing"));
}

TEST(result_folder, finishing_nothing_fails_and_leaves_the_folder) {
    TestFolder place;
    auto folder = ResultFolder::create(place / "out");
    EXPECT_THROW(folder.finish(), RunError);
}

TEST(result_folder, stops_between_tables_and_keeps_existing_files) {
    TestFolder place;
    const auto run = synthetic_run({.replicas = 2, .grains = 8});
    const auto looks_of = [](auto write) {
        int looks = 0;
        write([&] { return ++looks < 0; });
        return looks;
    };
    const auto stop_at = [](int last, auto write) {
        int looks = 0;
        EXPECT_THROW(write([&] { return ++looks >= last; }), Interrupted);
        EXPECT_EQ(looks, last);  // no checks and no work afterwards
    };
    const auto files = [&](const char* name) {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(place / name))
            names.insert(entry.path().filename());
        return names;
    };
    int looks_finishing = 0;
    {
        auto whole = ResultFolder::create(place / "whole");
        append_segment(whole, part_of(run, 0, 3));
        append_segment(whole, part_of(run, 3, 6));
        looks_finishing = looks_of([&](auto look) { whole.finish(look); });
    }
    auto stopped = ResultFolder::create(place / "stopped");
    append_segment(stopped, part_of(run, 0, 3));
    append_segment(stopped, part_of(run, 3, 6));
    const auto two = files("stopped");
    for (int last = 1; last <= looks_finishing; ++last) {
        stop_at(last, [&](auto look) { stopped.finish(look); });
        ASSERT_EQ(files("stopped"), two) << last;
    }
    stopped.finish();
    EXPECT_EQ(bytes_of_file(place / "stopped" / "run.h5"), bytes_of_file(place / "whole" / "run.h5"));
}

}  // namespace
}  // namespace mcdem::test
