// Diagnoses of simulated experiments, with a scene of 64 grains.
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/tiny_challenge.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class DiagnoseTest : public CliTest {
protected:
    void SetUp() override {
        NEEDS_PYTHON_MODULE();
        write_tiny_scene(folder_.path);
    }

    /// An experiment with another packing, and the scene with these changes.
    void experiment(const Words& changes, const std::string& folder = "e", int seed = 5) {
        Words run{"run",
                  "tiny.toml",
                  "--out",
                  "run-" + folder,
                  "--no-figures",
                  "--set",
                  "protocol.scan_at_start=true",
                  "--set",
                  "packing.seed=" + std::to_string(seed)};
        for (const std::string& change : changes) run.insert(run.end(), {"--set", change});
        expect_done(mcdem(run));
        expect_done(mcdem({"experiment", "from-run", "run-" + folder, "--out", folder}));
    }

    nlohmann::json diagnosis(const Words& more, const Words& experiments = {"e"}) {
        Words words{"diagnose", "tiny.toml", "--out", "d"};
        for (const std::string& folder : experiments) words.insert(words.end(), {"--experiment", folder});
        words.insert(words.end(), more.begin(), more.end());
        expect_done(mcdem(words));
        return nlohmann::json::parse(std::ifstream(path("d/diagnosis.json")));
    }
};

const Words few{
    "--replicates",    "16", "--pairs",      "4",
    "--confirmations", "4",  "--candidates", "friction,wall_friction,rolling_resistance,plate_speed"};

// A real plate ten times slower than the scene's is not an effect: the scene's plate is too fast.
TEST_F(DiagnoseTest, ASlowExperimentWithoutEffectGetsNoEffect) {
    experiment({"plate.speed=0.02"});
    Words never = few, refined = few;
    never.insert(never.end(), {"--refine", "1"});
    refined.insert(refined.end(), {"--refine", "8"});
    const auto fast = diagnosis(never);
    EXPECT_EQ(fast["verdict"], "not_converged") << fast["sentence"];
    ASSERT_EQ(fast["refinements"].size(), 1u);
    EXPECT_EQ(fast["refinements"][0]["key"], "plate.speed");
    EXPECT_EQ(fast["refinements"][0]["done"], false);
    EXPECT_LE(fast["refinements"][0]["to"], 0.1);
    EXPECT_THAT(std::string(fast["next"][0]["what"]), HasSubstr("set plate.speed = "));
    const auto slow = diagnosis(refined);
    EXPECT_EQ(slow["verdict"], "no_gap") << slow["sentence"];
    ASSERT_EQ(slow["refinements"].size(), 1u);
    EXPECT_EQ(slow["refinements"][0]["done"], true);
    EXPECT_THAT(std::string(slow["sentence"]), HasSubstr("with plate.speed = "));
}

// With a rate tolerance the scene's plate is slow enough and need not be refined.
TEST_F(DiagnoseTest, WithAToleranceASlowExperimentAgreesWithTheScene) {
    const Words scene{"protocol.rate_tolerance=0.01"};
    experiment({"plate.speed=0.01"});
    Words words = few;
    for (const std::string& change : scene) words.insert(words.end(), {"--set", change});
    const auto told = diagnosis(words);
    EXPECT_EQ(told["verdict"], "no_gap") << told["sentence"];
    EXPECT_TRUE(told["refinements"].empty());
    EXPECT_THAT(told["not_testable"].dump(), HasSubstr("plate_speed: protocol.rate_tolerance keeps"));
}

TEST_F(DiagnoseTest, SeveralPackingsGetOneVerdict) {
    const Words packings{"a", "b"};
    for (int p = 0; p < 2; ++p) experiment({}, packings[static_cast<std::size_t>(p)], 5 + p);
    const auto none = diagnosis(few, packings);
    EXPECT_EQ(none["verdict"], "no_gap") << none["sentence"];
    ASSERT_EQ(none["packings"].size(), 2u);
    EXPECT_EQ(none["packings"][1]["experiment"], "b");
    EXPECT_EQ(none["provenance"]["experiment"], "a, b");
    for (int p = 0; p < 2; ++p)
        experiment({"grains.friction=0.15"}, "rough-" + packings[static_cast<std::size_t>(p)], 5 + p);
    const auto rough = diagnosis(few, {"rough-a", "rough-b"});
    EXPECT_EQ(rough["verdict"], "effect") << rough["sentence"];
    EXPECT_EQ(rough["causes"][0]["effect"], "friction");
    EXPECT_NEAR(rough["causes"][0]["amplitude"].get<double>(), 0.12,
                4 * rough["causes"][0]["amplitude_error"].get<double>());
    for (const auto& packing : rough["packings"]) EXPECT_EQ(packing["differs"], false) << packing;
    const auto mixed = diagnosis(few, {"a", "rough-b"});
    for (const auto& packing : mixed["packings"]) EXPECT_EQ(packing["differs"], true) << packing;
    Words twice{"diagnose", "tiny.toml", "--out", "d", "--experiment", "a", "--experiment", "a"};
    expect_bad_input(mcdem(twice), "--experiment: a is given twice");
}

// A cylinder and a periodic container, each without and with an effect.
class DiagnoseContainerTest : public DiagnoseTest, public testing::WithParamInterface<const char*> {};

TEST_P(DiagnoseContainerTest, NamesOnlyThePlantedEffect) {
    std::stringstream scene;
    scene << std::ifstream(path("tiny.toml")).rdbuf();
    const std::string box = "[box]\nsize_x = 0.083\nsize_y = 0.083\n";
    std::string text = scene.str();
    ASSERT_NE(text.find(box), std::string::npos);
    std::ofstream(path("tiny.toml")) << text.replace(text.find(box), box.size(), GetParam());
    experiment({});
    const std::string check = mcdem({"experiment", "check", "e"}).out;
    EXPECT_THAT(check, HasSubstr("in addition: nothing"));
    EXPECT_THAT(check, HasSubstr("suspicious data: nothing"));
    const Words words{"--replicates",    "16", "--pairs",      "4",
                      "--confirmations", "4",  "--candidates", "friction,viscoelasticity,force_bias"};
    EXPECT_EQ(diagnosis(words)["verdict"], "no_gap");
    experiment({"grains.friction=0.2"}, "f");
    const auto told = diagnosis(words, {"f"});
    EXPECT_EQ(told["verdict"], "effect") << told["sentence"];
    EXPECT_EQ(told["causes"][0]["effect"], "friction");
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, DiagnoseContainerTest,
    testing::Values("[container]\nshape = \"cylinder\"\nradius = 0.047\n",
                    "[container]\nshape = \"periodic\"\nsize_x = 0.08\nsize_y = 0.085\n"));

// Plate and positions without contacts.
TEST_F(DiagnoseTest, PlateAndPositionsAreSufficient) {
    experiment({});
    std::filesystem::remove(path("e/contacts.csv"));
    EXPECT_THAT(mcdem({"experiment", "check", "e"}).out, HasSubstr("in addition: nothing"));
    const auto told = diagnosis(few);
    EXPECT_EQ(told["verdict"], "no_gap") << told["sentence"];
    EXPECT_THAT(told["not_measured"].dump(), HasSubstr("contacts.csv"));
    for (const auto& cell : told["cells"]) EXPECT_EQ(cell["observable"], "top_force");
}

// Without any of the surface displacements free surfaces move too far, and the runs stop. The smallest
// accepted numbers of runs are sufficient, and give no false gap.
TEST_F(DiagnoseTest, ACandidateWhoseRunsFailAffectsOnlyItself) {
    const Words scene{"contact.model=mc_dem", "contact.gamma=1.08"};
    experiment(scene);
    Words words{"--replicates",    "8", "--pairs",      "2",
                "--confirmations", "0", "--candidates", "friction,bulge_contacts"};
    for (const std::string& change : scene) words.insert(words.end(), {"--set", change});
    const auto told = diagnosis(words);
    EXPECT_EQ(told["verdict"], "no_gap") << told["sentence"];
    EXPECT_GT(told["cells"].size(), 100u);
}

// Interrupted after the library was moved into place, before its temporary name was removed.
TEST_F(DiagnoseTest, RemnantsOfAnInterruptedLibraryAreRemovedByTheNext) {
    experiment({});
    const Words options{"--replicates",    "8", "--pairs",      "2",       "--library", "library.json",
                        "--confirmations", "0", "--candidates", "friction"};
    const auto first = diagnosis(options);
    const auto left = path("library.json.0123456789abcdef.tmp");
    std::filesystem::create_hard_link(path("library.json"), left);
    EXPECT_EQ(diagnosis(options)["verdict"], first["verdict"]);
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_TRUE(std::filesystem::exists(path("library.json")));
}

TEST_F(DiagnoseTest, TwoAtOnceWithANewLibraryBothGiveAVerdict) {
    experiment({});
    const auto words = [](const std::string& out) {
        return Words{"diagnose",        "tiny.toml", "--experiment", "e",       "--out",   out,
                     "--library",       "l",         "--replicates", "8",       "--pairs", "2",
                     "--confirmations", "0",         "--candidates", "friction"};
    };
    Child first(folder_.path, words("first"), held_after(100));
    wait_until_held(first);
    expect_done(mcdem(words("second")));
    const std::string written = bytes_of_file(path("l"));
    let_go_on(first);
    const Finished finished = first.wait();
    expect_done(finished);
    EXPECT_THAT(finished.err, HasSubstr("l: another process wrote this library first; it is kept"));
    EXPECT_TRUE(fs::exists(path("first/diagnosis.json")));
    EXPECT_EQ(bytes_of_file(path("l")), written);
}

TEST_F(DiagnoseTest, WithItsLibraryInPartsIsTheSame) {
    experiment({"grains.friction=0.3"});
    const Words options{"--replicates",    "8", "--pairs",      "2",
                        "--confirmations", "2", "--candidates", "friction"};
    auto alone = diagnosis(options);
    const auto in_parts = [&](const Words& more) {
        Words words{"diagnose", "tiny.toml", "--experiment", "e", "--out", "parts"};
        words.insert(words.end(), options.begin(), options.end());
        words.insert(words.end(), more.begin(), more.end());
        return mcdem(words);
    };
    const auto missing = in_parts({"--missing"});
    expect_done(missing);
    EXPECT_THAT(missing.out, testing::StartsWith("1/"));
    std::istringstream numbers(missing.out);
    for (std::string number; numbers >> number;) expect_done(in_parts({"--part", number}));
    EXPECT_EQ(in_parts({"--missing"}).out, "");
    expect_done(in_parts({"--merge"}));
    auto told = nlohmann::json::parse(std::ifstream(path("parts/diagnosis.json")));
    for (auto* one : {&alone, &told}) one->erase("seconds");
    EXPECT_EQ(told, alone);
    const auto simulations = [&](const char* folder) {
        return std::distance(std::filesystem::directory_iterator(path(folder) / "simulations"), {});
    };
    EXPECT_EQ(simulations("parts"), simulations("d"));
}

/// A scene of scenes/ instead of the tiny one, and three candidates.
class DiagnoseHoldTest : public DiagnoseTest {
protected:
    void take(const char* scene) {
        fs::copy_file(fs::path(MCDEM_SOURCE_DIR) / "scenes" / scene, path("tiny.toml"),
                      fs::copy_options::overwrite_existing);
    }
    nlohmann::json verdict_on(const std::string& folder, const Words& change) {
        experiment(change, folder, 7);
        return diagnosis({"--replicates", "16", "--pairs", "4", "--confirmations", "4", "--candidates",
                          "viscoelasticity,plasticity,friction", "--library", "l.json"},
                         {folder});
    }
};

TEST_F(DiagnoseHoldTest, DistinguishesRelaxationFromPlasticity) {
    take("relaxation.toml");
    EXPECT_EQ(verdict_on("plain", {})["verdict"], "no_gap");
    for (const std::string effect : {"viscoelasticity", "plasticity"}) {
        const auto told = verdict_on(effect, {"effects." + effect + "=0.2"});
        ASSERT_EQ(told["verdict"], "effect") << told["sentence"];
        EXPECT_EQ(told["causes"][0]["effect"], effect);
        EXPECT_EQ(told["causes"][0]["group"].size(), 1u) << told["causes"][0];
    }
}

TEST_F(DiagnoseHoldTest, NamesCreepUnderPrescribedForces) {
    take("creep.toml");
    EXPECT_EQ(verdict_on("plain", {})["verdict"], "no_gap");
    const auto told = verdict_on("creeping", {"effects.viscoelasticity=0.25"});
    ASSERT_EQ(told["verdict"], "effect") << told["sentence"];
    EXPECT_EQ(told["causes"][0]["effect"], "viscoelasticity");
}

TEST_F(DiagnoseTest, ProgrammesOfSceneAndExperimentMustAgree) {
    experiment({});
    fs::copy_file(fs::path(MCDEM_SOURCE_DIR) / "scenes/relaxation.toml", path("tiny.toml"),
                  fs::copy_options::overwrite_existing);
    expect_bad_input(mcdem({"diagnose", "tiny.toml", "--experiment", "e", "--out", "d"}),
                     "experiment.toml must state the [[programme]] of the experiment, and plate.csv");
}

}  // namespace
}  // namespace mcdem
