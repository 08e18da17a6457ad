#include "core/look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "core/errors.h"
#include "core/test_folder.h"

namespace mcdem::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Look : public testing::Test {
protected:
    Look() {
        std::ofstream(folder_ / "file") << "four";
        fs::create_symlink("file", folder_ / "link");
        fs::create_symlink("none", folder_ / "broken");
        fs::create_symlink("loop", folder_ / "loop");
        mkfifo((folder_ / "pipe").c_str(), 0600);
    }
    template <class Call>
    static std::string error_of(Call call) {
        try {
            call();
        } catch (const RunError& error) {
            return error.what();
        }
        return "";
    }
    const TestFolder temporary_;
    const fs::path folder_ = temporary_.path;
};

TEST_F(Look, TellsWhatIsAtAPath) {
    EXPECT_EQ(look_at(folder_), At::folder);
    EXPECT_EQ(look_at(folder_ / "file"), At::file);
    EXPECT_EQ(look_at(folder_ / "link"), At::file);
    EXPECT_EQ(look_at_itself(folder_ / "link"), At::link);
    EXPECT_EQ(look_at(folder_ / "broken"), At::nothing);
    EXPECT_EQ(look_at_itself(folder_ / "broken"), At::link);
    EXPECT_EQ(look_at_itself(folder_ / "loop"), At::link);
    EXPECT_EQ(look_at(folder_ / "pipe"), At::other);
    EXPECT_EQ(look_at(folder_ / "none"), At::nothing);
    EXPECT_EQ(look_at(folder_ / "file/below"), At::nothing);
    EXPECT_EQ(look_at(""), At::nothing);
    EXPECT_EQ(size_of_file(folder_ / "file"), 4u);
    EXPECT_EQ(entries_of(folder_).size(), 5u);
}

TEST_F(Look, WhatCannotBeLookedAtIsAnError) {
    const fs::path loop = folder_ / "loop", longest = folder_ / std::string(5000, 'x');
    for (const auto& [path, reason] :
         {std::pair(loop, "Too many levels of symbolic links"), std::pair(longest, "File name too long")}) {
        const std::string wanted = path.string() + ": cannot be looked at: " + reason;
        EXPECT_THAT(error_of([&] { look_at(path); }), HasSubstr(wanted));
        EXPECT_THAT(error_of([&] { is_file(path); }), HasSubstr(wanted));
        EXPECT_THAT(error_of([&] { size_of_file(path); }), HasSubstr(wanted));
    }
    EXPECT_THAT(error_of([&] { size_of_file(folder_ / "none"); }),
                HasSubstr("none: cannot be looked at: No such file"));
    EXPECT_THAT(error_of([&] { entries_of(folder_ / "none"); }),
                HasSubstr((folder_ / "none").string() + ": its files cannot be listed: No such file"));
}

}  // namespace
}  // namespace mcdem::test
