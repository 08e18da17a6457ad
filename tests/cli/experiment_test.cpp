// Experiments from runs, and `experiment check`.
#include "experiment/experiment.h"

#include <fstream>
#include <functional>
#include <map>
#include <regex>

#include "cli/cli_test.h"
#include "cli/shell/subprocess.h"
#include "io/folder_lock.h"
#include "io/results.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class ExperimentCommandTest : public CliTest {
protected:
    /// A run of both models that starts with a scan of the packing at rest.
    void run(const std::string& out, std::vector<std::string> more = {}) {
        more.insert(more.end(), {"--set", "protocol.scan_at_start=true"});
        expect_done(mcdem(run_words(out, more)));
    }
    Finished from_run(const std::string& out, const std::vector<std::string>& more) {
        std::vector<std::string> words{"experiment", "from-run", "a", "--out", out};
        words.insert(words.end(), more.begin(), more.end());
        return mcdem(words);
    }
    void expect_sums(const std::string& experiment) const {
        const std::string check = " && sha256sum --check --strict --quiet SHA256SUMS";
        EXPECT_EQ(output_of_shell("cd " + shell_word(path(experiment).string()) + check).exit_code, 0);
    }
};

TEST_F(ExperimentCommandTest, ARunBecomesAnExperimentWithoutWarnings) {
    run("a");
    const auto made = from_run("e", {"--replica", "elastic_sphere", "--uncertainty",
                                     "grains.youngs_modulus=500", "--uncertainty", "walls.friction=0.01"});
    expect_done(made);
    EXPECT_EQ(made.err, "");
    EXPECT_THAT(made.out, testing::MatchesRegex("e: 9 frames, 30 grains, [0-9]+ of [0-9]+ contacts seen\n"));
    const Experiment e = read_experiment(path("e"));
    EXPECT_EQ(e.name, "small, elastic_sphere");
    EXPECT_EQ(e.materials.at("grains.youngs_modulus"), 23300);
    const std::map<std::string, double> uncertainty{{"grains.youngs_modulus", 500}, {"walls.friction", 0.01}};
    EXPECT_EQ(e.uncertainty, uncertainty);
    EXPECT_EQ(e.measurement.position_error, 1e-4);
    EXPECT_EQ(e.measurement.diameter_error, 5e-5);
    EXPECT_EQ(e.measurement.force_error, 0.05);
    EXPECT_EQ(e.measurement.force_threshold, 4e-3);
    EXPECT_EQ(e.recording.displacement(e.recording.scans.front()), 0);

    const auto checked = mcdem({"experiment", "check", "e"});
    expect_done(checked);
    EXPECT_THAT(checked.out, testing::StartsWith("small, elastic_sphere\n\navailable data\n"));
    EXPECT_THAT(checked.out, HasSubstr("\n  grains.csv      30 grains of "));
    EXPECT_THAT(checked.out, HasSubstr("\n  experiment.toml [uncertainty] of grains.friction: "));
    EXPECT_THAT(checked.out, HasSubstr("\nsuspicious data: nothing\n"));
    std::istringstream lines(checked.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u);

    expect_done(mcdem({"compare", "a", "--against", "e"}));
}

TEST_F(ExperimentCommandTest, APerfectInstrumentReproducesTheRun) {
    run("a");
    expect_done(from_run("e", {"--replica", "1", "--position-error", "0", "--diameter-error", "0",
                               "--force-error", "0", "--force-threshold", "0", "--strain-offset", "1e-3"}));
    const Recording seen = read_experiment(path("e")).recording, truth = read_run(path("a")).recordings[1];
    EXPECT_EQ(seen.diameter, truth.diameter);
    ASSERT_EQ(seen.scans.size(), truth.scans.size());
    for (std::size_t s = 0; s < truth.scans.size(); ++s) {
        EXPECT_EQ(seen.scans[s].top_force(), truth.scans[s].top_force());
        EXPECT_DOUBLE_EQ(seen.scans[s].plate_z, truth.scans[s].plate_z + 1e-3);
        EXPECT_LT((seen.scans[s].position[7] - truth.scans[s].position[7]).norm(), 1e-15);
        ASSERT_EQ(seen.scans[s].contacts.size(), truth.scans[s].contacts.size());
        for (std::size_t c = 0; c < truth.scans[s].contacts.size(); ++c)
            EXPECT_EQ(seen.scans[s].contacts[c].force, truth.scans[s].contacts[c].force);
    }
}

/// Stages with a hold of the position, and a hold of the force at that moment.
constexpr auto stages = R"(
[[programme]]
strain = 0.1
scans = 3
[[programme]]
stage = "hold"
time = 0.02
scan_at = [0.01, 0.02]
[[programme]]
force = 0.2
scans = 2
[[programme]]
stage = "hold"
keep = "force"
time = 0.02
)";

TEST_F(ExperimentCommandTest, AProgrammeIsKeptFromTheRunThroughAnImport) {
    std::string scene = bytes_of_file(path("small.toml"));
    for (const char* key : {"scans_per_stroke", "cycles"})  // of strokes
        if (const auto at = scene.find(key); at != scene.npos) scene.erase(at, scene.find('\n', at) - at);
    std::ofstream(path("small.toml")) << scene << stages;
    run("a", {"--set", "contact.model=independent", "--set", "plate.end=0.06"});
    expect_done(from_run("e", {}));
    const Recording seen = read_experiment(path("e")).recording, truth = read_run(path("a")).recordings[0];
    ASSERT_EQ(seen.scans.size(), 9u);
    for (std::size_t s = 0; s < seen.scans.size(); ++s) EXPECT_EQ(seen.scans[s].time, truth.scans[s].time);
    EXPECT_THAT(bytes_of_file(path("e/plate.csv")),
                testing::AllOf(HasSubstr("top_force_N,set_force_N,time_s\n0,0,load,"), HasSubstr(",0.2,0.")));
    const auto checked = mcdem({"experiment", "check", "e"});
    EXPECT_THAT(checked.out, HasSubstr("suspicious data: nothing"));
    EXPECT_THAT(checked.out, HasSubstr("a programme of 4 stages in"));
    expect_sums("e");
    expect_done(mcdem({"experiment", "import", "e/contacts.csv", "e/plate.csv", "e/grains.csv", "--metadata",
                       "e/experiment.toml", "--out", "i"}));
    const Recording imported = read_experiment(path("i")).recording;
    EXPECT_EQ(imported.parameters, seen.parameters);
    for (std::size_t s = 0; s < seen.scans.size(); ++s) EXPECT_EQ(imported.scans[s].time, seen.scans[s].time);

    mcdem::Run forged = read_run(path("a"));
    forged.recordings[0].scans[4].time = 0;
    write_run(path("forged.h5"), forged);
    expect_bad_input(mcdem({"experiment", "from-run", "forged.h5", "--out", "f"}),
                     "time_s must rise from row to row, got 0 after");
    EXPECT_FALSE(fs::exists(path("f")));
}

TEST_F(ExperimentCommandTest, EachFrameOfAProgrammeIsAScan) {
    std::string scene = bytes_of_file(path("small.toml"));
    for (const char* key : {"scans_per_stroke", "cycles"})
        if (const auto at = scene.find(key); at != scene.npos) scene.erase(at, scene.find('\n', at) - at);
    std::ofstream(path("small.toml")) << scene << stages;
    expect_done(mcdem(run_words("a", {"--set", "contact.model=independent", "--set", "plate.end=0.06"})));
    expect_bad_input(
        from_run("e", {}),
        "the run must have the 8 scans of its programme and one before them, at rest, got 8: run "
        "it to its end, with protocol.scan_at_start = true");
}

TEST_F(ExperimentCommandTest, SeedDeterminesTheNoise) {
    run("a");
    for (const auto& [out, seed] : {std::pair{"e", "3"}, std::pair{"same", "3"}, std::pair{"other", "4"}})
        expect_done(from_run(out, {"--replica", "0", "--seed", seed}));
    expect_done(from_run("packed", {"--replica", "0", "--seed", "3", "--gzip", "--name", "a secret"}));
    for (const char* table : {"grains.csv", "contacts.csv"}) {
        EXPECT_EQ(bytes_of_file(path("e") / table), bytes_of_file(path("same") / table));
        EXPECT_NE(bytes_of_file(path("e") / table), bytes_of_file(path("other") / table));
        EXPECT_FALSE(fs::exists(path("packed") / table));
    }
    EXPECT_EQ(bytes_of_file(path("e/plate.csv")), bytes_of_file(path("other/plate.csv")));
    const Experiment plain = read_experiment(path("e")), packed = read_experiment(path("packed"));
    EXPECT_EQ(packed.name, "a secret");
    EXPECT_EQ(packed.recording.scans[5].position, plain.recording.scans[5].position);
    EXPECT_EQ(packed.recording.scans[5].mean_force, plain.recording.scans[5].mean_force);
}

TEST_F(ExperimentCommandTest, DataThatARunLacksAreNamed) {
    expect_done(mcdem(run_words("a", {"--set", "contact.model=mc_dem"})));
    const auto loaded = from_run("e", {});
    expect_done(loaded);
    EXPECT_THAT(loaded.err, HasSubstr("frame 0 is 2.5 mm below the plate's start"));
    EXPECT_THAT(mcdem({"experiment", "check", "e"}).out,
                HasSubstr("the packing at rest before the first stroke"));
    fs::remove_all(path("a"));
    run("a", {"--set", "contact.model=mc_dem", "--set", "output.positions=false"});
    const auto bare = from_run("bare", {});
    expect_done(bare);
    EXPECT_THAT(bare.err, HasSubstr("output.positions = true"));
    EXPECT_FALSE(fs::exists(path("bare/grains.csv")));
    EXPECT_FALSE(fs::exists(path("bare/contacts.csv")));
    EXPECT_THAT(mcdem({"experiment", "check", "bare"}).out, HasSubstr("diameters and positions: "));
}

TEST_F(ExperimentCommandTest, WrongOptionsAreBadInput) {
    run("a");
    const auto problem = [&](std::vector<std::string> more, const char* part) {
        expect_bad_input(from_run("e", more), part);
        EXPECT_FALSE(fs::exists(path("e")));
    };
    problem(
        {},
        "--replica: must be a number or label of a's replicas (0: independent, 1: elastic_sphere); got none");
    problem({"--replica", "2"}, "got 2");
    problem({"--replica", "jelly"}, "got jelly");
    problem({"--replica", "0", "--position-error", "0.01"}, "--position-error: must be at most an eighth");
    problem({"--replica", "0", "--diameter-error", "0.01"}, "--diameter-error: must be at most an eighth");
    problem({"--replica", "0", "--force-error", "-0.1"}, "--force-error");
    problem({"--replica", "0", "--force-threshold", "weak"}, "--force-threshold");
    for (const char* word :
         {"youngs_modulus=5", "grains.youngs_modulus", "grains.friction=", "grains.friction=-1"})
        problem({"--replica", "0", "--uncertainty", word}, "must be KEY=SIGMA");
    expect_bad_input(mcdem({"experiment", "from-run", "nowhere", "--out", "e"}), "nowhere");
    expect_bad_input(mcdem({"experiment", "from-run", "small.toml", "--out", "e"}), "small.toml");
    expect_bad_input(mcdem({"experiment"}), "subcommand");
    expect_bad_input(mcdem({"experiment", "invent"}), "invent");
    expect_bad_input(mcdem({"experiment", "check", "nowhere"}), "nowhere: must be an experiment's folder");
    expect_bad_input(mcdem({"experiment", "check", "a"}), "a: is not an experiment");
}

TEST_F(ExperimentCommandTest, MeasuredDataAreNotOverwritten) {
    run("a");
    expect_done(from_run("e", {"--replica", "0"}));
    const auto before = bytes_of_file(path("e/grains.csv"));
    expect_bad_input(from_run("e", {"--replica", "1"}), "--out: e holds another experiment");
    expect_bad_input(from_run("a", {"--replica", "1"}), "--out: a holds another experiment or run");
    expect_bad_input(from_run("small.toml", {"--replica", "1"}),
                     "--out: small.toml must be a folder, got a file");
    EXPECT_EQ(bytes_of_file(path("e/grains.csv")), before);
    const auto unwritable = from_run("/proc/nowhere", {"--replica", "1"});
    EXPECT_EQ(unwritable.exit_code, 1);
    EXPECT_THAT(unwritable.err, HasSubstr("/proc/nowhere: "));
}

TEST_F(ExperimentCommandTest, OtherFilesInTheFolderAreKept) {
    run("a");
    fs::create_directory(path("e"));
    std::ofstream(path("e/notes")) << "mine";
    expect_done(from_run("e", {"--replica", "0"}));
    EXPECT_EQ(bytes_of_file(path("e/notes")), "mine");
    expect_sums("e");
    EXPECT_EQ(std::distance(fs::directory_iterator(path("e")), {}), 6);  // no temporary files
}

TEST_F(ExperimentCommandTest, ErrorsInTablesAreReportedWithTheirLines) {
    run("a");
    expect_done(from_run("e", {"--replica", "0"}));
    std::string text = bytes_of_file(path("e/plate.csv"));
    text.replace(text.find("\n2,0,load"), 9, "\n2,0,lode");
    std::ofstream(path("e/plate.csv")) << text;
    std::ofstream(path("e/contacts.csv"), std::ios::app) << "8,77,floor,0,0,0,0,0,1\n";
    const auto checked = mcdem({"experiment", "check", "e"});
    expect_bad_input(checked, "mcdem: e/plate.csv:4: phase must be one of load, unload, got \"lode\"");
    EXPECT_THAT(checked.err, HasSubstr("grain must be a grain of grains.csv, 0 to 29, got 77"));
}

// Both commands name missing data in the same words, before any simulation.
TEST_F(ExperimentCommandTest, CheckAndDiagnoseReportTheSameMissingData) {
    NEEDS_PYTHON_MODULE();
    run("a");
    expect_done(from_run("e", {"--replica", "0"}));
    EXPECT_THAT(mcdem({"experiment", "check", "e"}).out,
                HasSubstr("required by `mcdem diagnose` in addition: nothing\n"));
    std::string toml = bytes_of_file(path("e/experiment.toml"));
    toml.erase(toml.find("[measurement]"));
    std::ofstream(path("e/experiment.toml")) << toml;
    const std::vector<std::string> diagnose{"diagnose", "small.toml", "--experiment", "e", "--out", "out"};
    const auto told = [&](const std::string& words) {
        const auto checked = mcdem({"experiment", "check", "e"});
        expect_done(checked);
        const std::string needs = checked.out.substr(checked.out.find("required by `mcdem diagnose`"));
        EXPECT_THAT(std::regex_replace(needs, std::regex("\\s+"), " "), HasSubstr(words));
        expect_bad_input(mcdem(diagnose), words);
        EXPECT_FALSE(fs::exists(path("out/simulations")));
    };
    told("a line such as `position_error = 1e-4 # [m]`");
    told("a line such as `force_error = 0.05 # relative`");
    fs::remove(path("e/contacts.csv"));
    fs::remove(path("e/grains.csv"));
    told("grains.csv must have the positions of frame 0");
}

TEST_F(ExperimentCommandTest, IsDiagnosedByOneProcessPerFolder) {
    NEEDS_PYTHON_MODULE();
    run("a");
    expect_done(from_run("e", {"--replica", "1"}));
    fs::create_directory(path("out"));
    const std::vector<std::string> words{"diagnose", "small.toml", "--experiment", "e", "--out", "out"};
    {
        const FolderLock other(path("out"), FolderLock::Use::alone);
        expect_bad_input(mcdem(words), "another program is writing there");
    }
    const FolderLock others(path("out"), FolderLock::Use::shared);
    expect_bad_input(mcdem(words), "other programs share work there");
}

TEST_F(ExperimentCommandTest, ARunWithoutGrainsIsRefused) {
    run("a");
    mcdem::Run bare = read_run(path("a"));
    bare.recordings.resize(1);
    bare.recordings[0].diameter.clear();
    for (Scan& scan : bare.recordings[0].scans) {
        scan.position.clear();
        scan.rotation.clear();
        scan.contacts.clear();
    }
    write_run(path("bare.h5"), bare);
    expect_done(mcdem({"table", "bare.h5"}));
    expect_bad_input(mcdem({"experiment", "from-run", "bare.h5", "--out", "e"}),
                     "bare.h5: holds no grains of this replica");
    EXPECT_FALSE(fs::exists(path("e")));
}

/// Fields of run.h5 that others can change, by name.
const std::map<std::string, std::function<void(Recording&)>>& forgeries() {
    static const std::map<std::string, std::function<void(Recording&)>> all{
        {"grain outside", [](Recording& run) { run.scans[1].position[2].x() = 3; }},
        {"grain under the floor", [](Recording& run) { run.scans[0].position[0].z() = -1; }},
        {"plate under the floor", [](Recording& run) { run.scans[1].plate_z = -0.01; }},
        {"plate far up", [](Recording& run) { run.scans[1].plate_z = 1e9; }},
        {"force beyond all", [](Recording& run) { run.scans[1].wall_force[5].z() = 1e300; }},
        {"cycle falls", [](Recording& run) { run.scans[0].cycle = 7; }},
        {"cycle below zero", [](Recording& run) { run.scans[0].cycle = -7; }},
        {"contact far away", [](Recording& run) { run.scans[3].contacts.at(0).point.x() = 5; }},
        {"contact with itself",
         [](Recording& run) { run.scans[3].contacts.at(0).partner = run.scans[3].contacts.at(0).grain; }},
        {"contact twice",
         [](Recording& run) { run.scans[3].contacts.push_back(Contact(run.scans[3].contacts.at(0))); }},
        {"contact of no size", [](Recording& run) { run.scans[3].contacts.at(0).force *= 1e30; }},
        {"grains of a kilometre", [](Recording& run) { run.diameter[1] = 1e3; }},
        {"box of a kilometre", [](Recording& run) { run.box.size_x = 1e3; }},
        {"no positions in the middle", [](Recording& run) { run.scans[2].position.clear(); }},
        {"modulus below zero", [](Recording& run) { run.parameters["grains.youngs_modulus"] = "-5"; }},
        {"ratio of two", [](Recording& run) { run.parameters["grains.poisson_ratio"] = "2"; }},
        {"plate starts at the floor", [](Recording& run) { run.plate_start = 1e-30; }},
        {"label of many lines", [](Recording& run) { run.label = "a\nb\"\x01\t#"; }},
        {"label that is no text", [](Recording& run) { run.label = "\xff\xfe"; }},
    };
    return all;
}

TEST_F(ExperimentCommandTest, AForgedRunIsReadableOrRefused) {
    run("a", {"--set", "contact.model=independent"});
    int refused = 0;
    for (const auto& [name, forge] : forgeries()) {
        mcdem::Run forged = read_run(path("a"));
        forge(forged.recordings.at(0));
        write_run(path("forged.h5"), forged);
        const auto made = mcdem({"experiment", "from-run", "forged.h5", "--out", "e"});
        if (made.exit_code == 2) {
            ++refused;
            EXPECT_THAT(made.err, HasSubstr("forged.h5")) << name;
            EXPECT_FALSE(fs::exists(path("e"))) << name << made.err;
        } else {
            expect_done(made);
            EXPECT_EQ(mcdem({"experiment", "check", "e"}).exit_code, 0) << name;
        }
        fs::remove_all(path("e"));
    }
    EXPECT_GT(refused, 8);
}

TEST_F(ExperimentCommandTest, ARunWithGrainsOutsideTheBoxIsExplained) {
    run("a", {"--set", "contact.model=independent"});
    mcdem::Run forged = read_run(path("a"));
    forgeries().at("grain outside")(forged.recordings.at(0));
    write_run(path("forged.h5"), forged);
    const auto made = mcdem({"experiment", "from-run", "forged.h5", "--out", "e"});
    expect_bad_input(made, "forged.h5: does not give a valid experiment, so nothing is written");
    EXPECT_THAT(made.err, HasSubstr("e/grains.csv:"));
}

TEST_F(ExperimentCommandTest, ALibraryOfAnotherSceneIsRefused) {
    NEEDS_PYTHON_MODULE();
    run("a");
    expect_done(from_run("e", {"--replica", "elastic_sphere"}));
    const auto diagnose = [&](const std::string& friction) {
        return mcdem({"diagnose",        "small.toml",
                      "--experiment",    "e",
                      "--out",           "d",
                      "--library",       "new/l.json",
                      "--replicates",    "8",
                      "--pairs",         "2",
                      "--confirmations", "0",
                      "--candidates",    "adhesion",
                      "--set",           "contact.model=elastic_sphere",
                      "--set",           "grains.friction=" + friction});
    };
    expect_done(diagnose("0.03"));
    expect_done(diagnose("0.03"));
    expect_bad_input(diagnose("0.9"), "new/l.json: was made with grains.friction = 0.03, needed is 0.9");
    EXPECT_THAT(diagnose("0.9").err, HasSubstr("give another file name for --library"));
}

}  // namespace
}  // namespace mcdem
