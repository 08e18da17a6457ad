// Runs from the command line, and commands on their results.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
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

TEST_F(CliTest, ARunComparedWithItselfIsAPerfectFit) {
    expect_done(mcdem(run_words("a")));
    const auto compared =
        mcdem({"compare", "a", "--against", "a", "--setting", "elastic_sphere", "--out", "pictures"});
    expect_done(compared);
    const auto row = row_of(compared.out, "Elastic sphere");
    ASSERT_GE(row.size(), 4u) << compared.out;
    EXPECT_EQ(row[0], "1.000");                            // Rtop
    EXPECT_EQ(row[1], "0.00");                             // errf
    EXPECT_EQ(row[2], "0.00");                             // errZ
    EXPECT_THAT(row[3], testing::AnyOf("0.00", "-0.00"));  // bhat
    const auto other = row_of(compared.out, "Independent contacts");
    ASSERT_GE(other.size(), 4u);
    EXPECT_NE(other[0], "1.000");
    EXPECT_NE(other[1], "0.00");
    EXPECT_TRUE(fs::exists(path("pictures/top_force.png")));
}

TEST_F(CliTest, ReferenceSettingMustBeUnique) {
    expect_done(mcdem(run_words("a")));
    expect_bad_input(mcdem({"compare", "a", "--against", "a"}),
                     "choose one with --setting, of independent, elastic_sphere");
    expect_bad_input(mcdem({"compare", "a", "--against", "a", "--setting", "jelly"}), "got jelly");
    expect_bad_input(mcdem({"table", "a", "--over", "jelly"}), "got \"jelly\"");
}

TEST_F(CliTest, SeveralRunsAreDistinguished) {
    expect_done(mcdem(run_words("a", {"--set", "contact.model=mc_dem"})));
    expect_done(mcdem(run_words("b", {"--set", "contact.model=mc_dem", "--set", "contact.gamma=0.5"})));
    const auto table = mcdem({"table", "a", "b", "--over", "b: mc_dem"});
    expect_done(table);
    const auto a = row_of(table.out, "a: mc_dem"), b = row_of(table.out, "b: mc_dem");
    ASSERT_EQ(a.size(), 3u) << table.out;
    ASSERT_EQ(b.size(), 3u);
    EXPECT_GT(std::stod(a[1]), 1);
    EXPECT_EQ(b[1], "1.000");
    EXPECT_THAT(mcdem({"table", "a", "--markdown"}).out, HasSubstr("| model "));
    const auto drawn = mcdem({"figures", "a", "b", "--against", "a", "--out", "pictures"});
    expect_done(drawn);
    EXPECT_THAT(drawn.out, HasSubstr("pictures/top_force.png\n"));
}

TEST_F(CliTest, ExportWritesFilesOfGrainsContactsForcesAndWallsPerScan) {
    expect_done(mcdem(run_words("a")));
    const auto exported = mcdem({"export", "a", "--vtk", "--out", "paraview"});
    expect_done(exported);
    EXPECT_THAT(exported.out, testing::StartsWith("64 files in paraview; "));
    EXPECT_TRUE(fs::exists(path("paraview/replica_00001_elastic_sphere/contacts_000007.hdf")));
    expect_done(mcdem(run_words("bare", {"--set", "output.positions=false"})));
    expect_bad_input(mcdem({"export", "bare", "--vtk", "--out", "other"}), "output.positions");
}

TEST_F(CliTest, CalibrationFindsAndWritesTheGammaOfARun) {
    NEEDS_PYTHON_MODULE();
    std::ofstream(path("grain.csv")) << "x_m,y_m,z_m,diameter_m\n0.03,0.03,0.01,0.02\n";
    const std::vector<std::string> one_grain{
        "--set", "packing.file=grain.csv", "--set", "contact.model=mc_dem",
        "--set", "plate.start=0.0201",     "--set", "protocol.scans_per_stroke=2",
        "--set", "plate.end=0.018"};
    auto words = run_words("a", one_grain);
    words.insert(words.end(), {"--set", "contact.gamma=0.9"});
    expect_done(mcdem(words));
    std::vector<std::string> calibrate{"calibrate", "small.toml", "--experiment", "a", "--out", "gamma"};
    calibrate.insert(calibrate.end(), one_grain.begin(), one_grain.end());
    const auto calibrated = mcdem(calibrate);
    expect_done(calibrated);
    EXPECT_THAT(calibrated.out, testing::ContainsRegex("\ngamma = 0\\.(89|90)[0-9]+ ± "));
    const auto json = nlohmann::json::parse(bytes_of_file(path("gamma/calibration.json")));
    EXPECT_NEAR(json.at("gamma").get<double>(), 0.9, 0.01);
    EXPECT_TRUE(json.at("converged").get<bool>());
    EXPECT_GE(json.at("rounds").size(), 1u);

    calibrate[5] = "modulus";
    calibrate.insert(calibrate.end(), {"--model", "hyperelastic_sphere", "--high", "3"});
    const auto modulus = mcdem(calibrate);
    expect_done(modulus);
    EXPECT_THAT(modulus.out, testing::ContainsRegex("\nE = [0-9.]+ ± .*kPa"));
    const auto of_modulus = nlohmann::json::parse(bytes_of_file(path("modulus/calibration.json")));
    EXPECT_EQ(of_modulus.at("contact_model"), "hyperelastic_sphere");
    EXPECT_GT(of_modulus.at("youngs_modulus_Pa").get<double>(), 1e3);
    EXPECT_FALSE(of_modulus.contains("gamma"));
    calibrate.back() = "1";
    calibrate[calibrate.size() - 3] = "rubber";
    expect_bad_input(mcdem(calibrate), "rubber");
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
