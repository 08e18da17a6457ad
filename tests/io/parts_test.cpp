// Merged parts of a run: the same bytes as the file of a single process.

#include <gmock/gmock.h>

#include "core/errors.h"
#include "io/result_folder.h"
#include "io/results.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

/// A file that contains only these replicas of the run.
std::filesystem::path write_part(const TestFolder& place, Run run, std::size_t first, std::size_t last) {
    run.recordings = {run.recordings.begin() + static_cast<std::ptrdiff_t>(first),
                      run.recordings.begin() + static_cast<std::ptrdiff_t>(last)};
    const auto file = place / ("part-" + std::to_string(first) + ".h5");
    write_run(file, run);
    return file;
}

class PartsTest : public testing::TestWithParam<const char*> {
protected:
    PartsTest() {
        run_ = synthetic_run({.replicas = 5, .scans = 7, .precision = GetParam()});
        run_.recordings[3].scans.resize(2);  // a replica that stopped
        run_.recordings[3].failure = Failure{5, 1, "lost a grain"};
        parts_ = {write_part(place_, run_, 0, 2), write_part(place_, run_, 2, 4),
                  write_part(place_, run_, 4, 5)};
        write_run(place_ / "whole.h5", run_);
    }
    TestFolder place_;
    mcdem::Run run_;
    std::vector<std::filesystem::path> parts_;
};

TEST_P(PartsTest, MergedPartsHaveTheBytesOfTheWholeRun) {
    merge_parts(parts_, place_ / "merged.h5");
    EXPECT_TRUE(bytes_of_file(place_ / "merged.h5") == bytes_of_file(place_ / "whole.h5"));
    expect_same(read_run(place_ / "whole.h5"), read_run(place_ / "merged.h5"));
}

TEST_P(PartsTest, ADamagedPartIsNamedAndNothingIsWritten) {
    auto bytes = bytes_of_file(parts_[1]);
    for (std::size_t k = bytes.size() / 2; k < bytes.size(); k += 64) bytes[k] ^= 1;  // not only in gaps
    for (const std::string& damaged : {bytes, bytes.substr(0, bytes.size() / 2)}) {
        write_bytes(parts_[1], damaged);
        try {
            merge_parts(parts_, place_ / "merged.h5");
            ADD_FAILURE() << "merged, with a damaged part";
        } catch (const DamagedPart& found) {
            EXPECT_EQ(found.part, 1u);
            EXPECT_THAT(found.what(), testing::HasSubstr("part-2.h5"));
        }
        EXPECT_FALSE(std::filesystem::exists(place_ / "merged.h5"));
    }
}

INSTANTIATE_TEST_SUITE_P(Precisions, PartsTest, testing::Values("double", "float"));

TEST(result_folder, with_parts_is_neither_a_new_folder_nor_a_run) {
    TestFolder place;
    std::filesystem::create_directories(parts_folder(place / "out"));
    EXPECT_THROW(ResultFolder::create(place / "out"), InputError);
    try {
        read_run(place / "out");
        ADD_FAILURE() << "read";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("not merged yet"));
    }
}

}  // namespace
}  // namespace mcdem::test
