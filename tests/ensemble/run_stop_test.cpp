// A run of many replicas stops promptly, whatever it is doing, without loss of data.
#include <gmock/gmock.h>

#include <atomic>

#include "core/errors.h"
#include "ensemble/parts/run_parts.h"
#include "ensemble/run_scene.h"
#include "ensemble/small_scene.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

Scene many_replicas() {
    return small_scene({"batch.replicas=30", "packing.count=4", "packing.packing_fraction=0.1",
                        "plate.end=0.086", "protocol.scans_per_stroke=2", "protocol.settle_time=0.001",
                        "protocol.relax_time=0.001", "output.checkpoint_minutes=1000"});
}

class RunStopTest : public testing::Test {
protected:
    /// Counts in `looks_` the checks for a stop; requests a stop from check `stop_at` on.
    RunEnd run(const Scene& scene, const std::string& name, Start start, int stop_at = -1) {
        RunOptions options;
        options.folder = folder(name);
        options.start = start;
        options.program = "test";
        looks_ = 0;
        options.stop_wanted = [this, stop_at] { return ++looks_ > stop_at && stop_at >= 0; };
        return run_scene(device_, scene, options).end;
    }
    /// The same, stopped after `rounds` rounds.
    RunEnd run_rounds(const Scene& scene, const std::string& name, int rounds) {
        RunOptions options;
        options.folder = folder(name);
        options.program = "test";
        options.on_progress = [&](double) { --rounds; };
        options.stop_wanted = [&] { return rounds <= 0; };
        return run_scene(device_, scene, options).end;
    }
    fs::path folder(const std::string& name) const { return temporary_.path / name; }
    std::string result(const std::string& name) const { return bytes_of_file(run_file(folder(name))); }
    std::string table(const std::string& name) const { return bytes_of_file(folder(name) / "plate.csv"); }
    std::string problem_reading(const std::string& name) const {
        try {
            read_run(folder(name));
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }

    TestFolder temporary_;
    Device device_;
    std::atomic<int> looks_ = 0;
};

TEST_F(RunStopTest, AStoppedRunCanBeRead) {
    for (const Scene& scene : {small_scene(), many_replicas()}) {
        const std::string name = std::to_string(scene.replicas.size());
        ASSERT_EQ(run_rounds(scene, name, 8), RunEnd::interrupted);
        EXPECT_EQ(segment_files(folder(name)).size(), 1u);
        EXPECT_EQ(problem_reading(name), "none");
    }
}

TEST_F(RunStopTest, StopsPromptlyWhileItMergesAndResumesWithTheSameBits) {
    const Scene scene = many_replicas();
    ASSERT_EQ(run(scene, "whole", Start::fresh), RunEnd::done);
    ASSERT_EQ(run_rounds(scene, "a", 8), RunEnd::interrupted);
    ASSERT_EQ(run(scene, "a", Start::resume), RunEnd::done);
    EXPECT_TRUE(result("a") == result("whole"));

    const int all_looks = looks_, last = static_cast<int>(scene.replicas.size());
    ASSERT_GT(all_looks, 7 * last);  // also while it reads and writes
    const int table_looks =
        2 * last;  // a look per replica while run.h5 is read, and one while the table is made
    for (const int stop_at : {all_looks - table_looks - 3 * last, all_looks - table_looks - last / 2}) {
        const std::string name = "stopped at " + std::to_string(stop_at);
        ASSERT_EQ(run_rounds(scene, name, 8), RunEnd::interrupted) << name;
        ASSERT_EQ(run(scene, name, Start::resume, stop_at), RunEnd::interrupted) << name;
        EXPECT_LE(looks_, stop_at + 5) << name;
        EXPECT_FALSE(fs::exists(run_file(folder(name)))) << name;
        ASSERT_EQ(run(scene, name, Start::resume, 1), RunEnd::interrupted) << name;
        ASSERT_EQ(run(scene, name, Start::resume), RunEnd::done) << name;
        EXPECT_TRUE(result(name) == result("whole")) << name;
    }
}

TEST_F(RunStopTest, StopsWhileThePlateTableIsMade) {
    const Scene scene = small_scene({"batch.replicas=4", "protocol.scans_per_stroke=2"});
    ASSERT_EQ(run(scene, "whole", Start::fresh), RunEnd::done);
    const int all_looks = looks_, replicas = static_cast<int>(scene.replicas.size());
    for (int stop_at = all_looks - 2 * replicas; stop_at < all_looks; ++stop_at) {
        const std::string name = "stopped at " + std::to_string(stop_at);
        ASSERT_EQ(run(scene, name, Start::fresh, stop_at), RunEnd::interrupted) << name;
        EXPECT_TRUE(fs::exists(run_file(folder(name)))) << name;
        EXPECT_FALSE(fs::exists(folder(name) / "plate.csv")) << name;
        EXPECT_EQ(run(scene, name, Start::resume, 1), RunEnd::interrupted) << name;
        EXPECT_EQ(run(scene, name, Start::resume), RunEnd::was_done) << name;
        EXPECT_EQ(table(name), table("whole")) << name;
    }
}

TEST_F(RunStopTest, AMergeOfPartsStopsAtTheNextReplicaAndGoesOnWithTheSameBits) {
    const Scene scene = small_scene({"batch.replicas=5", "protocol.scans_per_stroke=2"});
    ASSERT_EQ(run(scene, "whole", Start::fresh), RunEnd::done);
    int stop_at = -1;
    RunOptions options;
    options.folder = folder("parts");
    options.program = "test";
    options.stop_wanted = [&] { return stop_at >= 0 && ++looks_ > stop_at; };
    RunParts parts(scene, options, {2, 1});
    for (const std::size_t part : parts.missing()) parts.compute(device_, part);
    const int replicas = static_cast<int>(scene.replicas.size());
    for (stop_at = 0; stop_at < 3 * replicas; ++stop_at) {
        looks_ = 0;
        EXPECT_THROW(parts.merge(), Interrupted) << stop_at;
        EXPECT_EQ(looks_, stop_at + 1);
        for (const auto& entry : fs::directory_iterator(folder("parts")))
            EXPECT_EQ(entry.path(), parts_folder(folder("parts")));
    }
    for (; !fs::exists(run_file(folder("parts"))); ++stop_at) {
        looks_ = 0;
        EXPECT_THROW(parts.merge(), Interrupted) << stop_at;
    }
    for (stop_at = 0; stop_at < 2 * replicas; ++stop_at) {  // while the plate's table is made
        looks_ = 0;
        EXPECT_THROW(parts.merge(), Interrupted) << stop_at;
        EXPECT_TRUE(fs::exists(parts_folder(folder("parts"))));
        EXPECT_FALSE(fs::exists(folder("parts") / "plate.csv"));
    }
    looks_ = 0;
    EXPECT_TRUE(parts.merge()) << "no look is left";
    EXPECT_TRUE(result("parts") == result("whole"));
    EXPECT_EQ(table("parts"), table("whole"));
}

}  // namespace
}  // namespace mcdem
