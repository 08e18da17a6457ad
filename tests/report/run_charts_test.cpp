#include "report/run/run_charts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

Run two_models(int replicas, int contacts = 300) {
    return synthetic::run({{.model = "independent", .top = 6, .scatter = 0.1, .contacts = contacts},
                           {.model = "mc_dem", .top = 15, .scatter = 0.1, .contacts = contacts}},
                          replicas);
}

const Chart& chart_named(const RunCharts& made, const std::string& name) {
    for (const auto& chart : made.charts)
        if (chart.name == name) return chart;
    throw std::out_of_range(name);
}

/// The traces of a name, bands left out.
std::vector<Json> traces_named(const Chart& chart, const std::string& name) {
    std::vector<Json> found;
    for (const auto& trace : chart.data)
        if (trace.at("name") == name && !trace.contains("fill")) found.push_back(trace);
    return found;
}

TEST(RunCharts, are_the_papers_four_figures) {
    const auto run = two_models(1);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    ASSERT_EQ(made.charts.size(), 4u);
    EXPECT_TRUE(made.notes.empty());
    EXPECT_EQ(chart_named(made, "force_distribution").layout["yaxis"]["type"], "log");
}

TEST(RunCharts, top_forces_are_those_of_the_levels) {
    const auto run = two_models(1);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    const auto curves = traces_named(chart_named(made, "top_force"), "MC-DEM");
    ASSERT_EQ(curves.size(), 2u);
    const auto& scans = run.recordings[1].scans;
    ASSERT_EQ(curves[0]["x"].size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_NEAR(curves[0]["x"][i].get<double>(), run.recordings[1].displacement(scans[i]) * 1e3, 1e-9);
        EXPECT_NEAR(curves[0]["y"][i].get<double>(), scans[i].top_force(), 1e-12);
    }
    EXPECT_EQ(curves[0]["line"]["dash"], "solid");
    EXPECT_EQ(curves[1]["line"]["dash"], "dash");
    EXPECT_EQ(curves[1]["y"].back(), curves[0]["y"].back());  // unloading starts where loading ended
    EXPECT_FALSE(curves[0].contains("customdata"));           // no spread of one replica
}

TEST(RunCharts, bands_are_the_standard_error_over_replicas) {
    const auto run = two_models(4);
    const auto settings = group_by_setting(run);
    const auto made = run_charts(settings, std::nullopt);
    const auto& chart = chart_named(made, "top_force");
    const auto curve = traces_named(chart, "MC-DEM").front();
    const auto means = level_means(group_levels(settings[1].replicas), top_force);
    ASSERT_GT(means[9].mean.standard_error, 0.1);
    EXPECT_NEAR(curve["customdata"][9].get<double>(), means[9].mean.standard_error, 1e-12);
    EXPECT_THAT(curve["hovertemplate"].get<std::string>(), HasSubstr("± %{customdata"));
    for (const auto& trace : chart.data)
        if (trace["name"] == "MC-DEM ± standard error") {
            EXPECT_NEAR(trace["y"][9].get<double>(), means[9].mean.value + means[9].mean.standard_error,
                        1e-12);
            EXPECT_NEAR(trace["y"][10].get<double>(), means[9].mean.value - means[9].mean.standard_error,
                        1e-12);
            return;
        }
    FAIL() << "no band";
}

/// The band of a curve, which stands before it: there along mean + error, back along mean - error.
void expect_band(const Json& band, const Json& curve, const std::string& what) {
    ASSERT_TRUE(band.contains("fill")) << what;
    const auto count = curve["y"].size();
    ASSERT_EQ(band["y"].size(), 2 * count) << what;
    for (std::size_t i = 0; i < count; ++i) {
        const double y = curve["y"][i], error = curve["customdata"][i];
        EXPECT_NEAR(band["y"][i].get<double>(), y + error, 1e-12) << what;
        EXPECT_NEAR(band["y"][2 * count - 1 - i].get<double>(),
                    y > 0 ? std::max(y - error, y / 3) : y - error, 1e-12)
            << what;
        EXPECT_EQ(band["x"][2 * count - 1 - i], curve["x"][i]) << what;
    }
}

TEST(RunCharts, every_curve_of_replicas_says_its_error) {
    const auto run = two_models(4);
    for (const auto& chart : run_charts(group_by_setting(run), std::nullopt).charts)
        for (std::size_t t = 0; t < chart.data.size(); ++t) {
            const auto& trace = chart.data[t];
            const std::string mode = trace["mode"];
            if (mode == "lines") continue;  // bands, and the scaling law's fits
            EXPECT_THAT(trace["hovertemplate"].get<std::string>(), HasSubstr("± %{customdata")) << chart.name;
            if (mode == "markers")
                EXPECT_EQ(trace["error_y"]["array"], trace["customdata"]) << chart.name;
            else if (t > 0)
                expect_band(chart.data[t - 1], trace, chart.name);
            else
                ADD_FAILURE() << chart.name << ": a line without its band";
        }
}

TEST(RunCharts, logarithms_are_for_forces_that_grow_over_decades) {
    const auto run = two_models(2);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    EXPECT_EQ(chart_named(made, "top_force").log_axes, "xy");
    EXPECT_EQ(chart_named(made, "scaling").log_axes, "xy");
    EXPECT_EQ(chart_named(made, "coordination").log_axes, "");
    EXPECT_EQ(chart_named(made, "force_distribution").log_axes, "");  // is so without a button
}

/// The made-up packings hold 1/150 m of the force on the plate in their averages.
TEST(RunCharts, scaling_line_has_the_slope_of_its_points) {
    const auto run = two_models(1);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    const auto curves = traces_named(chart_named(made, "scaling"), "MC-DEM");
    ASSERT_EQ(curves.size(), 3u);
    for (const auto& curve : curves)
        for (std::size_t i = 0; i < curve["x"].size(); ++i)
            EXPECT_NEAR(curve["y"][i].get<double>(), 150 * curve["x"][i].get<double>() * 1e-3, 1e-9);
    EXPECT_EQ(curves[2]["hovertemplate"], "slope 150 /m");
}

TEST(RunCharts, densities_add_up_to_one) {
    const auto run = two_models(3, 3000);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    for (const std::string name : {"Independent contacts", "MC-DEM"}) {
        const auto curve = traces_named(chart_named(made, "force_distribution"), name).front();
        const double width = 2 * curve["x"][0].get<double>();  // of the first bin, from zero
        double sum = 0;
        for (const auto& density : curve["y"]) sum += density.get<double>() * width;
        EXPECT_NEAR(sum, 1, 2e-3) << name;
        EXPECT_LE(sum, 1 + 1e-12) << name;
    }
}

TEST(RunCharts, contacts_per_grain_are_counted_above_the_threshold) {
    const auto run = two_models(1);
    const double threshold = 30e-3;
    const auto made =
        run_charts(group_by_setting(run), std::nullopt, {.compare = {}, .threshold = threshold});
    const auto& recording = run.recordings[1];
    const auto curve = traces_named(chart_named(made, "coordination"), "MC-DEM, tau 30.00 mN").at(0);
    ASSERT_EQ(curve["y"].size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        int ends = 0;
        for (const auto& contact : recording.scans[i].contacts)
            if (contact.force.norm() >= threshold) ends += is_wall(contact.partner) ? 1 : 2;
        EXPECT_NEAR(curve["y"][i].get<double>(), ends / double(recording.diameter.size()), 1e-12);
    }
}

TEST(RunCharts, a_reference_is_points_in_the_pages_ink) {
    const auto run = two_models(1);
    const auto measured = synthetic::recording({.seed = 50, .contacts = 300});
    const auto made = run_charts(group_by_setting(run), Setting{"experiment", {&measured}});
    for (const auto& chart : made.charts) {
        const auto points = traces_named(chart, "experiment");
        ASSERT_FALSE(points.empty()) << chart.name;
        EXPECT_EQ(points[0]["mode"], "markers") << chart.name;
        EXPECT_EQ(points[0]["marker"]["color"], "var(--ink)") << chart.name;
    }
    EXPECT_EQ(chart_named(made, "coordination").title, "Contacts per grain, weak forces left out");
}

TEST(RunCharts, what_cannot_be_drawn_is_said) {
    auto run = two_models(1, 0);
    for (auto& recording : run.recordings)
        for (auto& scan : recording.scans)
            scan.coordination_number = scan.mean_force = scan.packing_fraction = scan.branch_length =
                not_available;
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    EXPECT_EQ(made.charts.size(), 1u);
    EXPECT_EQ(made.notes.size(), 3u);
}

TEST(RunCharts, labels_cannot_become_tags) {
    const auto run = two_models(1);
    auto settings = group_by_setting(run);
    settings[0].label = "<a href=\"x\">%{y}</a>";
    const auto made = run_charts(settings, std::nullopt);
    for (const auto& chart : made.charts)
        EXPECT_EQ(chart.data.dump().find("<a"), std::string::npos) << chart.name;
    EXPECT_FALSE(traces_named(chart_named(made, "top_force"), "&lt;a href=\"x\"&gt;%{y}&lt;/a&gt;").empty());
}

}  // namespace
}  // namespace mcdem
