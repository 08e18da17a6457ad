// Shared by the tests of the program: a folder with a small scene, and functions that run the program there.
#pragma once
#include <gmock/gmock.h>

#include <chrono>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "cli/child.h"
#include "ensemble/small_scene.h"

namespace mcdem {

/// Ends a test of commands that need the compiled module of the Python package where that was not built.
#define NEEDS_PYTHON_MODULE() \
    if (!MCDEM_TEST_PYTHON) GTEST_SKIP() << "the Python module was not built (pybind11-dev, python3-dev)"

/// The words of a command line; blanks separate them.
inline std::vector<std::string> split(const std::string& line) {
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

/// Bad input: checks the exit code and a part of the message; every line begins with the program's name.
inline void expect_bad_input(const Finished& finished, const std::string& part) {
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_THAT(finished.err, testing::HasSubstr(part));
    EXPECT_THAT(finished.err, testing::StartsWith("mcdem: "));
    EXPECT_EQ(finished.out, "");
}

class CliTest : public testing::Test {
protected:
    CliTest() { std::ofstream(path("small.toml")) << small_scene_text; }

    std::filesystem::path path(const std::string& name) const { return folder_.path / name; }
    Finished mcdem(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& environment = {}) const {
        return run_program(folder_.path, arguments, environment);
    }
    /// Runs a command line.
    Finished line(const std::string& words) const { return mcdem(split(words)); }
    void expect_refused(const std::string& words, const std::string& problem) const {
        SCOPED_TRACE(words);
        expect_bad_input(line(words), problem);
    }
    /// Arguments of a run of the small scene into `out`, and further ones.
    static std::vector<std::string> run_words(const std::string& out, std::vector<std::string> more = {}) {
        std::vector<std::string> words{"run", "small.toml", "--out", out, "--no-figures"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    /// Environment in which a run blocks after this number of launches of a kernel (one per step), until
    /// released.
    std::vector<std::string> held_after(long launches) const {
        std::filesystem::create_directories(path("held"));
        return {"OPENCL_LAYERS=" MCDEM_DEVICE_LAYER, "MCDEM_TEST_KERNELS=" + std::to_string(launches),
                "MCDEM_TEST_HOLD=" + path("held").string()};
    }
    /// Waits until the child is blocked; fails if it has ended.
    void wait_until_held(Child& child) const {
        while (!std::filesystem::exists(held_file(child))) {
            if (!child.is_running())
                throw std::runtime_error("ended before it was held: " + child.wait().err);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    void let_go_on(const Child& child) const { std::filesystem::remove(held_file(child)); }
    /// Of the child, or of the interpreter that it has started.
    std::filesystem::path held_file(const Child& child) const {
        for (const auto& file : std::filesystem::directory_iterator(path("held")))
            if (parent_of(file.path().filename()) == child.process()) return file;
        return path("held") / std::to_string(child.process());
    }
    void expect_done(const Finished& finished) const { EXPECT_EQ(finished.exit_code, 0) << finished.err; }
    void expect_done(const std::string& words) const { expect_done(line(words)); }

    TestFolder folder_;

private:
    /// 0: the process is not there.
    static pid_t parent_of(const std::string& process) {
        std::ifstream status("/proc/" + process + "/status");
        pid_t parent = 0;
        for (std::string word; status >> word;)
            if (word == "PPid:" && status >> parent) break;
        return parent;
    }
};

}  // namespace mcdem
