#include "cli/shell/progress.h"

#include <gmock/gmock.h>

#include <cstdlib>

namespace mcdem {
namespace {

using std::chrono::milliseconds;

/// A progress display with an artificial clock.
class ProgressTest : public testing::Test {
protected:
    explicit ProgressTest() : out_(open_memstream(&text_, &size_)) {}
    ~ProgressTest() override {
        std::fclose(out_);
        std::free(text_);
    }
    Progress make(ProgressStyle style) {
        return Progress(out_, style, [this] { return now_; });
    }
    std::string text() {
        std::fflush(out_);
        return {text_, size_};
    }
    Progress::Clock::time_point now_{};
    char* text_ = nullptr;
    std::size_t size_ = 0;
    std::FILE* out_;
};

TEST_F(ProgressTest, LinesAppearEveryTenthOrTenSeconds) {
    Progress progress = make(ProgressStyle::lines);
    for (int i = 0; i < 1000; ++i) {  // 20 s, evenly
        progress.show(i / 1000.0 + 1e-9);
        now_ += milliseconds(20);
    }
    EXPECT_THAT(text(), testing::StartsWith("mcdem: 10 % done, 18 s left\nmcdem: 20 % done, 16 s left\n"));
    EXPECT_EQ(std::count(text_, text_ + size_, '\n'), 9);  // the tenth would coincide with the end
}

TEST_F(ProgressTest, SlowWorkIsReportedAndFastWorkIsNotVerbose) {
    Progress slow = make(ProgressStyle::lines);
    for (int i = 0; i <= 30; ++i) {
        slow.show(i / 1000.0);
        now_ += milliseconds(1000);
    }
    EXPECT_THAT(text(), testing::StartsWith("mcdem: 1 % done, 16 min 30 s left\n"));
    EXPECT_EQ(std::count(text_, text_ + size_, '\n'), 3);
    Progress fast = make(ProgressStyle::lines);
    for (int i = 0; i <= 100; ++i) fast.show(i / 100.0);
    EXPECT_EQ(std::count(text_, text_ + size_, '\n'), 3);
}

TEST_F(ProgressTest, TimeLeftOfAResumedRunCountsFromItsStart) {
    Progress progress = make(ProgressStyle::lines);
    progress.show(0.5);
    now_ += milliseconds(10'000);
    progress.show(0.6);
    EXPECT_EQ(text(), "mcdem: 60 % done, 40 s left\n");
}

TEST_F(ProgressTest, TimeLeftOfALongRunIsToldAfterTwentySeconds) {
    Progress progress = make(ProgressStyle::lines);
    progress.show(0);
    now_ += milliseconds(15'000);
    progress.show(0.0015);
    now_ += milliseconds(15'000);
    progress.show(0.003);
    EXPECT_EQ(text(), "mcdem: 0 % done\nmcdem: 0 % done, 2 h 46 min left\n");
}

TEST_F(ProgressTest, BarIsRedrawnAndRemoved) {
    {
        Progress progress = make(ProgressStyle::bar);
        progress.show(0);
        progress.show(0.001);  // too soon
        now_ += milliseconds(2000);
        progress.show(0.5);
    }
    EXPECT_THAT(text(), testing::MatchesRegex(
                            "\r\\[-+\\]   0 %\x1b\\[K\r\\[#+-+\\]  50 %, 2 s left\x1b\\[K\r\x1b\\[K"));
}

TEST(DurationText, ShowsAtMostTwoUnits) {
    EXPECT_EQ(duration_text(0.4), "0 s");
    EXPECT_EQ(duration_text(59.4), "59 s");
    EXPECT_EQ(duration_text(60), "1 min 00 s");
    EXPECT_EQ(duration_text(3725), "1 h 02 min");
}

}  // namespace
}  // namespace mcdem
