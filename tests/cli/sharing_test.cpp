// Work in parts: messages, and names that must not be executed by a shell.
#include "cli/parts/sharing.h"

#include <csignal>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "cli/cli_test.h"
#include "cli/parts/slurm.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/subprocess.h"
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
        const auto end = output_of({"bash", "-c", "printf '%s|' " + shell_word(word)});
        ASSERT_TRUE(end);
        EXPECT_EQ(end->out, word + "|");
    }
}

TEST(Subprocess, MissingProgramsAndFailingProgramsAreDistinguished) {
    EXPECT_FALSE(output_of({"no-such-program-anywhere"}));
    EXPECT_EQ(output_of({"false"})->exit_code, 1);
    EXPECT_EQ(output_of({"bash", "-c", "kill -9 $$"})->signal, 9);
}

/// Work whose merge is interrupted.
class InterruptedMerge : public PartedWork {
public:
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
        auto part = std::make_unique<Child>(folder_.path, run_words(out, {"--part", "0"}), held_after(100));
        wait_until_held(*part);
        return part;
    }
};

TEST_F(SharingTest, AJobScriptPassesArgumentsUnchanged) {
    SharingOptions options;
    options.slurm_lines = path("lines");
    std::vector<std::string> words{"printf", "%s|"};
    words.insert(words.end(), odd_words.begin(), odd_words.end());
    const std::vector<std::string> next{"bash", "-c", "printf \"$0|$MCDEM_SLURM_BEFORE\"", "it's next"};
    const SlurmJob job{path("slurm"), words, next, options};
    std::ofstream(path("lines")) << "#SBATCH --account=mine";
    std::ofstream(path("job.sh")) << job_script(job, {3, 5});
    std::string expected;
    for (const auto& word : odd_words) expected += word + "|";
    EXPECT_EQ(output_of({"env", "SLURM_ARRAY_TASK_ID=1", "bash", path("job.sh"), "part"})->out,
              expected + "--part|5|");
    EXPECT_EQ(output_of({"bash", path("job.sh"), "next", "17"})->out, "it's next|17 3 5");
    EXPECT_THAT(job_script(job, {}), HasSubstr("--slurm-lines.\n#SBATCH --account=mine\nparts=()\n"));
}

TEST_F(SharingTest, AnotherJobScriptIsNotOverwritten) {
    fs::create_directories(path("out/slurm"));
    std::ofstream(path("out/slurm/job.sh")) << "#!/bin/bash\nmine\n";
    expect_bad_input(mcdem(run_words("out", {"--slurm"})), "job.sh: is not a job script of mcdem");
    EXPECT_EQ(bytes_of_file(path("out/slurm/job.sh")), "#!/bin/bash\nmine\n");
}

TEST_F(SharingTest, MissingSlurmIsBadInput) {
    const auto finished = mcdem(run_words("out", {"--slurm"}), {"PATH=/nowhere"});
    expect_bad_input(finished, "the program sbatch is not there");
}

TEST_F(SharingTest, NothingIsSubmittedAgainWhileSlurmDoesNotAnswer) {
    fs::create_directories(path("bin"));
    const auto program = [&](const std::string& name, const std::string& script) {
        std::ofstream(path("bin/" + name)) << "#!/bin/sh\n" << script;
        fs::permissions(path("bin/" + name), fs::perms::owner_all);
    };
    program("sbatch", "echo job >> " + path("submitted").string() + "\necho 7\n");
    program("squeue", "exit 1\n");
    const std::string search = "PATH=" + path("bin").string() + ":/usr/bin:/bin";
    expect_done(mcdem(run_words("out", {"--slurm", "--no-wait"}), {search}));
    EXPECT_EQ(bytes_of_file(path("submitted")), "job\njob\n");
    const auto again = mcdem(run_words("out", {"--slurm", "--no-wait"}), {search});
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_THAT(again.err, HasSubstr("squeue does not answer"));
    EXPECT_EQ(bytes_of_file(path("submitted")), "job\njob\n");
    program("sbatch", "echo your job 8 was submitted\n");
    program("squeue", "exit 0\n");
    expect_bad_input(mcdem(run_words("out", {"--slurm", "--no-wait"}), {search}),
                     "sbatch has refused the job");
}

TEST_F(SharingTest, ConflictingOptionsAreRefused) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--mpi", "--slurm"},
                                                  {"--part", "1", "--mpi"},
                                                  {"--missing", "--merge"},
                                                  {"--slurm-tasks", "2"}})
        EXPECT_EQ(mcdem(run_words("out", words)).exit_code, 2) << words.front();
}

TEST_F(SharingTest, PartsComputedOneByOneGiveTheWholeResult) {
    expect_done(mcdem(run_words("alone")));
    const auto missing = mcdem(run_words("shared", {"--part-replicas", "1", "--missing"}));
    expect_done(missing);
    ASSERT_THAT(missing.out, testing::StartsWith("0\n1\n"));
    const auto part = mcdem(run_words("shared", {"--part", "1"}));
    expect_done(part);
    EXPECT_EQ(part.out, "");
    const auto early = mcdem(run_words("shared", {"--merge"}));
    EXPECT_EQ(early.exit_code, 1);
    EXPECT_THAT(early.err, HasSubstr(" missing: 0"));
    for (std::istringstream numbers(mcdem(run_words("shared", {"--missing"})).out); !numbers.eof();)
        if (std::string number; numbers >> number)
            expect_done(mcdem(run_words("shared", {"--part", number})));
    EXPECT_EQ(mcdem(run_words("shared", {"--missing"})).out, "");
    const auto merged = mcdem(run_words("shared", {"--merge"}));
    expect_done(merged);
    EXPECT_THAT(merged.out, HasSubstr("replicas done"));
    for (const char* file : {"run.h5", "plate.csv"})
        EXPECT_TRUE(bytes_of_file(path("shared") / file) == bytes_of_file(path("alone") / file)) << file;
}

TEST_F(SharingTest, ARunOfAnotherProgramIsRefused) {
    expect_done(mcdem(run_words("out")));
    const auto finished =
        mcdem(run_words("out", {"--device", "all", "--set", "protocol.scans_per_stroke=2"}));
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
    for (const char* how : {"--part=0", "--device=all", "--missing", "--merge"})
        expect_bad_input(mcdem(run_words("out", {how})), "another program is writing there alone");
    EXPECT_FALSE(fs::exists(path("out/parts")));
}

}  // namespace
}  // namespace mcdem
