// `mcdem experiment import`: a run, written in the format of a laboratory and of another program, is
// imported as from-run converts it.
#include <zlib.h>

#include <csignal>
#include <fstream>
#include <regex>

#include "cli/cli_test.h"
#include "experiment/experiment.h"
#include "experiment/lab_tables.h"
#include "io/results.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class ImportCommandTest : public CliTest {
protected:
    /// A run that starts at rest; folder "seen" has its data from a perfect instrument.
    void run() {
        expect_done(
            mcdem(run_words("a", {"--set", "protocol.scan_at_start=true", "--set", "contact.model=mc_dem"})));
        expect_done(mcdem({"experiment", "from-run", "a", "--position-error", "0", "--diameter-error", "0",
                           "--force-error", "0", "--force-threshold", "0", "--out", "seen"}));
        truth_ = read_experiment(path("seen")).recording;
    }
    void write_lab(const test::LabStyle& style) {
        std::ofstream(path("plate.csv")) << test::lab_plate(truth_, style);
        std::ofstream(path("grains.csv")) << test::lab_grains(truth_, style);
        std::ofstream(path("contacts.csv")) << test::lab_contacts(truth_, style);
    }
    Finished import(std::vector<std::string> more) {
        more.insert(more.begin(), {"experiment", "import"});
        return mcdem(more);
    }
    std::vector<std::string> lab_words(const std::string& out) const {
        return {"contacts.csv",
                "plate.csv",
                "grains.csv",
                "--set",
                "box.size=[0.06, 0.06]",
                "--set",
                "grains.youngs_modulus=23300",
                "--set",
                "grains.poisson_ratio=0.5",
                "--out",
                out};
    }
    /// Numbers were printed with nine digits.
    void expect_truth(const std::string& folder, bool contacts) {
        const Recording read = read_experiment(path(folder)).recording;
        ASSERT_EQ(read.scans.size(), truth_.scans.size());
        for (std::size_t s = 0; s < truth_.scans.size(); ++s) {
            const Scan &a = read.scans[s], &b = truth_.scans[s];
            EXPECT_EQ(a.phase, b.phase) << s;
            EXPECT_NEAR(a.plate_z, b.plate_z, 1e-10);
            EXPECT_NEAR(a.top_force(), b.top_force(), 1e-8);
            ASSERT_EQ(a.position.size(), b.position.size());
            for (std::size_t i = 0; i < b.position.size(); ++i)
                EXPECT_LT((a.position[i] - b.position[i]).norm(), 1e-9);
            if (!contacts) continue;
            ASSERT_EQ(a.contacts.size(), b.contacts.size());
            for (std::size_t c = 0; c < b.contacts.size(); ++c) {
                EXPECT_EQ(a.contacts[c].partner, b.contacts[c].partner);
                EXPECT_LT((a.contacts[c].force - b.contacts[c].force).norm(), 1e-8);
                EXPECT_LT((a.contacts[c].point - b.contacts[c].point).norm(), 1e-9);
            }
        }
    }
    std::string text_of(const std::string& file) const { return bytes_of_file(path(file)); }
    Recording truth_;
};

TEST_F(ImportCommandTest, TablesOfALaboratoryBecomeTheExperimentOfTheirRun) {
    run();
    write_lab({});
    const auto done = import(lab_words("lab"));
    expect_done(done);
    EXPECT_EQ(done.err, "");
    EXPECT_THAT(done.out, HasSubstr("grains.csv: grains (sure: its columns are named so)\n"));
    EXPECT_THAT(done.out, HasSubstr("  radius        Radius [mm]        sure    its name; neighbours touch"));
    EXPECT_THAT(done.out, HasSubstr("lab: 9 frames, 30 grains in 9 of them, "));
    expect_truth("lab", true);
    EXPECT_EQ(read_experiment(path("lab")).name, "lab");
    const auto checked = mcdem({"experiment", "check", "lab"});
    expect_done(checked);
    EXPECT_THAT(checked.out, HasSubstr("30 grains"));
    EXPECT_FALSE(fs::exists(path("lab.importing")));
    // The stored mapping reads the same tables again, and other tables of the laboratory, also compressed
    // ones.
    const gzFile packed = gzopen(path("plate2.csv.gz").c_str(), "wb");
    gzputs(packed, text_of("plate.csv").c_str());
    gzclose(packed);
    expect_done(import({"plate2.csv.gz", "grains.csv", "contacts.csv", "--mapping", "lab/mapping.toml",
                        "--metadata", "lab/experiment.toml", "--out", "again", "--gzip", "--name", "again"}));
    expect_truth("again", true);
    EXPECT_TRUE(fs::exists(path("again/contacts.csv.gz")));
    EXPECT_THAT(text_of("again/mapping.toml"), HasSubstr("files = [\"plate2.csv.gz\"]"));
}

TEST_F(ImportCommandTest, UncertainGuessesMustBeConfirmedInTheMapping) {
    run();
    write_lab({';', ',', false, 1e3, 1e3});
    const auto refused = import({"contacts.csv", "plate.csv", "grains.csv", "--out", "lab"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.out, HasSubstr("  length_unit   mm                 unclear no name says it"));
    EXPECT_THAT(
        refused.err,
        testing::ContainsRegex(
            "mcdem: lab/mapping.toml:[0-9]+: length_unit must be confirmed, got \"\\?mm\": no name says it"));
    EXPECT_THAT(refused.err, HasSubstr("mcdem: --set: box.size must be the inner width and depth of the box"))
        << "all at once";
    EXPECT_THAT(
        refused.err,
        HasSubstr(
            "correct the entries of lab/mapping.toml that begin with a question mark, remove the marks, and "
            "import again with --mapping"));
    EXPECT_FALSE(fs::exists(path("lab/experiment.toml")));
    EXPECT_FALSE(fs::exists(path("lab/plate.csv")));

    const std::vector<std::string> again{
        "--mapping", "lab/mapping.toml", "--set", "box.size=[0.06, 0.06]", "--out", "lab"};
    const auto unchanged = import(again);
    EXPECT_EQ(unchanged.exit_code, 2);
    EXPECT_THAT(unchanged.err, HasSubstr("put in what is right, without the question mark"));
    expect_bad_input(
        import(lab_words("lab")),
        "lab/mapping.toml: is there already: import with --mapping lab/mapping.toml, or remove it");

    std::string mapping = text_of("lab/mapping.toml");
    mapping = std::regex_replace(mapping, std::regex("(length_unit = )\"\\?[a-z]*\""), "$1\"mm\"");
    mapping = std::regex_replace(mapping, std::regex("(force_unit = )\"\\?[a-zA-Z]*\""), "$1\"mN\"");
    mapping = std::regex_replace(mapping, std::regex("\"\\?"), "\"");
    std::ofstream(path("lab/mapping.toml")) << mapping;
    expect_done(import(again));
    expect_truth("lab", true);
    EXPECT_EQ(text_of("lab/mapping.toml"), mapping);
}

TEST_F(ImportCommandTest, DumpsOfAnotherProgramAreImported) {
    run();
    std::string plate = "step plate_z top_force\n";
    for (const Scan& scan : truth_.scans)
        plate += fmt::format("{} {} {}\n", 100 * scan.frame, scan.plate_z, scan.top_force());
    std::ofstream(path("plate.txt")) << plate;
    std::ofstream(path("grains.dump")) << test::dump_of_grains(truth_);
    std::ofstream(path("pairs.dump")) << test::dump_of_contacts(truth_, false);
    const auto done =
        import({"plate.txt", "grains.dump", "pairs.dump", "--set", "box.size=[0.06, 0.06]", "--set",
                "grains.youngs_modulus=23300", "--set", "grains.poisson_ratio=0.5", "--out", "dumped"});
    expect_done(done);
    expect_truth("dumped", false);
    expect_done(mcdem({"experiment", "check", "dumped"}));
}

TEST_F(ImportCommandTest, ReplacesOnlyItsOwnFiles) {
    run();
    write_lab({});
    fs::create_directories(path("lab.importing/kept"));
    fs::create_directories(path("old"));
    std::ofstream(path("old/contacts.csv.gz")) << "others";
    expect_bad_input(import(lab_words("old")), "--out: old already contains contacts.csv.gz");
    expect_bad_input(import(lab_words("plate.csv/x")), "must be a folder, got a file in its path, plate.csv");
    auto words = lab_words("lab/");
    words.insert(words.end(), {"--set", "name=\"Probe 7\""});
    expect_done(import(words));
    EXPECT_EQ(read_experiment(path("lab")).name, "Probe 7");
    expect_done(import(lab_words("second/")));
    EXPECT_EQ(read_experiment(path("second")).name, "second");
    EXPECT_TRUE(fs::exists(path("lab.importing/kept")));
    for (const auto& entry : fs::directory_iterator(path("")))
        EXPECT_THAT(entry.path().string(), Not(testing::EndsWith(".tmp")));
}

TEST_F(ImportCommandTest, WhatAKilledImportHasLeftIsRemovedByTheNextOne) {
    run();
    write_lab({});
    std::ofstream(path("python")) << "#!/bin/sh\ntouch started\nexec sleep 1000\n";
    fs::permissions(path("python"), fs::perms::owner_all);
    auto words = lab_words("lab");
    words.insert(words.begin(), {"experiment", "import"});
    Child killed(folder_.path, words, {"MCDEM_PYTHON=" + path("python").string()});
    while (!fs::exists(path("started")) && killed.is_running())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    killed.send(SIGKILL);
    ASSERT_EQ(killed.wait().signal, SIGKILL);
    const auto folders = [&] {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(path("")))
            if (entry.is_directory()) names.push_back(entry.path().filename());
        return names;
    };
    EXPECT_THAT(folders(), testing::UnorderedElementsAre("a", "seen", testing::StartsWith("lab.")));
    expect_done(mcdem(words));
    EXPECT_THAT(folders(), testing::UnorderedElementsAre("a", "seen", "lab"));
}

TEST_F(ImportCommandTest, WrongOptionsAreBadInput) {
    std::ofstream(path("odd.csv")) << "a,b\n1,2\n1,2,3\n";
    expect_bad_input(import({"--out", "e"}), "TABLE: must be at least one file, or --mapping must name them");
    expect_bad_input(import({"none", "odd.csv", "--out", "e"}), "none: must be a table, got no such file");
    expect_bad_input(import({"none", "odd.csv", "--out", "e"}),
                     "odd.csv:3: must have 2 columns as the first row, got 3");
    expect_bad_input(import({"--mapping", "none", "--out", "e"}),
                     "none: must be a mapping of at most 1 MB, got no such file");
    expect_bad_input(import({"odd.csv", "--metadata", "none", "--out", "e"}),
                     "none: must be a text of at most 1 MB, got no such file");
    expect_bad_input(import({"odd.csv", "--out", "small.toml"}),
                     "--out: small.toml must be a folder, got a file");
    EXPECT_FALSE(fs::exists(path("e")));
    std::ofstream(path("odd.csv")) << "a,b\n1,2\n";
    const auto wrong = import({"odd.csv", "--set", "box.size=[60.0, 60.0]", "--set", "grains.friktion=1",
                               "--set", "nothing", "--out", "e"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(
        wrong.err,
        HasSubstr(
            "--set: box.size must be > 0 and <= 20 [m], got 60: divide by 1000 if it is in millimetres"));
    EXPECT_THAT(wrong.err, HasSubstr("--set: grains.friktion is not a key of an experiment"));
    EXPECT_THAT(wrong.err, HasSubstr("--set: must be KEY=VALUE"));
    EXPECT_THAT(wrong.err, HasSubstr("role must be confirmed"));
    EXPECT_TRUE(fs::exists(path("e/mapping.toml")));
}

}  // namespace
}  // namespace mcdem
