// What the tests of the program share: a folder with a small scene in it, and the program run there.
#pragma once
#include <gmock/gmock.h>

#include "cli/child.h"
#include "ensemble/small_scene.h"

namespace mcdem {

class CliTest : public testing::Test {
protected:
    CliTest() { std::ofstream(path("small.toml")) << small_scene_text; }

    std::filesystem::path path(const std::string& name) const { return folder_.path / name; }
    Finished mcdem(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& environment = {}) const {
        return run_program(folder_.path, arguments, environment);
    }
    /// The words of a run of the small scene into `out`, and more.
    static std::vector<std::string> run_words(const std::string& out, std::vector<std::string> more = {}) {
        std::vector<std::string> words{"run", "small.toml", "--out", out, "--no-figures"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    void expect_done(const Finished& finished) const { EXPECT_EQ(finished.exit_code, 0) << finished.err; }

    TestFolder folder_;
};

/// Bad input: the exit code, and a part of what is said about it; every line begins with the name.
inline void expect_bad_input(const Finished& finished, const std::string& part) {
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_THAT(finished.err, testing::HasSubstr(part));
    EXPECT_THAT(finished.err, testing::StartsWith("mcdem: "));
    EXPECT_EQ(finished.out, "");
}

}  // namespace mcdem
