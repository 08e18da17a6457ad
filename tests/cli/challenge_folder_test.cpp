// One folder, one work: who comes where a challenge is answered, or to answer one where a run is, is refused.
#include <csignal>
#include <memory>
#include <thread>

#include "cli/tiny_challenge.h"
#include "io/parts.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const char* const alone = "another program is writing there: wait for it";
const char* const not_shared = "another program is writing there alone, which cannot be shared";
const char* const shared = "other programs share work there: wait for them, join them with --worker";

class ChallengeFolderTest : public CliTest {
protected:
    void SetUp() override {
        write_tiny_scene(folder_.path);
        expect_done(mcdem({"challenge", "make", "tiny.toml", "--out", "challenge", "--effects",
                           "friction,force_bias", "--none", "1", "--pairs", "0", "--per-effect", "0",
                           "--unknown", "0", "--outside", "0", "--packings", "2"}));
    }
    static Words challenge_words(const Words& more = {}) {
        Words words = run_challenge_words;
        *(std::ranges::find(words, "--out") + 1) = "out";
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    /// A challenge stopped in the middle: it holds its folder until it is let go on.
    std::unique_ptr<Child> stopped_challenge(const Words& more = {}) const {
        auto child = std::make_unique<Child>(folder_.path, challenge_words(more));
        while (child->is_running() && !fs::exists(path("out/findings")))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        child->send(SIGSTOP);
        return child;
    }
    void expect_refused(const Words& words, const std::string& problem) const {
        expect_bad_input(mcdem(words), problem);
    }
};

TEST_F(ChallengeFolderTest, WhereOneProgramAnswersAChallenge) {
    const auto one = stopped_challenge();
    expect_refused(challenge_words(), alone);
    expect_refused(run_words("out"), alone);
    for (const char* how : {"--worker", "--device=all"}) {
        expect_refused(challenge_words({how}), not_shared);
        expect_refused(run_words("out", {how}), not_shared);
    }
    one->send(SIGCONT);
    expect_done(one->wait());
    for (const Words& more : {Words{}, {"--resume"}, {"--worker"}, {"--device=all"}})
        expect_refused(run_words("out", more), "holds the answers to a challenge");
    EXPECT_TRUE(file_of_a_run(path("out")).empty());
}

TEST_F(ChallengeFolderTest, WhereProgramsShareAChallenge) {
    const auto one = stopped_challenge({"--worker"});
    expect_refused(challenge_words(), shared);
    expect_refused(run_words("out"), shared);
    expect_refused(run_words("out", {"--worker"}), "holds the answers to a challenge");
    one->send(SIGCONT);
    expect_done(one->wait());
    EXPECT_TRUE(fs::exists(path("out/case_0001.json")));
    EXPECT_TRUE(file_of_a_run(path("out")).empty());
}

TEST_F(ChallengeFolderTest, WhereARunIsWritten) {
    {
        const auto run = ResultFolder::create(path("out"));  // as of a run before its first checkpoint
        expect_refused(challenge_words(), alone);
        for (const char* how : {"--worker", "--device=all"})
            expect_refused(challenge_words({how}), not_shared);
    }
    {
        const FolderLock worker(path("out"), FolderLock::Use::shared);
        fs::create_directory(parts_folder(path("out")));
        expect_refused(challenge_words(), shared);
        for (const char* how : {"--worker", "--device=all"})
            expect_refused(challenge_words({how}), "holds a run (parts)");
    }
    expect_refused(challenge_words(), "holds a run (parts)");
    EXPECT_FALSE(fs::exists(path("out/evidence")));
}

}  // namespace
}  // namespace mcdem
