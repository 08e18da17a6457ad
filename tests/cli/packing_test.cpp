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

}  // namespace
}  // namespace mcdem
