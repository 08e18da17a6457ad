#include "report/diagnosis/diagnosis_charts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "report/diagnosis/diagnosis_parts.h"
#include "report/diagnosis_samples.h"

namespace mcdem {
namespace {

/// The number in the trace's row and at the place of column `x`.
double cell_at(const Json& trace, std::size_t row, double x) {
    for (std::size_t c = 0; c + 1 < trace["x"].size(); ++c)
        if (trace["x"][c] < x && x < trace["x"][c + 1]) return trace["z"][row][c].get<double>();
    return std::nan("");
}

TEST(WhereChart, every_cell_stands_at_its_place_before_and_after) {
    Diagnosis d;
    d.cells = {{"top_force", "load", 0.01, 1, -1},    {"top_force", "load", 0.02, 2, -2},
               {"top_force", "unload", 0.02, 3, -3},  {"top_force", "unload", 0.01, 4, -4},
               {"mean_force", "unload", 0.01, 5, -5}, {"mean_force", "load", 0.01, std::nan(""), 0}};
    const auto chart = *where_chart(d);
    const auto& before = chart.data[0];
    for (const auto& [x, z] : {std::pair{0.5, 1.0}, {1.5, 2.0}, {2.85, 3.0}, {3.85, 4.0}})
        EXPECT_EQ(cell_at(before, 0, x), z);
    EXPECT_EQ(cell_at(before, 1, 3.85), 5);
    EXPECT_TRUE(before["z"][1][0].is_null());
    EXPECT_TRUE(before["z"][0][2].is_null());  // between the phases
    for (const auto& trace : chart.data)
        if (trace["name"] == "after recalibration") {
            EXPECT_EQ(cell_at(trace, 0, 1.5), -2);
        }
    EXPECT_THAT(before["text"][0][1].get<std::string>(),
                testing::HasSubstr("loading at 20.00 mm<br>2.00 sigma"));
}

TEST(WhereChart, frames_what_stands_out) {
    const auto d = samples::diagnosis(Verdict::effect);
    std::size_t before = 0, after = 0;
    for (const auto& cell : d.cells) {
        before += std::fabs(cell.z_score) >= d.where_threshold;
        after += std::fabs(cell.z_score_refitted) >= d.where_threshold;
    }
    const auto chart = *where_chart(d);
    EXPECT_EQ(chart.layout["shapes"].size(), before + after);
    EXPECT_FALSE(where_chart({}));
}

TEST(WhichChart, has_scores_amplitudes_and_their_words) {
    const auto d = samples::diagnosis(Verdict::group);
    const auto chart = *which_chart(d);
    const auto& bars = chart.data[0];
    ASSERT_EQ(bars["x"].size(), d.ranking.size());
    EXPECT_EQ(bars["x"][1], d.ranking[1].score);
    EXPECT_EQ(bars["marker"]["color"][1], diagnosis_colour::named);
    EXPECT_EQ(bars["marker"]["color"][17], diagnosis_colour::other);
    const auto& dots = chart.data[2];
    EXPECT_NEAR(dots["x"][0].get<double>(), d.ranking[0].amplitude / d.detection_limits[0].minimum_amplitude,
                1e-9);
    EXPECT_EQ(dots["x"].size(), d.ranking.size() - 2);  // two never show
    EXPECT_FALSE(which_chart({}));
}

TEST(HowFarCharts, are_forces_and_the_gap_left) {
    const auto d = samples::diagnosis(Verdict::effect);
    const auto charts = how_far_charts(d);
    ASSERT_EQ(charts.size(), 2u);
    EXPECT_EQ(charts[0].data[2]["y"][20], d.gap_reduction->top_force[20][1]);
    EXPECT_EQ(charts[0].layout["shapes"][0]["x1"], 18.0);
    EXPECT_NEAR(charts[1].data[0]["x"][1].get<double>(), 100 * (1 - d.gap_reduction->fraction), 1e-9);
    auto no_forces = d;
    no_forces.gap_reduction->top_force.clear();
    EXPECT_EQ(how_far_charts(no_forces).size(), 1u);
    EXPECT_TRUE(how_far_charts({}).empty());
}

TEST(DiagnosisCharts, names_cannot_become_tags) {
    const auto d = samples::with_texts(samples::diagnosis(Verdict::effect), "<a href='x'>y</a>");
    auto charts = how_far_charts(d);
    charts.push_back(*where_chart(d));
    charts.push_back(*which_chart(d));
    for (const auto& chart : charts) {
        EXPECT_EQ(chart.data.dump().find("<a"), std::string::npos) << chart.name;
        EXPECT_EQ(chart.layout.dump().find("<a"), std::string::npos) << chart.name;
    }
}

}  // namespace
}  // namespace mcdem
