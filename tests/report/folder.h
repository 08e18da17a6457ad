// A temporary folder for one test.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

namespace mcdem {

struct TestFolder {
    TestFolder() {
        auto pattern = (std::filesystem::temp_directory_path() / "mcdem-report-XXXXXX").string();
        path = ::mkdtemp(pattern.data());
    }
    ~TestFolder() { std::filesystem::remove_all(path); }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    std::filesystem::path path;
};

}  // namespace mcdem
