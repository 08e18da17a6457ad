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
    for (const std::string out : {"lab", "./begun/../lab", "link", "lab/"}) {
        for (const std::vector<std::string>& how : {std::vector<std::string>{}, {"--part=1/2"}, {"--merge"}})
            expect_bad_input(mcdem(run_words(out, how)), "is the folder of an experiment");
        if (MCDEM_TEST_PYTHON) {
            expect_bad_input(mcdem({"diagnose", "small.toml", "--experiment", "lab", "--out", out}),
                             "of an experiment");
            expect_bad_input(mcdem({"calibrate", "small.toml", "--experiment", "begun", "--setting",
                                    "elastic_sphere", "--out", out}),
                             "of an experiment");
            expect_bad_input(mcdem({"converge", "small.toml", "--out", out}), "of an experiment");
        }
        expect_bad_input(mcdem({"export", "begun", "--vtk", "--out", out}), "of an experiment");
        expect_bad_input(mcdem({"figures", "begun", "--out", out}), "of an experiment");
        expect_bad_input(mcdem({"compare", "begun", "--against", "lab", "--out", out}), "of an experiment");
        expect_bad_input(mcdem({"experiment", "from-run", "begun", "--replica", "0", "--out", out}),
                         "holds another");
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
    for (const std::string out :
         {"a/run.h5", "./a/../a/run.h5", "hard.html", "small.toml", "own.html", "link.html", "a"})
        expect_bad_input(mcdem({"report", "a", "--out", out}),
                         "it is not replaced: give another path (--out)");
    EXPECT_TRUE(text("a/run.h5") == run);
    EXPECT_EQ(text("small.toml"), small_scene_text);
    EXPECT_THAT(text("own.html"), HasSubstr("mine"));
    ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
    expect_bad_input(mcdem({"report", "a", "--out", "fifo"}), "fifo: exists and is not a regular file");
    write("empty.html", "");
    for (const char* out : {"empty.html", "empty.html", "new/page.html", "new/page.html"})
        expect_done(mcdem({"report", "a", "--out", out}));
}

TEST_F(OutputTest, OwnFilesAreReplaced) {
    expect_done(mcdem(run_words("a")));
    expect_bad_input(mcdem({"export", "a", "--xyz", "--scan", "100", "--out", "none"}),
                     "--scan: must be among the scans of a (column frame of plate.csv), got 100");
    for (int k = 0; k < 2; ++k) {
        expect_done(mcdem({"export", "a", "--vtk", "--xyz", "--out", "view"}));
        expect_done(mcdem({"figures", "a", "--out", "view"}));
        expect_done(
            mcdem({"compare", "a", "--against", "a", "--setting", "elastic_sphere", "--out", "view"}));
    }
}

TEST_F(OutputTest, FilesOfOthersAreKept) {
    expect_done(mcdem(run_words("a")));
    const auto expect_kept = [&](const std::string& file, const std::vector<std::string>& words) {
        write(file, "of mine\n");
        expect_bad_input(mcdem(words), "it is not replaced");
        EXPECT_EQ(text(file), "of mine\n");
    };
    expect_kept("1/README.txt", {"export", "a", "--vtk", "--out", "1"});
    expect_kept("2/replica_00001_elastic_sphere/grains_000003.hdf", {"export", "a", "--vtk", "--out", "2"});
    expect_kept("3/OVITO.txt", {"export", "a", "--xyz", "--out", "3"});
    expect_kept("4/replica_00000_independent.xyz", {"export", "a", "--xyz", "--out", "4"});
    expect_kept("5/replica_00000_independent.contacts.dump", {"export", "a", "--xyz", "--out", "5"});
    expect_kept("6/top_force.pdf", {"figures", "a", "--out", "6"});
    expect_kept("7/scaling.svg", {"figures", "a", "--out", "7"});
    if (!MCDEM_TEST_PYTHON) return;
    expect_kept("8/calibration.json", {"calibrate", "small.toml", "--experiment", "a", "--setting",
                                       "elastic_sphere", "--out", "8"});
    expect_kept("9/convergence.json", {"converge", "small.toml", "--out", "9"});
    expect_kept("10/convergence.png", {"converge", "small.toml", "--out", "10"});
}

TEST_F(OutputTest, ADiagnosisReplacesOnlyItsOwnFiles) {
    NEEDS_PYTHON_MODULE();
    make_experiment();
    const auto expect_kept = [&](const std::string& file) {
        write(file, "of mine\n");
        expect_bad_input(
            mcdem({"diagnose", "small.toml", "--experiment", "lab", "--out", path(file).parent_path()}),
            "it is not replaced");
        EXPECT_EQ(text(file), "of mine\n");
    };
    for (const char* name :
         {"1/diagnosis.json", "2/diagnosis.html", "3/figures.json", "4/which.png", "5/how_far.pdf"})
        expect_kept(name);
}

TEST_F(OutputTest, ADanglingLinkIsNotAFolder) {
    fs::create_directory_symlink("nothing", path("link"));
    const auto finished = mcdem(run_words("link"));
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err, HasSubstr("link: must be a folder, is a link to nothing that is there"));
}

}  // namespace
}  // namespace mcdem
