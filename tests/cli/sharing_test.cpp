// Work in parts: messages, and names that must not be executed by a shell.
#include "cli/parts/sharing.h"

#include <csignal>
#include <memory>

#include "cli/cli_test.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/shell_words.h"
#include "core/errors.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const std::vector<std::string> odd_words{"plain", "",          "with blank", "it's",       "$(touch hacked)",
                                         "`a`",   "new\nline", "\\",         "\"double\"", "*?[a]",
                                         "~",     "-e",        "a;b&c|d",    "#SBATCH",    "\xc3\xa4"};

TEST(ShellWords, AreQuotedForAShell) {
    for (const auto& word : odd_words) {
        // The trailing character protects newlines, which the shell would remove at the end.
        EXPECT_EQ(output_of_shell("printf '%s|' " + shell_word(word)).out, word + "|");
    }
}

/// Work whose merge is interrupted.
class InterruptedMerge : public PartedWork {
public:
    std::size_t count() override { return 1; }
    std::vector<std::size_t> missing() override { return {}; }
    void compute(Device&, std::size_t) override {}
    bool merge() override {
        std::raise(SIGTERM);
        if (Interrupt::wanted()) throw Interrupted();
        return true;
    }
};

TEST(Sharing, AMergeEndsAtASignalAsOtherWorkDoes) {
    SharedWork work;
    work.out = "out";
    work.begin = [](std::size_t) { return std::make_unique<InterruptedMerge>(); };
    work.report = [] { return exit_done; };
    SharingOptions merge;
    merge.merge = true;
    EXPECT_EQ(share(work, merge, ""), exit_interrupted);
    EXPECT_EQ(share(work, {}, ""), exit_interrupted);
}

class SharingTest : public CliTest {
protected:
    /// A part of a run that is blocked in the middle and holds its folder until released.
    std::unique_ptr<Child> held_part(const std::string& out) const {
        auto part = std::make_unique<Child>(folder_.path, run_words(out, {"--part", "1/8"}), held_after(100));
        wait_until_held(*part);
        return part;
    }
};

TEST_F(SharingTest, WrongOptionsAreRefused) {
    const std::string run = "run small.toml --no-figures --out out ";
    for (const std::string share : {"3", "0/8", "9/8", "1/", "/8", "1/8x", "-1/8", "1/99999999999999999999"})
        expect_refused(run + "--part=" + share,
                       "must be I/N, the I-th of N shares of the parts, as in 3/8; got '" + share);
    const std::vector<std::pair<std::string, std::string>> cases{{"--part 1/2 --merge", "--merge"},
                                                                 {"--missing --merge", "--merge"},
                                                                 {"--mpi", "--part I/N"},
                                                                 {"--slurm", "--part I/N"},
                                                                 {"--device all", "mcdem distribute run"}};
    for (const auto& [options, problem] : cases) expect_refused(run + options, problem);
    EXPECT_FALSE(fs::exists(path("out")));
}

/// As one script of a job array would do it.
TEST_F(SharingTest, SharesAndAMergeGiveTheWholeResult) {
    expect_done(mcdem(run_words("alone")));
    const auto missing = mcdem(run_words("shared", {"--part-replicas", "1", "--missing"}));
    expect_done(missing);
    ASSERT_THAT(missing.out, testing::MatchesRegex("1/([0-9]+)\n2/[^ ]*"));
    const auto second = mcdem(run_words("shared", {"--part", "2/2"}));
    expect_done(second);
    EXPECT_EQ(second.out, "");
    EXPECT_THAT(second.err, HasSubstr("share 2/2 is done; "));
    EXPECT_THAT(mcdem(run_words("shared", {"--missing"})).out, testing::Not(HasSubstr("2/")));
    const auto early = mcdem(run_words("shared", {"--merge"}));
    EXPECT_EQ(early.exit_code, 1);
    EXPECT_THAT(early.err, HasSubstr(" missing; the command without --merge computes "));
    const auto first = mcdem(run_words("shared", {"--part", "1/2"}));
    expect_done(first);
    EXPECT_THAT(first.err, testing::Not(HasSubstr("missing")));
    EXPECT_EQ(mcdem(run_words("shared", {"--missing"})).out, "");
    const auto merged = mcdem(run_words("shared", {"--merge"}));
    expect_done(merged);
    EXPECT_THAT(merged.out, HasSubstr("replicas done"));
    for (const char* file : {"run.h5", "plate.csv"})
        EXPECT_TRUE(bytes_of_file(path("shared") / file) == bytes_of_file(path("alone") / file)) << file;
    expect_done(mcdem(run_words("one_by_one", {"--part-replicas", "1"})));
    EXPECT_TRUE(bytes_of_file(path("one_by_one/run.h5")) == bytes_of_file(path("alone/run.h5")));
}

TEST_F(SharingTest, ARunOfAnotherProgramIsRefused) {
    expect_done(mcdem(run_words("out")));
    const auto finished = mcdem(run_words("out", {"--part", "1/1", "--set", "protocol.scans_per_stroke=2"}));
    expect_bad_input(finished, "must be resumed with the scene it was begun with");
    EXPECT_THAT(finished.err, testing::ContainsRegex("; protocol\\.scans_per_stroke is 2, was [0-9]+: give"));
}

TEST_F(SharingTest, ASingleProcessIsRefusedWhileAPartIsComputed) {
    expect_done(mcdem(run_words("alone")));
    const auto part = held_part("shared");
    expect_bad_input(mcdem(run_words("shared", {"--set", "grains.friction=0.3"})),
                     "other programs share work there: wait for them");
    let_go_on(*part);
    expect_done(part->wait());
    expect_done(mcdem(run_words("shared", {"--resume"})));
    EXPECT_TRUE(bytes_of_file(path("shared/run.h5")) == bytes_of_file(path("alone/run.h5")));
}

TEST_F(SharingTest, PartsAreRefusedWhileASingleProcessWrites) {
    const auto one = ResultFolder::create(path("out"));  // as for a run before its first checkpoint
    for (const char* how : {"--part=1/2", "--part-replicas=1", "--missing", "--merge"})
        expect_bad_input(mcdem(run_words("out", {how})), "another program is writing there alone");
    EXPECT_FALSE(fs::exists(path("out/parts")));
}

}  // namespace
}  // namespace mcdem
