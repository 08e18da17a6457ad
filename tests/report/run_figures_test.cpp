// Values of the figures of runs, for pages and print: levels, densities, thresholds, slopes.
#include "report/run/run_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "metrics/synthetic.h"
#include "report/run/figure_values.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

Run two_models(int replicas, int contacts = 300) {
    return synthetic::run({{.model = "independent", .top = 6, .contacts = contacts},
                           {.model = "mc_dem", .top = 15, .contacts = contacts}},
                          replicas);
}

nlohmann::json values_of(const std::vector<Setting>& settings, const std::optional<Setting>& reference = {},
                         const FigureOptions& options = {}) {
    const auto data = figure_data(settings, reference, options);
    return nlohmann::json::parse(figure_file(figure_values(run_figures(data, options), data)));
}

TEST(RunFigures, top_forces_are_the_level_means) {
    const auto run = two_models(1);
    const auto series = values_of(group_by_setting(run))["top_force"]["series"][1];
    EXPECT_EQ(series["setting"], "mc_dem");
    EXPECT_EQ(series["words"], "MC-DEM");
    const auto &load = series["curves"][0], unload = series["curves"][1];
    EXPECT_EQ(load["phase"], "load");
    ASSERT_EQ(load["x"].size(), 10u);
    EXPECT_NEAR(load["x"][9].get<double>(), 30, 1e-9);
    EXPECT_NEAR(load["y"][9].get<double>(), 15, 1e-9);
    EXPECT_TRUE(load["standard_error"][9].is_null());
    ASSERT_EQ(unload["x"].size(), 11u);  // including the turning point
    EXPECT_EQ(unload["y"][10], load["y"][9]);
}

TEST(RunFigures, errors_require_replicas) {
    const auto run = two_models(4);
    const auto curve = values_of(group_by_setting(run))["top_force"]["series"][1]["curves"][0];
    EXPECT_TRUE(curve["standard_error"][9].is_number());
}

TEST(RunFigures, the_distribution_is_that_of_the_level_nearest_to_the_request) {
    const auto run = two_models(1);
    const auto values = values_of(group_by_setting(run))["force_distribution"];
    EXPECT_NEAR(values["displacement_mm"].get<double>(), 18, 1e-9);
    EXPECT_EQ(values["series"][0]["curves"][0]["phase"], "unload");
    const auto other = values_of(group_by_setting(run), {}, {.distribution_displacement = 50e-3});
    EXPECT_NEAR(other["force_distribution"]["displacement_mm"].get<double>(), 30, 1e-9);
    EXPECT_EQ(other["force_distribution"]["series"][0]["curves"][0]["phase"], "load") << "the turning point";
}

TEST(RunFigures, the_distribution_is_of_loading_if_runs_stopped_before_unloading) {
    auto run = two_models(1);
    for (auto& recording : run.recordings)
        std::erase_if(recording.scans, [](const Scan& scan) { return scan.phase == Phase::unload; });
    const auto values =
        values_of(group_by_setting(run), {}, {.distribution_displacement = 50e-3})["force_distribution"];
    EXPECT_EQ(values["series"][0]["curves"][0]["phase"], "load");
    EXPECT_NEAR(values["displacement_mm"].get<double>(), 30, 1e-9);
}

TEST(RunFigures, densities_integrate_to_nearly_one) {
    const auto run = synthetic::run({{.contacts = 5000}}, 1);
    const auto curve = values_of(group_by_setting(run))["force_distribution"]["series"][0]["curves"][0];
    double sum = 0;
    for (const double density : curve["y"]) sum += density * 2 * curve["x"][0].get<double>();
    EXPECT_NEAR(sum, 1, 0.01);  // all but a thousandth of the contacts
}

TEST(RunFigures, each_setting_has_its_own_tau) {
    const auto run = synthetic::run({{.contacts = 2000}}, 1);
    auto measured = run.recordings[0];
    for (auto& scan : measured.scans)
        std::erase_if(scan.contacts, [](const Contact& c) { return c.force.norm() < 4e-3; });
    const auto series =
        values_of(group_by_setting(run), Setting{"experiment", {&measured}})["coordination"]["series"];
    EXPECT_EQ(series[0]["remark"], "tau 4.00 mN");
    EXPECT_EQ(series[1]["is_reference"], true);
    EXPECT_EQ(series[1]["remark"], "");
    for (const int phase : {0, 1})
        EXPECT_EQ(series[0]["curves"][phase]["y"], series[1]["curves"][phase]["y"]);
}

TEST(RunFigures, no_tau_without_contacts_of_the_reference) {
    const auto run = synthetic::run({{.contacts = 2000}}, 1);
    auto measured = run.recordings[0];
    for (auto& scan : measured.scans) {
        scan.contacts.clear();
        scan.coordination_number = not_available;
    }
    const auto series =
        values_of(group_by_setting(run), Setting{"experiment", {&measured}})["coordination"]["series"];
    EXPECT_EQ(series[0]["remark"], "");
}

TEST(RunFigures, the_scaling_law_has_its_slope) {
    const auto run = two_models(1);
    const auto series = values_of(group_by_setting(run))["scaling"]["series"][1];
    EXPECT_EQ(series["remark"], "150 /m");
    EXPECT_NEAR(series["slope"].get<double>(), 0.15, 1e-9);  // N over mN m
}

TEST(RunFigures, the_ratio_to_the_reference_is_included) {
    const auto run = two_models(1);
    const auto series =
        values_of(group_by_setting(run), Setting{"experiment", {&run.recordings[1]}})["top_force"]["series"];
    EXPECT_EQ(series[0]["remark"], "Rtop 0.40");
    EXPECT_EQ(series[2]["colour"], "#000000");
}

TEST(RunFigures, missing_data_are_explained) {
    auto run = two_models(1, 0);
    for (auto& recording : run.recordings)
        for (auto& scan : recording.scans)
            scan.coordination_number = scan.mean_force = scan.packing_fraction = scan.branch_length =
                not_available;
    const auto data = figure_data(group_by_setting(run), std::nullopt, {});
    const auto made = run_figures(data, {});
    EXPECT_EQ(made.figures.size(), 1u);
    ASSERT_EQ(made.missing.size(), 3u);
    EXPECT_THAT(made.missing[0], HasSubstr("no contacts were recorded"));
}

TEST(FigureFile, contains_its_format_and_any_label) {
    const auto run = two_models(1);
    auto settings = group_by_setting(run);
    settings[0].label = "\xff\" \\ `x`\n";
    const auto values = values_of(settings);
    EXPECT_EQ(values["mcdem_figures"], 1);
    EXPECT_THAT(values["top_force"]["series"][0]["words"].get<std::string>(), HasSubstr("\" \\ `x` "));
}

TEST(SeriesStyle, each_model_keeps_its_colour_and_settings_differ) {
    const auto both = two_models(1);
    const auto one = synthetic::run({{.model = "mc_dem"}}, 1);
    const auto settings = group_by_setting(both);
    EXPECT_EQ(styles_of(settings)[1].colour, styles_of(group_by_setting(one))[0].colour);
    std::set<std::string> colours;
    const std::vector<Setting> same_model(7, settings[0]);
    for (const auto& style : styles_of(same_model)) colours.insert(style.colour);
    EXPECT_EQ(colours.size(), 7u);
    EXPECT_FALSE(colours.contains(reference_style().colour));
}

}  // namespace
}  // namespace mcdem
