// Commands do not overwrite files that mcdem did not write.
#include <sys/stat.h>

#include "cli/cli_test.h"
#include "core/errors.h"
#include "core/output_file.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class OutputTest : public CliTest {
protected:
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories(path(name).parent_path());
        std::ofstream(path(name), std::ios::binary) << text;
    }
    std::string text(const std::string& name) const { return bytes_of_file(path(name)); }
    /// A run that starts at rest, and the experiment that measured it.
    void make_experiment() const {
        expect_done(mcdem(run_words("begun", {"--set", "protocol.scan_at_start=true"})));
        expect_done(
            mcdem({"experiment", "from-run", "begun", "--replica", "elastic_sphere", "--out", "lab"}));
    }
    /// All files below the folder with their contents.
    std::map<std::string, std::string> all(const std::string& folder) const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(path(folder)))
            files[entry.path().string()] = entry.is_regular_file() ? bytes_of_file(entry.path()) : "";
        return files;
    }
};

TEST_F(OutputTest, NothingIsWrittenIntoAnExperimentWhateverItsPath) {
    make_experiment();
    fs::create_directory_symlink("lab", path("link"));
    fs::create_directory(path("begun/sub"));
    const auto before = all("lab");
    std::vector<std::string> commands{"export begun --vtk", "figures begun", "compare begun --against lab"};
    if (MCDEM_TEST_PYTHON)
        commands.insert(commands.end(), {"diagnose small.toml --experiment lab", "converge small.toml",
                                         "calibrate small.toml --experiment begun --setting elastic_sphere"});
    for (const std::string out : {"lab", "./begun/../lab", "link", "lab/"}) {
        for (const std::string how : {"", " --part=1/2", " --merge"})
            expect_refused("run small.toml --no-figures --out " + out + how,
                           "is the folder of an experiment");
        for (const std::string& command : commands)
            expect_refused(command + " --out " + out, "of an experiment");
        expect_refused("experiment from-run begun --replica 0 --out " + out, "holds another");
    }
    EXPECT_TRUE(all("lab") == before);
}

TEST_F(OutputTest, ARunDoesNotReplaceTables) {
    for (const std::string table :
         {"frame,cycle,phase,plate_z_m,top_force_N\n0,0,load,0.1,0\n", "my notes"}) {
        write("tables/plate.csv", table);
        for (const std::vector<std::string>& how : {std::vector<std::string>{}, {"--part=1/2"}, {"--merge"}})
            expect_bad_input(mcdem(run_words("tables", how)),
                             "plate.csv: is not the table of a run; it is not replaced");
        EXPECT_EQ(text("tables/plate.csv"), table);
    }
    expect_done(mcdem(run_words("a")));
    fs::remove(path("a/run.h5"));
    expect_done(mcdem(run_words("a")));
}

TEST_F(OutputTest, AReportReplacesOnlyPages) {
    expect_done(mcdem(run_words("a")));
    const auto run = text("a/run.h5");
    write("own.html", "<!doctype html>\n<html><head><title>mine</title></head></html>\n");
    fs::create_symlink("own.html", path("link.html"));
    fs::create_hard_link(path("a/run.h5"), path("hard.html"));
    for (const std::string out : {"./a/../a/run.h5", "hard.html", "small.toml", "link.html", "a"})
        expect_refused("report a --out " + out, "it is not replaced: give another path (--out)");
    EXPECT_TRUE(text("a/run.h5") == run);
    EXPECT_EQ(text("small.toml"), small_scene_text);
    EXPECT_THAT(text("own.html"), HasSubstr("mine"));
    ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
    expect_refused("report a --out fifo", "fifo: exists and is not a regular file");
    write("empty.html", "");
    for (const std::string out : {"empty.html", "new/page.html", "new/page.html"})
        expect_done("report a --out " + out);
}

TEST_F(OutputTest, OwnFilesAreReplacedAndThoseOfOthersKept) {
    make_experiment();
    for (int k = 0; k < 2; ++k)
        for (const char* words : {"export begun --vtk --xyz", "figures begun",
                                  "compare begun --against begun --setting elastic_sphere"})
            expect_done(std::string(words) + " --out view");
    std::vector<std::pair<std::string, std::string>> cases{{"README.txt", "export begun --vtk"},
                                                           {"top_force.pdf", "figures begun"},
                                                           {"scaling.svg", "figures begun"}};
    if (MCDEM_TEST_PYTHON) {
        for (const char* file : {"convergence.json", "convergence.png"})
            cases.emplace_back(file, "converge small.toml");
        for (const char* file :
             {"diagnosis.json", "diagnosis.html", "figures.json", "which.png", "how_far.pdf"})
            cases.emplace_back(file, "diagnose small.toml --experiment lab");
    }
    for (const auto& [file, words] : cases) {
        write("of_others_" + file + "/" + file, "of mine\n");
        expect_refused(words + " --out of_others_" + file, "it is not replaced");
        EXPECT_EQ(text("of_others_" + file + "/" + file), "of mine\n");
    }
}

TEST_F(OutputTest, AnExportNeedsPositions) {
    expect_done(mcdem(run_words("a", {"--set", "output.positions=false"})));
    expect_refused("export a --vtk --out view", "a: has no positions to export: run with output.positions");
    expect_refused("export a --xyz --scan 100 --out view",
                   "--scan: must be among the scans of a (column frame of plate.csv), got 100");
}

TEST_F(OutputTest, ADanglingLinkIsNotAFolder) {
    fs::create_directory_symlink("nothing", path("link"));
    const auto finished = mcdem(run_words("link"));
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err, HasSubstr("link: must be a folder, is a link to nothing that is there"));
}

}  // namespace
}  // namespace mcdem
