// Shared by the tests of scenes.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/errors.h"
#include "scene/read/read_scene.h"

namespace mcdem {

/// The problems that `action` reports; fails the test if there are none.
template <class Action>
std::vector<std::string> problems_of(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.problems();
    }
    ADD_FAILURE() << "no problem was reported";
    return {};
}

/// The problems of a scene's text.
inline std::vector<std::string> problems_in(const std::string& text,
                                            const std::vector<std::string>& overrides = {}) {
    return problems_of([&] { parse_scene(text, "bad.toml", overrides); });
}

/// A temporary folder for one test.
class TestFolder {
public:
    TestFolder() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        path_ =
            std::filesystem::temp_directory_path() / (std::string("mcdem_") + test->test_suite_name() + "_" +
                                                      test->name() + "_" + std::to_string(getpid()));
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() { std::filesystem::remove_all(path_); }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace mcdem
