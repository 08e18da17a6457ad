// A shared run: the bytes of one program's, whoever computed its parts, and whatever happened to them.
#include "ensemble/share_run.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "ensemble/small_scene.h"
#include "io/parts.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ShareRunTest : public testing::Test {
protected:
    ShareRunTest() {
        RunOptions options;
        options.folder = folder("whole");
        options.program = "test";
        run_scene(device_, scene_, options);
    }
    /// `ticks` calls of on_tick, and then it is interrupted; -1: never.
    RunEnd share(const std::string& name, int ticks = -1, std::size_t part_replicas = 1) {
        ShareOptions options;
        options.folder = folder(name);
        options.part_replicas = part_replicas;
        options.program = "test";
        options.on_warning = [this](const std::string& message) { warnings_.push_back(message); };
        options.on_tick = [&] { --ticks; };
        options.stop_wanted = [&] { return ticks == 0; };
        return share_run(device_, scene_, options);
    }
    /// Interrupted when this file is there.
    void share_until(const std::string& name, const fs::path& file) {
        ShareOptions options;
        options.folder = folder(name);
        options.part_replicas = 1;
        options.program = "test";
        options.stop_wanted = [&] { return fs::exists(parts_folder(folder(name)) / file); };
        ASSERT_EQ(share_run(device_, scene_, options), RunEnd::interrupted);
    }
    /// By one program alone; `meanwhile` is called once, at work and before anything is written.
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
        return problem_of([&] { share(name); });
    }

    TestFolder temporary_;
    Device device_;
    Scene scene_ = small_scene({"batch.replicas=3", "protocol.scans_per_stroke=2"});  // 6 replicas
    std::vector<std::string> warnings_;
};

TEST_F(ShareRunTest, GivesTheBytesOfARunByOneProgramWhateverItsParts) {
    for (const std::size_t part : {0, 1, 4, 100}) {
        const auto name = "parts of " + std::to_string(part);
        EXPECT_EQ(share(name, -1, part), RunEnd::done);
        expect_like_whole(name);
    }
    EXPECT_EQ(share("parts of 4"), RunEnd::was_done);
}

TEST_F(ShareRunTest, GoesOnWhereItWasInterrupted) {
    int interruptions = 0;
    for (int ticks = 2; share("often", ticks) == RunEnd::interrupted; ++ticks) {
        ++interruptions;
        EXPECT_TRUE(is_shared_run(folder("often")));
        EXPECT_FALSE(shared_state(folder("often")).done);
    }
    EXPECT_GT(interruptions, 3);
    EXPECT_TRUE(shared_state(folder("often")).done);
    expect_like_whole("often");
}

TEST_F(ShareRunTest, APartThatIsDoneIsNotDoneAgain) {
    share_until("two", "00001.h5");
    EXPECT_EQ(shared_state(folder("two")).parts_done, 2u);
    EXPECT_NEAR(shared_state(folder("two")).fraction, 2 / 6.0, 1e-9);
    const auto first = parts_folder(folder("two")) / "00000.h5";
    const auto written = fs::last_write_time(first);
    share_until("two", "00002.h5");  // parts are taken in order: the first would have been computed before the third
    EXPECT_EQ(fs::last_write_time(first), written);
    share("two");
    expect_like_whole("two");
}

TEST_F(ShareRunTest, ADamagedPartIsComputedAgain) {
    share_until("damaged", "00001.h5");
    const auto part = parts_folder(folder("damaged")) / "00000.h5";
    fs::resize_file(part, fs::file_size(part) / 2);
    EXPECT_EQ(share("damaged"), RunEnd::done);
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("part 00000 is computed again")));
    expect_like_whole("damaged");
}

TEST_F(ShareRunTest, AnAgreementOnNoSizeIsRefused) {
    share_until("none", "00001.h5");
    const auto agreement = parts_folder(folder("none")) / "agreement.json";
    const std::string whole = bytes_of_file(agreement), size = "\"replicas of a part\": \"1\"";
    ASSERT_THAT(whole, testing::HasSubstr(size));
    for (const char* other : {"0", "-1", "", "1e3", "99999999999999999999"}) {
        std::string changed = whole;
        changed.replace(whole.find(size), size.size(), fmt::format("\"replicas of a part\": \"{}\"", other));
        std::ofstream(agreement) << changed;
        EXPECT_THAT(problem("none"), testing::HasSubstr("must be a number of replicas above 0")) << other;
        EXPECT_EQ(shared_state(folder("none")).parts, 0u);
    }
    std::string changed = whole;
    changed.replace(whole.find(size), size.size(), "\"replicas of a part\": [1]");
    std::ofstream(agreement) << changed;
    EXPECT_EQ(share("none"), RunEnd::done);
    expect_like_whole("none");
}

TEST_F(ShareRunTest, AnEmptyAgreementIsMadeAnewFromTheFinishedParts) {
    share_until("cut", "00001.h5");
    const auto agreement = parts_folder(folder("cut")) / "agreement.json";
    std::ofstream(agreement).close();
    Scene other = small_scene({"batch.replicas=3", "protocol.scans_per_stroke=3"});
    std::swap(scene_, other);
    EXPECT_THAT(problem("cut"), testing::HasSubstr("are of another scene, program or device"));
    std::swap(scene_, other);
    EXPECT_EQ(share("cut", -1, 4), RunEnd::done);  // in the parts that were begun, of one replica
    EXPECT_THAT(warnings_,
                testing::Contains(testing::HasSubstr("is damaged, and made anew from what is there")));
    expect_like_whole("cut");
}

TEST_F(ShareRunTest, WhatALostWorkerLeftOfAPartIsTakenOver) {
    share("lost", 3);
    const auto parts = parts_folder(folder("lost"));
    ASSERT_TRUE(fs::exists(parts / "00000.work-000001/checkpoint.h5"));
    // It did not say that it ended.
    const auto claim = parts / "00000.claim-000001";
    auto text = nlohmann::json::parse(bytes_of_file(claim));
    text["state"] = "held";
    text["started"] = 1;
    std::ofstream(claim) << text;
    EXPECT_EQ(share("lost"), RunEnd::done);
    EXPECT_TRUE(warnings_.empty()) << warnings_.front();
    expect_like_whole("lost");
}

TEST_F(ShareRunTest, WhatIsOfNoUseOfAPartIsThrownAway) {
    share("lost", 3);
    for (const char* file : {"checkpoint.h5", "checkpoint.previous.h5", "segment-000000.h5"})
        std::ofstream(parts_folder(folder("lost")) / "00000.work-000001" / file) << "damaged";
    EXPECT_EQ(share("lost"), RunEnd::done);
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("computed anew")));
    expect_like_whole("lost");
}

TEST_F(ShareRunTest, AMergeThatWasCutShortIsEnded) {
    share_until("cut", "00005.h5");
    const auto parts = parts_folder(folder("cut"));
    fs::copy_file(folder("whole") / "run.h5", folder("cut") / "run.h5");
    fs::remove(parts / "00003.h5");  // not looked at any more
    EXPECT_EQ(share("cut"), RunEnd::done);
    expect_like_whole("cut");
}

TEST_F(ShareRunTest, OtherRunsAreRefused) {
    share_until("mine", "00000.h5");
    scene_ = small_scene({"batch.replicas=3", "protocol.scans_per_stroke=3"});
    EXPECT_THAT(problem("mine"), HasSubstr("begun with another scene"));
    EXPECT_THAT(problem("whole"), HasSubstr("the scene it was begun with"));
    std::ofstream(temporary_.path / "file") << "text";
    EXPECT_THAT(problem("file"), HasSubstr("is a file"));
    fs::create_directories(folder("one"));
    std::ofstream(folder("one") / "checkpoint.h5") << "";
    EXPECT_THAT(problem("one"), HasSubstr("--resume"));
}

TEST_F(ShareRunTest, ARunOfOneProgramUnderWayIsNotJoined) {
    const std::string alone = "another program is writing there alone";
    std::string joining, looking;
    EXPECT_EQ(run_alone("one", Start::fresh,
                        [&] {
                            ASSERT_TRUE(fs::is_empty(folder("one"))) << "the folder shows that it is taken";
                            joining = problem("one");
                            looking = problem_of([&] { expect_sharable(folder("one"), scene_); });
                        }),
              RunEnd::done);
    EXPECT_THAT(joining, HasSubstr(alone));
    EXPECT_THAT(looking, HasSubstr(alone));
    expect_like_whole("one");
}

TEST_F(ShareRunTest, WhereProgramsShareARunNoneWritesAlone) {
    std::vector<std::string> problems;
    bool looked = false;
    ShareOptions options;
    options.folder = folder("many");
    options.program = "test";
    options.on_tick = [&] {
        if (std::exchange(looked, true)) return;
        for (const auto start : {Start::fresh, Start::resume})
            problems.push_back(problem_of([&] { run_alone("many", start); }));
        EXPECT_EQ(problem_of([&] { expect_sharable(folder("many"), scene_); }), "none");
    };
    EXPECT_EQ(share_run(device_, scene_, options), RunEnd::done);
    EXPECT_THAT(problems, testing::ElementsAre(HasSubstr("other programs share work there"),
                                               HasSubstr("other programs share work there")));
    expect_like_whole("many");
}

TEST_F(ShareRunTest, PartsLeftByOthersAreNotResumedAlone) {
    share_until("parts", "00000.h5");
    EXPECT_THAT(problem_of([&] { run_alone("parts", Start::resume); }), HasSubstr("holds parts of a run"));
    share("parts");
    expect_like_whole("parts");
}

/// As on a network disk whose locks do not reach from one machine to the other.
TEST_F(ShareRunTest, WithoutLocksTwoRunsAreLeftAsTheyAre) {
    const auto mine = scene_;
    share_until("both", "00005.h5");
    scene_ = small_scene({"batch.replicas=3", "protocol.scans_per_stroke=3"});
    run_alone("other", Start::fresh);
    fs::copy_file(folder("other") / "run.h5", folder("both") / "run.h5");
    scene_ = mine;
    EXPECT_THAT(problem("both"), HasSubstr("the run.h5 of another run beside the parts"));
    EXPECT_TRUE(fs::exists(parts_folder(folder("both")) / "00005.h5"));
    EXPECT_THROW(run_alone("late", Start::fresh, [&] { fs::create_directory(parts_folder(folder("late"))); }),
                 RunError);
    EXPECT_TRUE(fs::exists(folder("late") / "segment-000000.h5"));
    EXPECT_FALSE(fs::exists(folder("late") / "run.h5"));
}

}  // namespace
}  // namespace mcdem
