// Packings read from files that mcdem wrote.
#include "cli/cli_test.h"
#include "io/results.h"

namespace mcdem {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class PackingTest : public CliTest {
protected:
    Finished validate(const std::vector<std::string>& more) const {
        std::vector<std::string> words{"validate", "small.toml"};
        for (const std::string& setting : more) words.insert(words.end(), {"--set", setting});
        return mcdem(words);
    }
};

TEST_F(PackingTest, OfAnExperimentAndOfARunAreTheSame) {
    expect_done(
        mcdem(run_words("a", {"--set", "protocol.scan_at_start=true", "--set", "contact.model=mc_dem"})));
    expect_done(mcdem(
        {"experiment", "from-run", "a", "--position-error", "0", "--diameter-error", "0", "--out", "lab"}));
    const auto measured = validate({"packing.file=lab/grains.csv"});
    expect_done(measured);
    EXPECT_THAT(measured.out,
                ContainsRegex("grains.csv: 30 grains, Z = [0-9]+.[0-9]+, deepest overlap [0-9.e-]+ mm"));
    const auto recorded = validate({"packing.file=a/run.h5"});
    expect_done(recorded);
    EXPECT_THAT(recorded.out, ContainsRegex("run.h5: 30 grains, Z = "));
    const auto state = [](const std::string& out) { return out.substr(out.find(" grains, Z"), 60); };
    EXPECT_EQ(state(recorded.out), state(measured.out)) << "both begin at rest";
    const auto later = validate({"packing.file=lab/grains.csv", "packing.frame=4"});
    EXPECT_NE(later.out, measured.out);
    expect_bad_input(validate({"packing.file=lab/grains.csv", "packing.frame=77"}),
                     "the frame must be one of its 9 frames, 0 to 8, got 77");
    expect_done(mcdem({"run", "small.toml", "--set", "packing.file=a/run.h5", "--out", "b", "--no-figures"}));
    EXPECT_EQ(read_run(path("b")).recordings.front().diameter,
              read_run(path("a")).recordings.front().diameter);
}

// A loaded frame is continued with its friction: after it has relaxed with the plate at rest, the force is
// the frame's. Without springs it falls by 5 %.
TEST_F(PackingTest, OfALoadedFrameKeepsItsFriction) {
    const std::vector<std::string> more{
        "--set", "protocol.scan_at_start=true", "--set", "protocol.stop_at_scans=true",
        "--set", "contact.model=mc_dem",        "--set", "grains.friction=0.3",
        "--set", "protocol.settle_time=1",      "--set", "protocol.relax_time=1"};
    expect_done(mcdem(run_words("a", more)));
    const Scan loaded = read_run(path("a")).recordings.front().scans.at(3);
    const std::vector<std::string> frame{"--set", "packing.file=a/run.h5",
                                         "--set", "packing.frame=3",
                                         "--set", fmt::format("plate.start={}", loaded.plate_z)};
    auto again = more, validated = frame;
    again.insert(again.end(), frame.begin(), frame.end());
    expect_done(mcdem(run_words("b", again)));
    const double force = read_run(path("b")).recordings.front().scans.at(0).top_force();
    EXPECT_NEAR(force / loaded.top_force(), 1, 2e-3);
    validated.insert(validated.begin(), {"validate", "small.toml"});
    EXPECT_THAT(mcdem(validated).out, ContainsRegex("run.h5: friction springs start with the tangential "
                                                    "forces of its [0-9]+ contacts"));
}

// Without recorded forces a loaded frame has lost the history of its contacts; a packing at rest has none
// worth a word.
TEST_F(PackingTest, OfALoadedFrameWithoutForcesStartsWithoutItsHistory) {
    expect_done(mcdem(run_words("a", {"--set", "protocol.scan_at_start=true", "--set",
                                      "output.contacts=false", "--set", "contact.model=independent"})));
    const std::string said =
        "% of a diameter, but the history of their contacts is not in the file (friction springs)";
    const std::vector<std::string> loaded{"packing.file=a/run.h5", "packing.frame=4", "plate.start=0.08"};
    const auto validated = validate(loaded);
    expect_done(validated);
    EXPECT_THAT(validated.err, HasSubstr(said));
    EXPECT_THAT(mcdem({"run", "small.toml", "--set", loaded[0], "--set", loaded[1], "--set", loaded[2],
                       "--out", "b", "--no-figures"})
                    .err,
                HasSubstr(said));
    auto saturated = loaded;
    saturated.push_back("contact.friction_law=saturated");
    EXPECT_EQ(validate(saturated).err, "");
}

TEST_F(PackingTest, OfARunMustFitTheContainer) {
    expect_done(mcdem(run_words("a", {"--set", "contact.model=independent"})));
    expect_bad_input(
        validate({"packing.file=a/run.h5", "box.size_x=0.07"}),
        "a/run.h5, frame 0: the box must be that of the scene, container.size_x = 0.07, got 0.06: set "
        "container.size_x = 0.06");
    expect_bad_input(
        validate({"packing.file=a/run.h5", "container.shape=periodic"}),
        "must be of the scene's container.shape = \"periodic\", got a box: set container.shape = \"box\"");
}

}  // namespace
}  // namespace mcdem
