// Runs into a folder: the files they write, and interrupted runs that end with the same bytes.
#include "ensemble/run_scene.h"

#include <gmock/gmock.h>

#include "cl/program.h"
#include "core/errors.h"
#include "core/sha256.h"
#include "ensemble/small_scene.h"
#include "io/checkpoint.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

class RunSceneTest : public testing::Test {
protected:
    RunSummary run(const Scene& scene, const std::string& name, Start start = Start::fresh, int rounds = -1) {
        RunOptions options;
        options.folder = folder(name);
        options.start = start;
        options.program = program_;
        options.on_failure = [this](const Replica& replica, const Failure&) {
            failed_.push_back(replica.label);
        };
        options.on_warning = [this](const std::string& message) { warnings_.push_back(message); };
        bool begun = false;
        options.on_progress = [&](double) {
            begun = true;
            --rounds;
        };
        options.stop_wanted = [&] { return begun && rounds == 0; };
        return run_scene(device_, scene, options);
    }
    fs::path folder(const std::string& name) const { return temporary_.path / name; }
    std::string result(const std::string& name) const { return bytes_of_file(run_file(folder(name))); }

    /// The error of resuming `name` with this scene.
    std::string problem_resuming(const Scene& scene, const std::string& name) {
        try {
            run(scene, name, Start::resume);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }

    TestFolder temporary_;
    Device device_;
    std::string program_ = "test";
    std::vector<std::string> failed_, warnings_;
};

TEST_F(RunSceneTest, WritesOnlyResultAndSummary) {
    const auto summary = run(small_scene(), "a");
    EXPECT_EQ(summary.end, RunEnd::done);
    EXPECT_GT(summary.grain_steps, 0);
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder("a"))) names.push_back(entry.path().filename());
    EXPECT_THAT(names, testing::UnorderedElementsAre("run.h5", "plate.csv"));
    const auto written = read_run(folder("a"));
    ASSERT_EQ(written.recordings.size(), 2u);
    for (const auto& recording : written.recordings) {
        ASSERT_EQ(recording.scans.size(), 8u);
        EXPECT_EQ(recording.scans.front().position.size(), 30u);
        EXPECT_GT(recording.scans[3].top_force(), 0);
    }
    EXPECT_EQ(written.scene, small_scene_text);
}

TEST_F(RunSceneTest, TwoFreshRunsHaveTheSameBytes) {
    run(small_scene(), "a");
    run(small_scene(), "b");
    EXPECT_EQ(result("a"), result("b"));
    run(small_scene({"packing.seed=2"}), "c");
    EXPECT_NE(result("a"), result("c"));  // checks that the comparison can fail
}

TEST_F(RunSceneTest, ResumedRunEndsWithTheSameBytes) {
    run(small_scene(), "whole");
    for (int rounds : {1, 12, 32}) {
        const auto name = "stopped after " + std::to_string(rounds);
        ASSERT_EQ(run(small_scene(), name, Start::fresh, rounds).end, RunEnd::interrupted);
        EXPECT_FALSE(fs::exists(run_file(folder(name))));
        int times = 1;
        while (run(small_scene(), name, Start::resume, times < 4 ? rounds : -1).end == RunEnd::interrupted)
            ++times;
        EXPECT_GT(times, 1);
        EXPECT_TRUE(result(name) == result("whole")) << name;
    }
    EXPECT_THAT(warnings_, testing::IsEmpty());
}

TEST_F(RunSceneTest, SegmentNewerThanTheCheckpointIsDropped) {
    run(small_scene(), "whole");
    run(small_scene(), "a", Start::fresh, 25);
    const auto checkpoint = bytes_of_file(folder("a") / "checkpoint.h5");
    run(small_scene(), "a", Start::resume, 25);
    ASSERT_GT(segment_files(folder("a")).size(), 1u);
    // As if the power had failed between the segment and its checkpoint.
    std::ofstream(folder("a") / "checkpoint.h5", std::ios::binary) << checkpoint;
    run(small_scene(), "a", Start::resume);
    EXPECT_TRUE(result("a") == result("whole"));
}

TEST_F(RunSceneTest, StartsAgainIfThereIsNoCheckpoint) {
    run(small_scene(), "whole");
    run(small_scene(), "a", Start::fresh, 3);
    remove_checkpoint(folder("a"));
    run(small_scene(), "a", Start::resume);
    EXPECT_TRUE(result("a") == result("whole"));
}

TEST_F(RunSceneTest, FinishedRunIsNotChanged) {
    run(small_scene(), "a");
    const auto before = result("a");
    fs::remove(folder("a") / "plate.csv");  // as if stopped right after writing run.h5
    EXPECT_EQ(run(small_scene(), "a", Start::resume).end, RunEnd::was_done);
    EXPECT_EQ(result("a"), before);
    EXPECT_TRUE(fs::exists(folder("a") / "plate.csv"));
    EXPECT_THAT(problem_resuming(small_scene({"packing.seed=2"}), "a"), testing::HasSubstr("scene"));
}

TEST_F(RunSceneTest, RefusesToResumeAnotherScene) {
    const auto changed = small_scene({"grains.friction=0.1"});
    run(small_scene(), "a", Start::fresh, 10);
    EXPECT_THAT(problem_resuming(changed, "a"), testing::HasSubstr("scene it was begun with"));
    remove_checkpoint(folder("a"));  // the segments also identify the scene
    EXPECT_THAT(problem_resuming(changed, "a"), testing::HasSubstr("scene it was begun with"));
    EXPECT_THAT(problem_resuming(small_scene(), "nowhere"), testing::HasSubstr("nothing to resume"));

    run(small_scene(), "b", Start::fresh, 10);
    auto checkpoint = *read_checkpoint(folder("b"));
    const auto device = checkpoint.device;
    checkpoint.device = "another device";
    write_checkpoint(folder("b"), checkpoint);
    EXPECT_THAT(problem_resuming(small_scene(), "b"), testing::HasSubstr("begun on, another device"));
    checkpoint.device = device;
    checkpoint.segments = 5;
    write_checkpoint(folder("b"), checkpoint);
    EXPECT_THAT(problem_resuming(small_scene(), "b"), testing::HasSubstr("5 segments"));
}

TEST_F(RunSceneTest, RefusesAPackingFileThatHasChanged) {
    const auto file = temporary_.path / "grain.csv";
    const auto scene_with = [&](const char* z) {
        std::ofstream(file) << "x_m,y_m,z_m,diameter_m\n0.03,0.03," << z << ",0.02\n";
        return small_scene({"packing.file=" + file.string(), "plate.start=0.021", "plate.end=0.019"});
    };
    run(scene_with("0.0100"), "a", Start::fresh, 2);
    EXPECT_THAT(problem_resuming(scene_with("0.0101"), "a"), testing::HasSubstr("packing file"));
    EXPECT_EQ(problem_resuming(scene_with("0.0100"), "a"), "none");
}

TEST_F(RunSceneTest, RefusesACheckpointOfOtherKernels) {
    run(small_scene(), "a", Start::fresh, 10);
    auto checkpoint = *read_checkpoint(folder("a"));
    const auto kernels = checkpoint.fields["kernels"];
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(kernels.data()), kernels.size()),
              Sha256().add(program_text()).hex());
    checkpoint.fields["kernels"].back() ^= std::byte{1};
    write_checkpoint(folder("a"), checkpoint);
    program_ = "newer";
    EXPECT_THAT(problem_resuming(small_scene(), "a"),
                testing::HasSubstr("written with other kernels, those of program test; this is newer"));
    checkpoint.fields.erase("kernels");  // of a version that did not record them
    write_checkpoint(folder("a"), checkpoint);
    EXPECT_THAT(problem_resuming(small_scene(), "a"), testing::HasSubstr("written with other kernels"));
    checkpoint.fields["kernels"] = kernels;
    write_checkpoint(folder("a"), checkpoint);
    EXPECT_EQ(problem_resuming(small_scene(), "a"), "none");
}

TEST_F(RunSceneTest, WarnsIfAnotherProgramVersionResumes) {
    run(small_scene(), "a", Start::fresh, 10);
    program_ = "newer";
    run(small_scene(), "a", Start::resume);
    EXPECT_THAT(warnings_,
                testing::ElementsAre(testing::HasSubstr("was begun by test, is continued by newer")));
}

TEST_F(RunSceneTest, FailedReplicaIsRecordedAndTheOtherContinues) {
    const auto scene = small_scene(
        {"batch.vary.numerics.overlap_limit=[0.0005, 0.5]", "batch.vary.contact.model=[\"elastic_sphere\"]"});
    run(scene, "whole");
    EXPECT_THAT(failed_, testing::ElementsAre(scene.replicas[0].label));
    const auto result_of_whole = read_run(folder("whole"));
    ASSERT_TRUE(result_of_whole.recordings[0].failure);
    EXPECT_THAT(result_of_whole.recordings[0].failure->cause, testing::HasSubstr("overlap"));
    EXPECT_FALSE(result_of_whole.recordings[1].failure);
    EXPECT_EQ(result_of_whole.recordings[1].scans.size(), 8u);
    run(scene, "alone", Start::fresh, 40);
    while (run(scene, "alone", Start::resume, 40).end == RunEnd::interrupted) {
    }
    EXPECT_TRUE(result("alone") == result("whole"));
}

}  // namespace
}  // namespace mcdem
