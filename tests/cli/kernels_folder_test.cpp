// Kernels read from a folder (MCDEM_KERNELS) instead of the embedded copy.
#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class KernelsFolderTest : public CliTest {
protected:
    Finished run_with_kernels(const std::string& out, const fs::path& kernels) const {
        return mcdem(run_words(out), {"MCDEM_KERNELS=" + kernels.string()});
    }
    const fs::path sources_ = fs::path(MCDEM_SOURCE_DIR) / "kernels";
};

TEST_F(KernelsFolderTest, SourcesGiveTheBitsOfTheEmbeddedCopy) {
    expect_done(mcdem(run_words("built_in"), {"MCDEM_KERNELS="}));
    expect_done(run_with_kernels("sources", sources_));
    for (const char* file : {"run.h5", "plate.csv"})
        EXPECT_TRUE(bytes_of_file(path("sources") / file) == bytes_of_file(path("built_in") / file)) << file;
}

TEST_F(KernelsFolderTest, FilesOfTheFolderAreCompiled) {
    fs::copy(sources_, path("kernels"));
    std::ofstream(path("kernels/integrate.h"), std::ios::app) << "\n#error changed here\n";
    const auto finished = run_with_kernels("out", "kernels");
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err,
                testing::AllOf(HasSubstr("the kernels do not compile"), HasSubstr("changed here")));
}

/// As if a driver compiled Hertz's law wrongly.
TEST_F(KernelsFolderTest, WrongKernelsFailTheComparisonWithTheHost) {
    fs::copy(sources_, path("kernels"));
    std::string text = bytes_of_file(sources_ / "contact_forces.h");
    const std::string right = "R(2) / R(3)";
    text.replace(text.find(right), right.size(), "R(2) / R(2.999)");
    std::ofstream(path("kernels/contact_forces.h")) << text;
    const auto run = run_with_kernels("out", "kernels");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, testing::AllOf(HasSubstr("computes wrong forces"), HasSubstr("--device")));
    EXPECT_FALSE(fs::exists(path("out")));
    const auto checked = mcdem({"devices", "--check"}, {"MCDEM_KERNELS=kernels"});
    EXPECT_EQ(checked.exit_code, 1);
    EXPECT_THAT(checked.out, testing::AllOf(HasSubstr(" fail\n"), testing::Not(HasSubstr(" pass\n"))));
}

TEST_F(KernelsFolderTest, MissingFolderIsBadInput) {
    expect_bad_input(run_with_kernels("out", "nowhere"), "got 'nowhere', where mcdem.cl cannot be read");
    fs::create_directory(path("kernels"));
    fs::copy(sources_ / "mcdem.cl", path("kernels"));
    expect_bad_input(run_with_kernels("out", "kernels"), "give `kernels` of the sources");
}

}  // namespace
}  // namespace mcdem
