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

TEST_F(KernelsFolderTest, MissingFolderIsBadInput) {
    expect_bad_input(run_with_kernels("out", "nowhere"), "got 'nowhere', where mcdem.cl cannot be read");
    fs::create_directory(path("kernels"));
    fs::copy(sources_ / "mcdem.cl", path("kernels"));
    expect_bad_input(run_with_kernels("out", "kernels"), "give `kernels` of the sources");
}

}  // namespace
}  // namespace mcdem
