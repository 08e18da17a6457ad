// A run in parts: bit-identical to the run of one process, for any division, order or interruption.
#include "ensemble/parts/run_parts.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/errors.h"
#include "ensemble/parts/manifest.h"
#include "ensemble/small_scene.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class RunPartsTest : public testing::Test {
protected:
    RunPartsTest() { whole_again(); }

    /// The run of the present scene by one process.
    void whole_again() {
        fs::remove_all(folder("whole"));
        RunOptions options;
        options.folder = folder("whole");
        options.program = "test";
        run_scene(device_, scene_, options);
    }
    RunParts parts_of(const std::string& name, std::size_t part_replicas = 1) {
        RunOptions options;
        options.folder = folder(name);
        options.program = "test";
        options.on_warning = [this](const std::string& message) { warnings_.push_back(message); };
        options.stop_wanted = [this] { return rounds_ == 0; };
        RunParts parts(scene_, options, {part_replicas, 1});
        return parts;
    }
    /// As another process would do it.
    void compute(const std::string& name, std::initializer_list<std::size_t> numbers) {
        RunParts parts = parts_of(name);
        for (const std::size_t part : numbers) parts.compute(device_, part);
    }
    /// Interrupts a part after this number of rounds, with a checkpoint.
    void interrupt(const std::string& name, std::size_t part, int rounds) {
        RunParts parts = parts_of(name);
        rounds_ = rounds;
        parts.on_progress = [this](double) { --rounds_; };
        EXPECT_THROW(parts.compute(device_, part), Interrupted);
        rounds_ = -1;
    }
    /// Computes the missing parts until all are merged.
    void finish(const std::string& name, std::size_t part_replicas = 1) {
        RunParts parts = parts_of(name, part_replicas);
        do
            for (const std::size_t part : parts.missing()) parts.compute(device_, part);
        while (!parts.merge());
    }
    RunEnd run_alone(const std::string& name, Start start, std::function<void()> meanwhile = {}) {
        RunOptions options;
        options.folder = folder(name);
        options.program = "test";
        options.start = start;
        options.on_progress = [&](double) {
            if (meanwhile) std::exchange(meanwhile, {})();
        };
        return run_scene(device_, scene_, options).end;
    }
    fs::path folder(const std::string& name) const { return temporary_.path / name; }
    fs::path file(const std::string& name, const std::string& part) const {
        return parts_folder(folder(name)) / part;
    }
    fs::path work_folder(const std::string& name) const {
        for (const auto& entry : fs::directory_iterator(parts_folder(folder(name))))
            if (entry.is_directory()) return entry.path();
        return {};
    }
    void expect_like_whole(const std::string& name) const {
        for (const char* file : {"run.h5", "plate.csv"})
            EXPECT_TRUE(bytes_of_file(folder(name) / file) == bytes_of_file(folder("whole") / file)) << file;
        EXPECT_EQ(std::distance(fs::directory_iterator(folder(name)), {}), 2) << "something is left over";
    }
    template <class Act>
    static std::string problem_of(Act act) {
        try {
            act();
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }
    std::string problem(const std::string& name) {
        return problem_of([&] { finish(name); });
    }
    void set_another_scene() { scene_ = small_scene({"batch.replicas=3", "protocol.scans_per_stroke=3"}); }

    TestFolder temporary_;
    Device device_;
    Scene scene_ = small_scene({"batch.replicas=3", "protocol.scans_per_stroke=2"});  // 6 replicas
    std::vector<std::string> warnings_;
    int rounds_ = -1;  ///< until the interruption; -1: never
};

TEST_F(RunPartsTest, GiveTheBytesOfASingleProcessForAnyPartSize) {
    for (const std::size_t size : {0, 1, 4, 100}) {
        const auto name = "parts of " + std::to_string(size);
        finish(name, size);
        expect_like_whole(name);
    }
    EXPECT_TRUE(parts_of("parts of 4").missing().empty());
    parts_of("parts of 4").compute(device_, 0);
    expect_like_whole("parts of 4");
}

/// Programmes for every container in one run, with species.
class ProgrammePartsTest : public RunPartsTest, public testing::WithParamInterface<const char*> {
protected:
    ProgrammePartsTest() {
        scene_ = parse_scene(std::string(R"(name = "programme"
[packing]
count = 90
packing_fraction = 0.5
[protocol]
rate_tolerance = 0.1
settle_time = 0.002
relax_time = 0.002
[[species]]
name = "soft"
[[species]]
name = "stiff"
youngs_modulus = 5e4
[batch]
replicas = 2
[batch.vary]
"contact.model" = ["independent", "mc_dem"]
)") + GetParam(),
                             "programme.toml", {});
        whole_again();
    }
};

const char* const plate_programme = R"([container]
shape = "cylinder"
radius = 0.045
[plate]
start = 0.16
end = 0.11
speed = 1
[[programme]]
position = 0.14
scans = 2
[[programme]]
stage = "hold"
time = 0.004
scans = 2
[[programme]]
stage = "cycle"
position = 0.138
back = 0.14
cycles = 2
growth = 0.5
)";
const char* const cell_programme = R"([container]
shape = "cell"
size_x = 0.095
size_y = 0.095
[[programme]]
strain = 0.02
rate = 5
scans = 2
[[programme]]
shear_xz = 0.05
rate = 5
[[programme]]
stage = "hold"
time = 0.004
)";

TEST_P(ProgrammePartsTest, InPartsAndInterruptedGiveTheBytesOfASingleProcess) {
    finish("parts", 3);
    expect_like_whole("parts");
    interrupt("interrupted", 0, 2);
    ASSERT_TRUE(fs::exists(work_folder("interrupted") / "checkpoint.h5"));
    finish("interrupted");
    expect_like_whole("interrupted");
}

INSTANTIATE_TEST_SUITE_P(Containers, ProgrammePartsTest, testing::Values(plate_programme, cell_programme),
                         [](const auto& about) { return about.index == 0 ? "Cylinder" : "Cell"; });

TEST_F(RunPartsTest, PartSizeFollowsTheNumberOfWorkers) {
    RunOptions options;
    options.folder = folder("cut");
    EXPECT_EQ(RunParts(scene_, options, {0, 1}).count(), 2u);
    EXPECT_EQ(RunParts(scene_, options, {1, 1}).count(), 2u) << "who comes first decides";
    options.folder = folder("other");
    EXPECT_EQ(RunParts(scene_, options, {0, 3}).count(), 6u);
}

TEST_F(RunPartsTest, AreComputedInAnyOrderAndOnlyOnce) {
    compute("two", {4, 1});
    EXPECT_THAT(parts_of("two").missing(), ElementsAre(0, 2, 3, 5));
    EXPECT_FALSE(parts_of("two").merge());
    EXPECT_FALSE(fs::exists(run_file(folder("two"))));
    const auto written = fs::last_write_time(file("two", "00001.h5"));
    compute("two", {1});
    EXPECT_EQ(fs::last_write_time(file("two", "00001.h5")), written);
    finish("two");
    expect_like_whole("two");
}

TEST_F(RunPartsTest, ComputedByTwoProcessesAreTheSame) {
    RunParts one = parts_of("twice");
    bool done = false;
    one.on_progress = [&](double) {
        if (!std::exchange(done, true)) finish("twice");  // and merges while the first one computes
    };
    one.compute(device_, 3);
    EXPECT_TRUE(one.missing().empty());
    EXPECT_TRUE(one.merge());
    expect_like_whole("twice");
}

TEST_F(RunPartsTest, ContinueFromTheCheckpointOfAnInterruptedPart) {
    interrupt("often", 0, 1);
    const auto checkpoint = work_folder("often") / "checkpoint.h5";
    ASSERT_TRUE(fs::exists(checkpoint));
    int rounds = 0, whole = 0;
    RunParts parts = parts_of("often");
    parts.on_progress = [&](double) { ++rounds; };
    parts.compute(device_, 0);
    parts.on_progress = [&](double) { ++whole; };
    fs::remove(file("often", "00000.h5"));
    parts.compute(device_, 0);
    EXPECT_LT(rounds, whole);
    EXPECT_TRUE(work_folder("often").empty());
    finish("often");
    expect_like_whole("often");
}

TEST_F(RunPartsTest, DoNotTouchACheckpointInUse) {
    interrupt("held", 0, 1);
    const auto work = work_folder("held");
    {
        const FolderLock theirs(work, FolderLock::Use::alone);
        compute("held", {0});
        EXPECT_TRUE(fs::exists(work / "checkpoint.h5"));
    }
    finish("held");
    expect_like_whole("held");
}

TEST_F(RunPartsTest, UnusableFilesOfAPartAreDeleted) {
    interrupt("lost", 0, 1);
    for (const char* name : {"checkpoint.h5", "segment-000000.h5"})
        std::ofstream(work_folder("lost") / name) << "damaged";
    finish("lost");
    EXPECT_THAT(warnings_, ElementsAre(HasSubstr("computed again")));
    expect_like_whole("lost");
}

TEST_F(RunPartsTest, FilesOfOthersAreKeptBesideParts) {
    compute("shared", {0});
    std::ofstream(file("shared", "notes.txt")) << "mine";
    std::ofstream(file("shared", "measured.h5")) << "mine";
    finish("shared");
    const fs::path kept = folder("shared") / "parts.merged";
    EXPECT_TRUE(fs::exists(kept / "notes.txt") && fs::exists(kept / "measured.h5"));
    EXPECT_EQ(fs::remove_all(kept), 3u);  // they and their folder
    expect_like_whole("shared");
}

TEST_F(RunPartsTest, ADamagedPartIsComputedAgain) {
    for (const bool when_merged : {true, false}) {
        const std::string name = when_merged ? "merged" : "asked for";
        compute(name, {0, 1, 2, 3, 4, 5});
        const auto part = file(name, "00000.h5");
        fs::resize_file(part, fs::file_size(part) / 2);
        if (!when_merged) compute(name, {0});
        finish(name);
        EXPECT_THAT(warnings_, ElementsAre(HasSubstr("part 00000 is computed again")));
        warnings_.clear();
        expect_like_whole(name);
    }
}

TEST_F(RunPartsTest, APartWithOtherReplicasIsComputedAgain) {
    compute("copied", {0, 1});
    fs::copy_file(file("copied", "00000.h5"), file("copied", "00001.h5"),
                  fs::copy_options::overwrite_existing);
    finish("copied");
    EXPECT_THAT(warnings_, ElementsAre(HasSubstr("part 00001 is computed again")));
    expect_like_whole("copied");
}

TEST_F(RunPartsTest, AnInvalidPartSizeIsRefused) {
    compute("none", {0});
    const auto manifest = file("none", "manifest.json");
    const std::string whole = bytes_of_file(manifest), size = "\"replicas of a part\": \"1\"";
    ASSERT_THAT(whole, HasSubstr(size));
    for (const char* other : {"0", "-1", "", "1e3", "99999999999999999999"}) {
        std::string changed = whole;
        changed.replace(whole.find(size), size.size(), fmt::format("\"replicas of a part\": \"{}\"", other));
        std::ofstream(manifest) << changed;
        EXPECT_THAT(problem("none"), HasSubstr("must be a number of replicas above 0")) << other;
    }
    std::ofstream(manifest) << whole;
    finish("none");
    expect_like_whole("none");
}

TEST_F(RunPartsTest, ADamagedManifestIsRefused) {
    compute("cut", {1});
    for (const char* damaged : {"", "{\"program\"", "[]", "{\"replicas of a part\": [1]}"}) {
        std::ofstream(file("cut", "manifest.json")) << damaged;
        EXPECT_THAT(problem("cut"), HasSubstr("manifest.json: is damaged")) << damaged;
    }
}

TEST_F(RunPartsTest, OfAnotherDeviceAreRefused) {
    compute("device", {0});
    std::ofstream(file("device", "device.json")) << "{\"device\": \"another\"}";
    EXPECT_THAT(problem("device"), HasSubstr("begun with another device: another; got "));
    std::ofstream(file("device", "device.json")) << "";
    EXPECT_THAT(problem("device"), HasSubstr("device.json: is damaged"));
}

TEST_F(RunPartsTest, AnInterruptedMergeIsCompleted) {
    compute("cut", {0, 1, 2, 4, 5});  // 3 is not needed any more
    fs::copy_file(folder("whole") / "run.h5", folder("cut") / "run.h5");
    finish("cut");
    expect_like_whole("cut");
}

TEST_F(RunPartsTest, OtherRunsAreRefused) {
    compute("mine", {0});
    set_another_scene();
    EXPECT_THAT(problem("mine"), HasSubstr("begun with another scene"));
    EXPECT_THAT(problem("whole"), HasSubstr("the scene it was begun with"));
    std::ofstream(temporary_.path / "file") << "text";
    EXPECT_THAT(problem("file"), HasSubstr("is a file"));
    fs::create_directories(folder("one"));
    std::ofstream(folder("one") / "checkpoint.h5") << "";
    EXPECT_THAT(problem("one"), HasSubstr("--resume"));
}

TEST_F(RunPartsTest, ARunningSingleProcessIsNotJoined) {
    std::string joining;
    EXPECT_EQ(run_alone("one", Start::fresh,
                        [&] {
                            ASSERT_TRUE(fs::is_empty(folder("one"))) << "the folder shows that it is taken";
                            joining = problem("one");
                        }),
              RunEnd::done);
    EXPECT_THAT(joining, HasSubstr("another program is writing there alone"));
    expect_like_whole("one");
}

TEST_F(RunPartsTest, SingleProcessesAreRefusedWherePartsAreComputed) {
    std::vector<std::string> problems;
    RunParts parts = parts_of("many");
    parts.on_progress = [&](double) {
        if (problems.empty())
            for (const auto start : {Start::fresh, Start::resume})
                problems.push_back(problem_of([&] { run_alone("many", start); }));
    };
    parts.compute(device_, 0);
    EXPECT_THAT(problems, ElementsAre(HasSubstr("other programs share work there"),
                                      HasSubstr("other programs share work there")));
}

TEST_F(RunPartsTest, AreNotResumedByASingleProcess) {
    compute("parts", {0});
    EXPECT_THAT(problem_of([&] { run_alone("parts", Start::resume); }), HasSubstr("holds parts of a run"));
    finish("parts");
    expect_like_whole("parts");
}

/// As on a network disk without locks between machines.
TEST_F(RunPartsTest, WithoutLocksNeitherOfTwoRunsIsOverwritten) {
    const auto mine = scene_;
    compute("both", {0, 1, 2, 3, 4, 5});
    set_another_scene();
    run_alone("other", Start::fresh);
    fs::copy_file(folder("other") / "run.h5", folder("both") / "run.h5");
    scene_ = mine;
    EXPECT_THAT(problem("both"), HasSubstr("the run.h5 of another run beside the parts"));
    EXPECT_TRUE(fs::exists(file("both", "00005.h5")));
    EXPECT_THROW(run_alone("late", Start::fresh, [&] { fs::create_directory(parts_folder(folder("late"))); }),
                 RunError);
    EXPECT_TRUE(fs::exists(folder("late") / "segment-000000.h5"));
    EXPECT_FALSE(fs::exists(folder("late") / "run.h5"));
}

}  // namespace
}  // namespace mcdem
