// A shared run: the bytes of one program's, whoever computed its parts, and whatever happened to them.
#include "ensemble/share_run.h"

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
    fs::path folder(const std::string& name) const { return temporary_.path / name; }
    void expect_like_whole(const std::string& name) const {
        for (const char* file : {"run.h5", "plate.csv"})
            EXPECT_TRUE(bytes_of_file(folder(name) / file) == bytes_of_file(folder("whole") / file)) << file;
        EXPECT_EQ(std::distance(fs::directory_iterator(folder(name)), {}), 2) << "something is left over";
    }
    std::string problem(const std::string& name) {
        try {
            share(name);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
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
    // Its bytes are now another run's: seen in the result only where it is not computed again.
    const auto first = parts_folder(folder("two")) / "00000.h5";
    const auto second = parts_folder(folder("two")) / "00001.h5";
    fs::copy_file(second, first, fs::copy_options::overwrite_existing);
    share("two");
    EXPECT_FALSE(bytes_of_file(folder("two") / "run.h5") == bytes_of_file(folder("whole") / "run.h5"));
}

TEST_F(ShareRunTest, ADamagedPartIsComputedAgain) {
    share_until("damaged", "00001.h5");
    const auto part = parts_folder(folder("damaged")) / "00000.h5";
    fs::resize_file(part, fs::file_size(part) / 2);
    EXPECT_EQ(share("damaged"), RunEnd::done);
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("part 00000 is computed again")));
    expect_like_whole("damaged");
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

}  // namespace
}  // namespace mcdem
