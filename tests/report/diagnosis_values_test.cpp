// Values of the figures of a diagnosis.
#include "report/diagnosis/diagnosis_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "report/diagnosis_samples.h"

namespace mcdem {
namespace {

using testing::ElementsAre;

std::size_t number_of_framed(const nlohmann::ordered_json& panel) {
    std::size_t framed = 0;
    for (const auto& cell : panel["cells"]) framed += cell["stands_out"].get<bool>();
    return framed;
}

TEST(WhereValues, contain_every_cell_twice_and_mark_those_beyond_the_threshold) {
    const auto d = samples::diagnosis(Verdict::effect);
    const auto panels = diagnosis_figure_values(d)["where"]["panels"];
    std::size_t before = 0, after = 0;
    for (const auto& cell : d.cells) {
        before += std::fabs(cell.z_score) >= d.where_threshold;
        after += std::fabs(cell.z_score_refitted) >= d.where_threshold;
    }
    ASSERT_GT(before, after);
    EXPECT_EQ(panels[0]["cells"].size(), 250u);
    EXPECT_EQ(panels[1]["cells"].size(), 250u);
    EXPECT_EQ(number_of_framed(panels[0]), before);
    EXPECT_EQ(number_of_framed(panels[1]), after);
}

TEST(WhereValues, are_ordered_by_time) {
    Diagnosis d;
    for (const auto& [phase, displacement] : std::vector<std::pair<std::string, double>>{
             {"unload", 0.02}, {"load", 0.01}, {"unload", 0.01}, {"load", 0.02}})
        d.cells.push_back({"top_force", phase, displacement, 1, 1});
    std::vector<std::string> order;
    double x = 0;
    const auto values = diagnosis_figure_values(d);
    for (const auto& column : values["where"]["columns"]) {
        order.push_back(column["phase"].get<std::string>() +
                        std::to_string(std::lround(column["displacement_mm"].get<double>())));
        EXPECT_GT(column["x"].get<double>(), x);
        x = column["x"].get<double>();
    }
    EXPECT_THAT(order, ElementsAre("loading10", "loading20", "unloading20", "unloading10"));
}

TEST(WhereValues, without_a_threshold_the_entries_before_recalibration_are_marked) {
    Diagnosis d;
    d.cells = {{"top_force", "load", 0.01, 5, 5},
               {"top_force", "load", 0.02, 5, 5},
               {"top_force", "unload", 0.01, 5, 5},
               {"mean_force", "load", 0.01, 5, 5}};
    d.where = {{"top_force", "load", {0.005, 0.015}, {}, {}, 5, 5}};
    const auto panels = diagnosis_figure_values(d)["where"]["panels"];
    EXPECT_EQ(number_of_framed(panels[0]), 1u);
    EXPECT_EQ(panels[0]["cells"][0]["stands_out"], true);
    EXPECT_EQ(number_of_framed(panels[1]), 0u);
}

TEST(WhichValues, are_scores_with_the_named_effects_marked) {
    const auto named = [](Verdict verdict) {
        int count = 0;
        const auto values = diagnosis_figure_values(samples::diagnosis(verdict));
        for (const auto& row : values["which"]["rows"]) count += row["is_named"].get<bool>();
        return count;
    };
    const auto group = diagnosis_figure_values(samples::diagnosis(Verdict::group))["which"]["rows"];
    EXPECT_EQ(group.size(), 18u);
    EXPECT_NEAR(group[1]["gain"].get<double>(), 17.8, 1e-9);
    EXPECT_EQ(named(Verdict::group), 3);
    for (const auto verdict : {Verdict::no_gap, Verdict::unknown_effect, Verdict::calibration_suspect})
        EXPECT_EQ(named(verdict), 0);
}

TEST(WhichValues, both_effects_of_a_pair_are_marked) {
    auto d = samples::diagnosis(Verdict::effect);
    d.causes.push_back(d.ranking[2]);
    const auto values = diagnosis_figure_values(d);
    std::vector<bool> named;
    for (const auto& row : values["which"]["rows"]) named.push_back(row["is_named"].get<bool>());
    std::vector<bool> expected(named.size(), false);
    expected[0] = expected[2] = true;
    EXPECT_EQ(named, expected);
    EXPECT_EQ(values["how_far"]["forces"]["words_after"], "simulated with both effects");
}

TEST(WhichValues, amplitudes_are_over_their_limits_with_90_percent_intervals) {
    Diagnosis d;
    d.ranking = {{.effect = "a",
                  .amplitude = 6,
                  .amplitude_error = 1,
                  .unit = "N",
                  .group = {"a"},
                  .score = 3,
                  .confirmed_score = {}},
                 {.effect = "b",
                  .amplitude = 1,
                  .amplitude_error = 1,
                  .unit = "",
                  .group = {"b"},
                  .score = 1,
                  .confirmed_score = {}}};
    d.detection_limits = {{.effect = "b", .unit = "", .group = {}},
                          {.effect = "a", .unit = "N", .minimum_amplitude = 2, .group = {}}};
    const auto rows = diagnosis_figure_values(d)["which"]["rows"];
    EXPECT_DOUBLE_EQ(rows[0]["over_limit"].get<double>(), 3);
    EXPECT_NEAR(rows[0]["half_interval"].get<double>(), 0.82243, 1e-4);  // 1.64485 sigma / 2
    EXPECT_FALSE(rows[1].contains("over_limit"));                        // b cannot be detected
}

std::vector<Cause> ranking_of(const std::vector<std::vector<std::string>>& groups) {
    std::vector<Cause> ranking;
    for (std::size_t i = 0; i < groups.size(); ++i)
        ranking.push_back({.effect = std::string(1, static_cast<char>('a' + i)),
                           .unit = "",
                           .group = groups[i],
                           .confirmed_score = {}});
    return ranking;
}

TEST(GroupLetters, are_shared_by_effects_that_cannot_be_distinguished) {
    EXPECT_THAT(group_letters(ranking_of({{"a", "c"}, {"b"}, {"c", "a"}, {"d", "e"}, {"e", "d"}})),
                ElementsAre("A", "", "A", "B", "B"));
    // b is close to a and c, which are distinguishable: no letter is common to all three
    EXPECT_THAT(group_letters(ranking_of({{"a", "b"}, {"b"}, {"c", "b"}})), ElementsAre("A", "AB", "B"));
    EXPECT_THAT(group_letters(ranking_of({{"a", "b", "c"}, {"b", "a"}, {"c"}})), ElementsAre("A", "A", "A"));
    EXPECT_TRUE(group_letters({}).empty());
}

TEST(HowFarValues, are_forces_and_the_remaining_gap) {
    const auto values = diagnosis_figure_values(samples::diagnosis(Verdict::effect))["how_far"];
    const auto& forces = values["forces"];
    ASSERT_EQ(forces["x"].size(), 21u);
    EXPECT_NEAR(forces["x"][20].get<double>(), 30, 1e-9);
    EXPECT_NEAR(forces["experiment"][20].get<double>(), 14.65, 1e-9);
    EXPECT_NEAR(forces["before"][20].get<double>(), 13.1, 1e-9);
    EXPECT_NEAR(forces["fitted"][1].get<double>(), 18, 1e-9);
    std::vector<double> left;
    for (const auto& bar : values["bars"]) left.push_back(std::round(bar["gap_left"].get<double>()));
    EXPECT_THAT(left, ElementsAre(100, 19, 21, 88));  // before, predicted, simulated, placebo
    EXPECT_NEAR(values["bars"][1]["interval"][0].get<double>(), 7, 1e-9);
    EXPECT_NEAR(values["bars"][1]["interval"][1].get<double>(), 34, 1e-9);
}

TEST(DiagnosisValues, work_without_unknown_values) {
    auto d = samples::diagnosis(Verdict::effect);
    d.gap_reduction->top_force = {{0.01, std::nan(""), 1, 1}};
    d.gap_reduction->fitted_displacement = {0, 0};
    EXPECT_TRUE(diagnosis_figure_values(d)["how_far"]["forces"].is_null());
    d.gap_reduction->before = 0;
    EXPECT_FALSE(diagnosis_figure_values(d).contains("how_far"));
    d.cells = {{"top_force", "load", 0.01, std::nan(""), std::nan("")}};
    EXPECT_FALSE(diagnosis_figure_values(d).contains("where"));
    EXPECT_TRUE(diagnosis_figure_values({}).empty());
}

}  // namespace
}  // namespace mcdem
