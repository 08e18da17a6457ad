// Files that are moved into place as a whole; paths that are not regular files are refused.
#include "core/atomic_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include "core/errors.h"
#include "core/input_file.h"
#include "core/test_folder.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class AtomicFileTest : public testing::Test {
protected:
    const TestFolder temporary_;
    const fs::path folder_ = temporary_.path;
};

TEST_F(AtomicFileTest, TemporaryNamesAreUnpredictable) {
    std::set<fs::path> names;
    for (int k = 0; k < 20; ++k) {
        const NewFile out(folder_ / "run.h5");
        names.insert(out.temporary());
        EXPECT_TRUE(fs::exists(out.temporary()));
    }
    EXPECT_EQ(names.size(), 20u);
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(AtomicFileTest, OfSeveralThreadsOneCreatesTheFile) {
    std::atomic<int> first{0}, winner{-1};
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&, t] {
                if (!create_file(folder_ / "file", std::to_string(t))) return;
                ++first;
                winner = t;
            });
    }
    EXPECT_EQ(first, 1);
    EXPECT_EQ(read_file(folder_ / "file"), std::to_string(winner));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "temporaries stay";
}

TEST_F(AtomicFileTest, ALinkIsReplacedAndNotFollowed) {
    std::ofstream(folder_ / "thesis") << "mine";
    fs::create_symlink(folder_ / "thesis", folder_ / "run.h5");
    replace_file(folder_ / "run.h5", "results");
    EXPECT_EQ(read_file(folder_ / "thesis"), "mine");
    EXPECT_EQ(read_file(folder_ / "run.h5"), "results");
}

TEST_F(AtomicFileTest, OnlyTemporariesOfThisProgramAreRemoved) {
    for (const char* name :
         {"run.h5.0123456789abcdef.tmp", "mine.tmp", "run.h5.tmp", "a.0123456789ABCDEF.tmp"})
        std::ofstream(folder_ / name) << "text";
    remove_temporaries(folder_);
    EXPECT_FALSE(fs::exists(folder_ / "run.h5.0123456789abcdef.tmp"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3);
}

TEST_F(AtomicFileTest, OnlyAbandonedTemporariesOfThisNameAreRemoved) {
    const auto abandoned = folder_ / "lab.0123456789abcdef.tmp";
    for (const fs::path& made : {abandoned, folder_ / "lab.backup", folder_ / "other.0123456789abcdef.tmp"}) {
        fs::create_directory(made);
        std::ofstream(made / "plate.csv") << "text";
    }
    {
        const NewFile mine(folder_ / "lab");
        remove_temporaries_of(folder_ / "lab");
        EXPECT_TRUE(fs::exists(mine.temporary()));
        EXPECT_FALSE(fs::exists(abandoned));
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3);
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
}

std::string error_of_reading(const fs::path& file) {
    try {
        read_file(file);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "none";
}

// Processes that share a folder remove files of killed ones while others write.
TEST_F(AtomicFileTest, FilesBeingWrittenAreNotRemoved) {
    std::atomic<bool> done = false;
    std::jthread sweeper([&] {
        while (!done) remove_temporaries(folder_);
    });
    for (int k = 0; k < 1000; ++k) {
        NewFile file(folder_ / "file");
        file.write("whole");
        EXPECT_NO_THROW(file.put_in_place()) << k;
    }
    done = true;
}

TEST_F(AtomicFileTest, WhatIsNotARegularFileIsRefusedAtOnce) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(error_of_reading(folder_ / "pipe"), HasSubstr("is a pipe or device"));
    EXPECT_THAT(error_of_reading("/dev/zero"), HasSubstr("is a pipe or device"));
    EXPECT_THAT(error_of_reading(folder_), HasSubstr("is a folder"));
    EXPECT_THAT(error_of_reading(folder_ / "none"), HasSubstr("no such file"));
    EXPECT_THROW(read_file(folder_ / "none"), InputError);
}

TEST_F(AtomicFileTest, SystemErrorsAreNotInputErrors) {
    fs::create_symlink(folder_ / "loop", folder_ / "loop");
    EXPECT_THROW(read_file(folder_ / "loop"), RunError);
    EXPECT_THAT(error_of_reading(folder_ / "loop"), HasSubstr("remove the cause and try again"));
}

}  // namespace
}  // namespace mcdem
