#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "metrics/synthetic.h"
#include "report/run/figure_values.h"
#include "report/run/run_page.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

Run scattered_models(int replicas, int contacts = 300) {
    return synthetic::run({{.model = "independent", .top = 6, .scatter = 0.1, .contacts = contacts},
                           {.model = "mc_dem", .top = 15, .scatter = 0.1, .contacts = contacts}},
                          replicas);
}

const Chart& chart_named(const RunCharts& made, const std::string& name) {
    for (const auto& chart : made.charts)
        if (chart.name == name) return chart;
    throw std::out_of_range(name);
}

TEST(RunCharts, are_the_papers_four_figures_with_the_values_of_the_printed_ones) {
    const auto run = scattered_models(1);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    ASSERT_EQ(made.charts.size(), 4u);
    EXPECT_TRUE(made.notes.empty());
    const auto data = figure_data(group_by_setting(run), std::nullopt, {});
    const auto values = figure_values(run_figures(data, {}), data);
    for (const auto& chart : made.charts) EXPECT_EQ(chart.values.dump(), values[chart.name].dump());
    EXPECT_EQ(chart_named(made, "force_distribution").title, "Contact forces at 18.0 mm, unloading");
}

TEST(RunCharts, logarithmic_axes_are_for_forces_over_several_decades) {
    const auto run = scattered_models(2);
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    EXPECT_EQ(chart_named(made, "top_force").log_axes, "xy");
    EXPECT_EQ(chart_named(made, "scaling").log_axes, "xy");
    EXPECT_EQ(chart_named(made, "coordination").log_axes, "");
    EXPECT_EQ(chart_named(made, "force_distribution").log_axes, "");  // always logarithmic, without a button
}

TEST(RunCharts, captions_describe_the_data) {
    const auto one = scattered_models(1), four = scattered_models(4);
    const auto measured = synthetic::recording({.seed = 50, .contacts = 300});
    const auto alone = run_charts(group_by_setting(one), std::nullopt);
    EXPECT_THAT(chart_named(alone, "top_force").caption, Not(HasSubstr("reference")));
    EXPECT_THAT(chart_named(alone, "top_force").caption, Not(HasSubstr("standard error")));
    EXPECT_EQ(chart_named(alone, "coordination").title, "Contacts per grain");
    const auto against = run_charts(group_by_setting(four), Setting{"experiment", {&measured}});
    EXPECT_THAT(chart_named(against, "top_force").caption, HasSubstr("Points: the reference"));
    for (const auto& name : {"top_force", "force_distribution", "coordination"})
        EXPECT_THAT(chart_named(against, name).caption, HasSubstr("one standard error over replicas"));
    EXPECT_EQ(chart_named(against, "coordination").title, "Contacts per grain, weak forces left out");
}

TEST(RunCharts, figures_that_cannot_be_drawn_are_explained) {
    auto run = scattered_models(1, 0);
    for (auto& recording : run.recordings)
        for (auto& scan : recording.scans)
            scan.coordination_number = scan.mean_force = scan.packing_fraction = scan.branch_length =
                not_available;
    const auto made = run_charts(group_by_setting(run), std::nullopt);
    EXPECT_EQ(made.charts.size(), 1u);
    EXPECT_EQ(made.notes.size(), 3u);
}

}  // namespace
}  // namespace mcdem
