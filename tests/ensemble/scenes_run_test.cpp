// Every scene of the folder scenes/ runs: the first millimetre with one scan per stroke; a programme
// completely, with one cycle each.
#include <gtest/gtest.h>

#include "ensemble/run_scene.h"
#include "ensemble/small_scene.h"
#include "io/results.h"
#include "scene/programme/legs.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t max_replicas = 6;

/// The scene, shortened.
Scene beginning_of(const std::string& name) {
    Scene scene = read_scene(fs::path(MCDEM_SOURCE_DIR) / "scenes" / (name + ".toml"));
    if (scene.replicas.size() > max_replicas) scene.replicas.resize(max_replicas);
    for (Replica& replica : scene.replicas) {
        if (replica.programme.empty())
            replica.plate.end = std::max(replica.plate.end, replica.plate.start - 1e-3);
        replica.protocol.cycles = replica.protocol.scans_per_stroke = 1;
        replica.protocol.settle_time = replica.protocol.relax_time = 1e-3;
        if (replica.protocol.rate_tolerance > 0) replica.protocol.rate_tolerance = 0.1;
        for (Stage& stage : replica.programme) stage.cycles = 1, stage.times = 2;
    }
    return scene;
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(fs::path(MCDEM_SOURCE_DIR) / "scenes"))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    return names;
}

class ScenesRun : public testing::TestWithParam<std::string> {};

TEST_P(ScenesRun, AllScenesStart) {
    TestFolder folder;
    Device device;
    RunOptions options;
    options.folder = folder.path / "run";
    const Scene scene = beginning_of(GetParam());
    EXPECT_EQ(run_scene(device, scene, options).end, RunEnd::done);
    const auto run = read_run(options.folder, ReadWhat::observables);
    for (const auto& recording : run.recordings) {
        EXPECT_FALSE(recording.failure) << recording.label << ": " << recording.failure->cause;
        const Replica& replica = scene.replicas.front();
        EXPECT_EQ(static_cast<double>(recording.scans.size()),
                  scan_count(stages_of(replica)) + (replica.protocol.scan_at_start ? 1 : 0))
            << recording.label;
    }
}

INSTANTIATE_TEST_SUITE_P(Folder, ScenesRun, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace mcdem
