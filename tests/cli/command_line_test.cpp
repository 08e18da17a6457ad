// Output and exit codes for help, versions and errors of the command line.
#include "cl/kernel_cache.h"
#include "cli/cli_test.h"
#include "cli/shell/command_list.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

TEST_F(CliTest, HelpNamesAllCommandsAndTheFirstOnesHaveExamples) {
    const auto help = mcdem({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    for (const auto& [name, about] : listed_commands())
        EXPECT_THAT(help.out, testing::ContainsRegex("\n  " + name + " +" + about.substr(0, 20)));
    EXPECT_GT(listed_commands().size(), 10u);
    for (const std::string name : {"devices", "validate", "run", "table", "experiment"}) {
        const auto more = mcdem({name, "--help"});
        EXPECT_EQ(more.exit_code, 0);
        EXPECT_THAT(more.out, HasSubstr(name == "devices" ? "--device 0" : "  mcdem " + name + " "));
    }
}

TEST_F(CliTest, VersionIsPrinted) {
    const auto version = mcdem({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, testing::MatchesRegex("mcdem [0-9]+\\.[0-9]+\\.[0-9]+.*\n"));
}

TEST_F(CliTest, WrongCommandLinesAreBadInput) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "A subcommand is required"},
        {"walk", "there is no command walk"},
        {"--walk", "there is no option --walk"},
        {"verify", "verify is no command any more: every command checks"},
        {"manual run", "manual is no command any more"},
        {"run", "SCENE is required"},
        {"run small.toml", "--out is required"},
        {"run small.toml --out a --fast", "--fast"},
        {"run small.toml --out", "--out"},
        {"run --fast", "`mcdem run --help` tells more"},
        {"validate nowhere.toml", "nowhere.toml"},
        {"run nowhere.toml --out a", "nowhere.toml"},
        {"table nowhere", "nowhere"},
        {"table small.toml", "small.toml"}};
    for (const auto& [words, problem] : cases) expect_refused(words, problem);
    expect_bad_input(mcdem({"run", "small.toml", "--out", ""}), "--out: must be a path, got nothing");
}

TEST_F(CliTest, TheProgramNeedsNoPythonOfItsOwn) {
    const std::vector<std::string> without{"MCDEM_PYTHON=/none", "MCDEM_PYTHON_FOLDER=/none"};
    for (const char* words : {"--help", "devices", "validate small.toml", "complete -- run --re"})
        expect_done(mcdem(split(words), without));
    expect_bad_input(mcdem({"walk"}, without), "there is no command walk");
    expect_done(mcdem(run_words("a"), without));
    const auto drawn = mcdem({"run", "small.toml", "--out", "b"}, without);
    expect_done(drawn);
    EXPECT_THAT(drawn.err, HasSubstr("no table and no figures: "));
    EXPECT_THAT(drawn.out, HasSubstr("b/run.h5"));
}

TEST_F(CliTest, AllProblemsOfASceneAreListedOnePerLine) {
    std::ofstream(path("bad.toml")) << "[grains]\nfriction = -1\npoisson_ratio = \"soft\"\ncolour = 3\n";
    const auto validated = mcdem({"validate", "bad.toml"});
    expect_bad_input(validated, "mcdem: bad.toml:2: ");
    EXPECT_THAT(validated.err, HasSubstr("\nmcdem: bad.toml:3: "));
    EXPECT_THAT(validated.err, HasSubstr("\nmcdem: bad.toml:4: "));
    EXPECT_EQ(std::count(validated.err.begin(), validated.err.end(), '\n'), 3);
    const auto run = mcdem({"run", "bad.toml", "--out", "a"});
    EXPECT_EQ(run.err, validated.err);
    EXPECT_FALSE(std::filesystem::exists(path("a")));
    expect_bad_input(mcdem({"validate", "small.toml", "--set", "grains.friction=-1"}),
                     "--set grains.friction");
}

TEST_F(CliTest, ValidateSummarisesTheRun) {
    const auto validated = mcdem({"validate", "small.toml", "--set", "batch.replicas=20"});
    expect_done(validated);
    EXPECT_THAT(validated.out,
                HasSubstr("small.toml: valid scene\n40 replicas of 30 grains, float precision"));
    EXPECT_THAT(validated.out, HasSubstr("\n  independent #1\n"));
    EXPECT_THAT(validated.out, HasSubstr("and 28 more"));
    EXPECT_THAT(validated.out,
                testing::ContainsRegex("the packing is 0.0[0-9]+ m high when generated; the plate "
                                       "starts at 0.[0-9]+ m, and at 0.[0-9]+ m finds "));
    EXPECT_THAT(validated.out, testing::ContainsRegex("about .* grain-steps, .* \\(usual for such a device"));
    const auto measured = mcdem({"validate", "small.toml", "--estimate"});
    expect_done(measured);
    EXPECT_THAT(measured.out, HasSubstr(" million per second (measured now)"));
    const auto slow = mcdem({"validate", "small.toml", "--set", "plate.speed=1e-7"});
    EXPECT_THAT(slow.err, testing::ContainsRegex("the run may take [0-9]+ h"));
}

TEST_F(CliTest, ARunThatExceedsTheDeviceIsRefusedBeforeItStarts) {
    expect_done(mcdem({"validate", "small.toml"}));
    EXPECT_THAT(mcdem({"validate", "small.toml"}).out, HasSubstr(" MB of memory on the device"));
    const std::vector<std::vector<std::string>> too_much{
        {"--set", "packing.count=1000000", "--set", "numerics.slots=64", "--set",
         "packing.diameter_min=1.9e-4", "--set", "packing.diameter_mean=2e-4", "--set",
         "packing.diameter_sd=1e-5", "--set", "packing.diameter_max=2.1e-4", "--set", "plate.end=1e-3"},
        {"--set", "plate.speed=1e-12"},
        {"--set", "plate.start=4", "--set", "packing.diameter_min=1e-3"}};
    const char* reasons[] = {"memory", "steps", "numerics.precision must be double"};
    for (std::size_t i = 0; i < too_much.size(); ++i) {
        std::vector<std::string> validate{"validate", "small.toml"};
        validate.insert(validate.end(), too_much[i].begin(), too_much[i].end());
        const auto validated = mcdem(validate, {"POCL_MEMORY_LIMIT=4"});
        expect_bad_input(validated, reasons[i]);
        const auto run = mcdem(run_words("a", too_much[i]), {"POCL_MEMORY_LIMIT=4"});
        EXPECT_EQ(run.exit_code, 2);
        EXPECT_THAT(run.err, HasSubstr(validated.err));
        EXPECT_FALSE(std::filesystem::exists(path("a")));
    }
}

TEST_F(CliTest, DevicesAreListedAndUnknownOnesRefused) {
    const auto devices = mcdem({"devices"});
    expect_done(devices);
    EXPECT_THAT(devices.out, HasSubstr("\n  0  "));
    const auto run = mcdem(run_words("a", {"--device", "abacus"}));
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, testing::AllOf(HasSubstr("mcdem: --device: must be"), HasSubstr("'abacus'"),
                                        HasSubstr("mcdem:   0  ")));
}

TEST_F(CliTest, DevicesAreComparedWithTheHostAtTheirFirstUse) {
    const std::vector<std::string> cache{"XDG_CACHE_HOME=" + path("cache").string(),
                                         "POCL_CACHE_DIR=" + wanted_kernel_cache().string()};
    const auto first = mcdem(run_words("a"), cache), second = mcdem(run_words("b"), cache);
    expect_done(first);
    EXPECT_THAT(first.err, HasSubstr("mcdem: first use of "));
    EXPECT_THAT(second.err, testing::Not(HasSubstr("first use")));
    const auto checked = mcdem({"devices", "--check"}, cache);
    expect_done(checked);
    EXPECT_THAT(checked.out, testing::AllOf(HasSubstr(" pass\n"), testing::Not(HasSubstr(" fail\n"))));
    EXPECT_THAT(mcdem(run_words("c"), {"XDG_CACHE_HOME=/proc", cache[1]}).err, HasSubstr("first use of "));
}

TEST_F(CliTest, NoDeviceIsAFailure) {
    std::filesystem::create_directory(path("no_vendors"));
    const auto devices = mcdem({"devices"}, {"OCL_ICD_VENDORS=" + path("no_vendors").string()});
    EXPECT_EQ(devices.exit_code, 1);
    EXPECT_THAT(devices.err, HasSubstr("pocl-opencl-icd"));
}

}  // namespace
}  // namespace mcdem
