// A scene that runs quickly but has rearranging grains, two models and scans at rest.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scene/read/read_scene.h"

namespace mcdem {

inline const std::string small_scene_text = R"(name = "small"
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.088
end = 0.078
[protocol]
scans_per_stroke = 4
stop_at_scans = true
rate_tolerance = 0
settle_time = 0.02
relax_time = 0.02
[batch.vary]
"contact.model" = ["independent", "elastic_sphere"]
)";

inline Scene small_scene(const std::vector<std::string>& overrides = {}) {
    return parse_scene(small_scene_text, "small.toml", overrides);
}

/// A temporary folder for one test.
struct TestFolder {
    TestFolder() {
        auto pattern = (std::filesystem::temp_directory_path() / "mcdem-test-XXXXXX").string();
        path = ::mkdtemp(pattern.data());
    }
    ~TestFolder() { std::filesystem::remove_all(path); }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;
    std::filesystem::path path;
};

inline std::string bytes_of_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace mcdem
