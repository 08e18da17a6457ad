// What a run prints.
#include <gtest/gtest.h>

#include <sstream>

#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// The cells of the row that begins with `name`.
std::vector<std::string> row_of(const std::string& table, const std::string& name) {
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(name)) continue;
        std::istringstream words(line.substr(name.size()));
        return {std::istream_iterator<std::string>(words), {}};
    }
    return {};
}

TEST_F(CliTest, CompilesItsKernelsSilently) {
    const Finished run = mcdem(run_words("cold"), {"POCL_CACHE_DIR=" + path("cache").string()});
    expect_done(run);
    std::istringstream lines(run.err);
    for (std::string line; std::getline(lines, line);) EXPECT_THAT(line, testing::StartsWith("mcdem: "));
}

TEST_F(CliTest, RunPrintsSummaryTableAndPaths) {
    const auto run = mcdem({"run", "small.toml", "--out", "a"});
    expect_done(run);
    EXPECT_THAT(run.out, HasSubstr("small: 2 of 2 replicas done; "));
    EXPECT_THAT(run.out, HasSubstr("million grain-steps in "));
    EXPECT_EQ(row_of(run.out, "Elastic sphere").size(), 3u) << run.out;
    for (const char* file : {"a/run.h5", "a/plate.csv", "a/top_force.png", "a/scaling.png"}) {
        EXPECT_THAT(run.out, HasSubstr(std::string("\n  ") + file + "\n"));
        EXPECT_TRUE(fs::exists(path(file))) << file;
    }
    EXPECT_THAT(run.err, testing::StartsWith("mcdem: small: 2 replicas of 30 grains on "));
}

TEST_F(CliTest, ScansBeforeThePackingSettledAreReported) {
    const auto told = [&](const std::string& out, const std::string& setting) {
        const auto run = mcdem(run_words(out, {"--set", setting}));
        expect_done(run);
        return run.err;
    };
    const std::string settled = "scans were taken before the packing had settled";
    EXPECT_THAT(told("short", "protocol.settle_time=1e-4"), HasSubstr("14 of 14 " + settled));
    EXPECT_THAT(told("rough", "protocol.settle_unbalanced_force=1"), testing::Not(HasSubstr(settled)));
    EXPECT_THAT(told("moving", "protocol.stop_at_scans=false"), testing::Not(HasSubstr(settled)));
}

TEST_F(CliTest, OneModelGetsNoTable) {
    const auto run = mcdem(run_words("a", {"--set", "contact.model=mc_dem"}));
    expect_done(run);
    EXPECT_THAT(run.out, HasSubstr("1 of 1 replica done"));
    EXPECT_THAT(run.out, testing::Not(HasSubstr("MC-DEM")));
    EXPECT_FALSE(fs::exists(path("a/top_force.png")));
}

TEST_F(CliTest, OneFailedReplicaIsNamedAndIfAllFailItIsAFailure) {
    const auto one = mcdem(run_words("one", {"--set", "batch.vary.numerics.overlap_limit=[0.0005, 0.5]",
                                             "--set", "contact.model=elastic_sphere"}));
    expect_done(one);
    EXPECT_THAT(one.out, HasSubstr("1 of 2 replicas done, 1 stopped early"));
    EXPECT_THAT(one.err, HasSubstr("mcdem: replica "));
    EXPECT_THAT(one.err, HasSubstr(" stopped at step "));
    const auto all = mcdem(run_words("all", {"--set", "numerics.overlap_limit=0.0005"}));
    EXPECT_EQ(all.exit_code, 1);
    EXPECT_THAT(all.out, HasSubstr("0 of 2 replicas done, 2 stopped early"));
    EXPECT_THAT(all.err, HasSubstr("mcdem: all replicas stopped early"));
    expect_done(mcdem({"table", "all"}));  // recorded scans stay readable
}

}  // namespace
}  // namespace mcdem
