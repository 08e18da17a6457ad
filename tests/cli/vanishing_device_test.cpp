// A device that fails during a run: recorded scans are kept, and the run is resumed on another device or
// later.
#include <sstream>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::Each;
using testing::Gt;
using testing::HasSubstr;
using testing::Lt;
using testing::SizeIs;

/// The last column of `mcdem table` for one phase: the number of scans used.
std::vector<int> levels(const std::string& table, const std::string& phase) {
    std::vector<int> found;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);)
        if (line.find(" " + phase + " ") != std::string::npos)
            found.push_back(std::stoi(line.substr(line.rfind(' '))));
    return found;
}

class VanishingDeviceTest : public CliTest {
protected:
    static std::vector<std::string> words(const std::string& out, bool resume) {
        auto all = run_words(out, {"--set", "output.checkpoint_minutes=1e-6"});
        if (resume) all.push_back("--resume");
        return all;
    }
    Finished run_until_it_vanishes(const std::string& out, long kernels, bool resume) const {
        return mcdem(words(out, resume),
                     {"OPENCL_LAYERS=" MCDEM_DEVICE_LAYER, "MCDEM_TEST_KERNELS=" + std::to_string(kernels)});
    }
};

TEST_F(VanishingDeviceTest, TheRunReportsItKeepsItsScansAndResumes) {
    expect_done(mcdem(words("whole", false)));
    constexpr int most = 50;
    int vanished = 0;
    Finished finished;
    while (vanished < most) {
        finished = run_until_it_vanishes("a", 1500, vanished > 0);  // a third of the run's launches
        if (finished.exit_code == 0) break;
        ++vanished;
        EXPECT_EQ(finished.exit_code, 1) << finished.err;
        EXPECT_THAT(finished.err, HasSubstr("the device or its driver has failed"));
        EXPECT_THAT(finished.err, HasSubstr("--out a --no-figures --resume"));
    }
    expect_done(finished);
    EXPECT_GE(vanished, 2);
    EXPECT_TRUE(bytes_of_file(path("a/run.h5")) == bytes_of_file(path("whole/run.h5")));
}

/// Also those since the last checkpoint.
TEST_F(VanishingDeviceTest, CompletedScansCanBeRead) {
    for (const std::string minutes : {"1e-6", "60"}) {
        const auto run = [&](const std::string& out) {
            return run_words(out + minutes, {"--set", "output.checkpoint_minutes=" + minutes});
        };
        expect_done(mcdem(run("whole")));
        const auto finished =
            mcdem(run("a"), {"OPENCL_LAYERS=" MCDEM_DEVICE_LAYER, "MCDEM_TEST_KERNELS=3000"});
        ASSERT_EQ(finished.exit_code, 1) << finished.err;
        const auto table = line("table a" + minutes);
        expect_done(table);
        // The whole stroke, or less if the disk is so slow that checkpoints are rare.
        EXPECT_THAT(levels(table.out, "load"), testing::AllOf(SizeIs(2), Each(Gt(0)))) << table.out;
        EXPECT_THAT(levels(table.out, "unload"), testing::AllOf(SizeIs(2), Each(Lt(4)))) << table.out;
        auto resume = run("a");
        resume.push_back("--resume");
        expect_done(mcdem(resume));
        EXPECT_TRUE(bytes_of_file(path("a" + minutes) / "run.h5") ==
                    bytes_of_file(path("whole" + minutes) / "run.h5"));
    }
}

TEST_F(VanishingDeviceTest, AtTheStart) {
    const auto finished = run_until_it_vanishes("a", 0, false);
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err, HasSubstr("the device or its driver has failed"));
    expect_done(mcdem(words("a", true)));
}

}  // namespace
}  // namespace mcdem
