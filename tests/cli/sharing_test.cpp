// Work spread over devices, ranks and jobs: what is said of it, and that no name reaches a shell as a
// command.
#include <cstdlib>
#include <memory>

#include "cli/cli_test.h"
#include "cli/shell_word.h"
#include "cli/slurm.h"
#include "cli/subprocess.h"
#include "core/errors.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const std::vector<std::string> odd_words{"plain", "",          "with blank", "it's",       "$(touch hacked)",
                                         "`a`",   "new\nline", "\\",         "\"double\"", "*?[a]",
                                         "~",     "-e",        "a;b&c|d",    "#SBATCH",    "\xc3\xa4"};

TEST(ShellWords, AShellTakesThemAsTheyWere) {
    for (const auto& word : odd_words) {
        // Without a blank behind it, the shell would take away newlines at the end.
        const auto end = output_of({"bash", "-c", "printf '%s|' " + shell_word(word)});
        ASSERT_TRUE(end);
        EXPECT_EQ(end->out, word + "|");
    }
}

TEST(Subprocess, ThatIsNotThereIsToldFromOneThatFails) {
    EXPECT_FALSE(output_of({"no-such-program-anywhere"}));
    EXPECT_EQ(output_of({"false"})->exit_code, 1);
    EXPECT_EQ(output_of({"bash", "-c", "kill -9 $$"})->signal, 9);
}

class SharingTest : public CliTest {
protected:
    /// The run of a worker, held in the middle: it has its folder until it is let go on.
    std::unique_ptr<Child> held_worker(const std::string& out) const {
        auto worker = std::make_unique<Child>(folder_.path, run_words(out, {"--worker"}), held_after(100));
        wait_until_held(*worker);
        return worker;
    }
};

TEST_F(SharingTest, AJobScriptRunsTheWordsAsTheyAre) {
    SlurmJob job;
    job.words = {"printf", "%s|"};
    job.words.insert(job.words.end(), odd_words.begin(), odd_words.end());
    job.lines_file = path("lines");
    std::ofstream(path("lines")) << "#SBATCH --account=mine";
    std::ofstream(path("job.sh")) << job_script(job);
    std::string expected;
    for (const auto& word : odd_words) expected += word + "|";
    EXPECT_EQ(output_of({"bash", path("job.sh")})->out, expected);
    EXPECT_THAT(job_script(job), testing::StartsWith("#!/bin/bash\n#SBATCH --account=mine\nexec printf"));
}

TEST_F(SharingTest, SlurmThatIsNotThereIsBadInput) {
    const auto finished = mcdem(run_words("out", {"--slurm"}), {"PATH=/nowhere"});
    expect_bad_input(finished, "the program sbatch is not there");
}

TEST_F(SharingTest, OptionsThatDoNotGoTogetherAreRefused) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--mpi", "--slurm"}, {"--worker", "--mpi"}, {"--slurm-tasks", "2"}})
        EXPECT_EQ(mcdem(run_words("out", words)).exit_code, 2) << words.front();
}

TEST_F(SharingTest, AWorkerSaysNothingAndLeavesTheWholeResult) {
    expect_done(mcdem(run_words("alone")));
    const auto worker = mcdem(run_words("shared", {"--worker", "--part-replicas", "1"}));
    expect_done(worker);
    EXPECT_EQ(worker.out, "");
    for (const char* file : {"run.h5", "plate.csv"})
        EXPECT_TRUE(bytes_of_file(path("shared") / file) == bytes_of_file(path("alone") / file)) << file;
}

TEST_F(SharingTest, AnotherProgramsRunIsRefused) {
    expect_done(mcdem(run_words("out")));
    const auto finished =
        mcdem(run_words("out", {"--device", "all", "--set", "protocol.scans_per_stroke=2"}));
    expect_bad_input(finished, "must be resumed with the scene it was begun with");
}

TEST_F(SharingTest, WhereAWorkerIsAtWorkNoneWritesAlone) {
    expect_done(mcdem(run_words("alone")));
    const auto worker = held_worker("shared");
    expect_bad_input(mcdem(run_words("shared", {"--set", "grains.friction=0.3"})),
                     "other programs share work there: wait for them, join them with --worker");
    let_go_on(*worker);
    expect_done(worker->wait());
    EXPECT_TRUE(bytes_of_file(path("shared/run.h5")) == bytes_of_file(path("alone/run.h5")));
}

TEST_F(SharingTest, WhereOneProgramWritesNoWorkerJoins) {
    const auto one = ResultFolder::create(path("out"));  // as of a run before its first checkpoint
    for (const char* how : {"--worker", "--device=all"})
        expect_bad_input(mcdem(run_words("out", {how})), "another program is writing there alone");
    EXPECT_FALSE(fs::exists(path("out/parts")));
}

}  // namespace
}  // namespace mcdem
