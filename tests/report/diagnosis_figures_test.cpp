#include "report/diagnosis_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "report/diagnosis_samples.h"
#include "report/draw_figure.h"
#include "report/folder.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using Fields = std::vector<std::string>;

/// Blocks of rows of fields, without the header. Fields of the samples hold no commas.
std::vector<std::vector<Fields>> blocks_of(const Figure& figure) {
    std::vector<std::vector<Fields>> blocks(1);
    std::istringstream in(figure.data);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        if (line.empty()) {
            if (!blocks.back().empty()) blocks.emplace_back();
            continue;
        }
        Fields fields(1);
        for (const char c : line) c == ',' ? void(fields.emplace_back()) : fields.back().push_back(c);
        blocks.back().push_back(fields);
    }
    return blocks;
}

double number(const std::string& field) { return std::stod(field); }

TEST(WhereFigure, draws_every_cell_twice_and_frames_those_beyond_the_threshold) {
    const auto d = samples::diagnosis(Verdict::effect);
    const auto blocks = blocks_of(*where_figure(d));
    ASSERT_EQ(blocks.size(), 8u);  // two panels: all, framed, dark, light
    std::size_t before = 0, after = 0;
    for (const auto& cell : d.cells) {
        before += std::fabs(cell.z_score) >= d.where_threshold;
        after += std::fabs(cell.z_score_refitted) >= d.where_threshold;
    }
    ASSERT_GT(before, after);
    EXPECT_EQ(blocks[0].size(), 250u);
    EXPECT_EQ(blocks[1].size(), before);
    EXPECT_EQ(blocks[2].size() + blocks[3].size(), before);
    EXPECT_EQ(blocks[4].size(), 250u);
    EXPECT_EQ(blocks[5].size(), after);
}

TEST(WhereFigure, time_runs_from_left_to_right) {
    Diagnosis d;
    for (const auto& [phase, displacement] : std::vector<std::pair<std::string, double>>{
             {"unload", 0.02}, {"load", 0.01}, {"unload", 0.01}, {"load", 0.02}})
        d.cells.push_back({"top_force", phase, displacement, 1, 1});
    std::map<double, std::string> by_place;
    const auto blocks = blocks_of(*where_figure(d));
    for (const auto& row : blocks[0]) by_place[number(row[0])] = row[9] + row[10];
    std::vector<std::string> order;
    for (const auto& [x, what] : by_place) order.push_back(what);
    EXPECT_THAT(order, ElementsAre("load10", "load20", "unload20", "unload10"));
}

TEST(WhereFigure, without_a_threshold_frames_the_entries_before_recalibration) {
    Diagnosis d;
    d.cells = {{"top_force", "load", 0.01, 5, 5},
               {"top_force", "load", 0.02, 5, 5},
               {"top_force", "unload", 0.01, 5, 5},
               {"mean_force", "load", 0.01, 5, 5}};
    d.where = {{"top_force", "load", {0.005, 0.015}, {}, {}, 5, 5}};
    const auto blocks = blocks_of(*where_figure(d));
    ASSERT_EQ(blocks.size(), 4u);  // all, framed and its numbers; all
    ASSERT_EQ(blocks[1].size(), 1u);
    EXPECT_EQ(blocks[1][0][8] + blocks[1][0][9] + blocks[1][0][10], "top_forceload10");
}

TEST(WhereFigure, needs_a_number) {
    Diagnosis d;
    EXPECT_FALSE(where_figure(d));
    d.cells = {{"top_force", "load", 0.01, std::nan(""), std::nan("")}};
    EXPECT_FALSE(where_figure(d));
}

TEST(WhichFigure, bars_are_scores_and_the_named_ones_stand_out) {
    const auto group = *which_figure(samples::diagnosis(Verdict::group));
    const auto blocks = blocks_of(group);
    ASSERT_GE(blocks.size(), 2u);
    EXPECT_EQ(blocks[0].size(), 3u);
    EXPECT_EQ(blocks[1].size(), 15u);
    EXPECT_NEAR(number(blocks[0][1][3]), 17.8, 1e-9);
    EXPECT_THAT(group.script, HasSubstr(diagnosis_colour::named));
    for (const auto verdict : {Verdict::no_gap, Verdict::unknown_effect, Verdict::calibration_suspect})
        EXPECT_THAT(which_figure(samples::diagnosis(verdict))->script,
                    Not(HasSubstr(diagnosis_colour::named)));
}

TEST(WhichFigure, amplitudes_are_over_their_limits_with_90_percent_intervals) {
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
    const auto rows = blocks_of(*which_figure(d))[2];
    ASSERT_EQ(rows.size(), 1u);  // b never shows
    EXPECT_DOUBLE_EQ(number(rows[0][0]), 3);
    EXPECT_NEAR(number(rows[0][2]), 3 - 0.82243, 1e-4);  // 1.64485 sigma / 2
    EXPECT_NEAR(number(rows[0][3]), 3 + 0.82243, 1e-4);
}

TEST(WhichFigure, needs_a_ranking) { EXPECT_FALSE(which_figure({})); }

std::vector<Cause> ranking_of(const std::vector<std::vector<std::string>>& groups) {
    std::vector<Cause> ranking;
    for (std::size_t i = 0; i < groups.size(); ++i)
        ranking.push_back({.effect = std::string(1, static_cast<char>('a' + i)),
                           .unit = "",
                           .group = groups[i],
                           .confirmed_score = {}});
    return ranking;
}

TEST(GroupLetters, are_shared_by_what_cannot_be_told_apart) {
    EXPECT_THAT(group_letters(ranking_of({{"a", "c"}, {"b"}, {"c", "a"}, {"d", "e"}, {"e", "d"}})),
                ElementsAre("A", "", "A", "B", "B"));
    // b is near a and c, which are told apart from one another: no letter joins all three
    EXPECT_THAT(group_letters(ranking_of({{"a", "b"}, {"b"}, {"c", "b"}})), ElementsAre("A", "AB", "B"));
    EXPECT_THAT(group_letters(ranking_of({{"a", "b", "c"}, {"b", "a"}, {"c"}})), ElementsAre("A", "A", "A"));
    EXPECT_TRUE(group_letters({}).empty());
}

TEST(HowFarFigure, shows_what_is_left_of_the_gap) {
    auto d = samples::diagnosis(Verdict::effect);
    const auto figure = *how_far_figure(d);
    const auto blocks = blocks_of(figure);
    ASSERT_EQ(blocks.size(), 5u);  // forces; before, after, simulated, placebo
    EXPECT_EQ(blocks[0].size(), 21u);
    EXPECT_EQ(blocks[0][20][0], "30");
    EXPECT_NEAR(number(blocks[0][20][1]), 14.65, 1e-9);  // experiment
    EXPECT_NEAR(number(blocks[0][20][2]), 13.1, 1e-9);   // before
    const auto left = [&](int block, int field) {
        return number(blocks[static_cast<std::size_t>(block)][0][static_cast<std::size_t>(field)]);
    };
    EXPECT_DOUBLE_EQ(left(1, 0), 100);
    EXPECT_NEAR(left(2, 0), 19, 1e-9);
    EXPECT_NEAR(left(2, 6), 7, 1e-9);  // interval of the shrink: 66 to 93 %
    EXPECT_NEAR(left(2, 7), 34, 1e-9);
    EXPECT_NEAR(left(3, 0), 21, 1e-9);
    EXPECT_NEAR(left(4, 0), 88, 1e-9);
    EXPECT_THAT(figure.script, HasSubstr("from first 0, graph 0 to first 18, graph 1"));
}

TEST(HowFarFigure, does_without_forces_and_not_without_a_gap) {
    auto d = samples::diagnosis(Verdict::effect);
    d.shrink->top_force = {{0.01, std::nan(""), 1, 1}};
    d.shrink->fitted_displacement = {0, 0};
    EXPECT_EQ(blocks_of(*how_far_figure(d)).size(), 4u);
    d.shrink->before = 0;
    EXPECT_FALSE(how_far_figure(d));
    d.shrink.reset();
    EXPECT_FALSE(how_far_figure(d));
}

TEST(DiagnosisFigures, poor_data_can_be_drawn) {
    const TestFolder folder;
    Diagnosis d;
    d.cells = {{"top_force", "", 0.01, 5, std::nan("")}};
    d.ranking = {{.effect = "a",
                  .amplitude = std::nan(""),
                  .unit = "",
                  .group = {},
                  .score = std::nan(""),
                  .confirmed_score = {}}};
    d.shrink = Shrink{.held_out = "",
                      .before = 1,
                      .fraction = -0.5,
                      .interval = {-1, 0},
                      .confirmed = {},
                      .metrics = {},
                      .top_force = {}};
    for (const auto& figure : {where_figure(d), which_figure(d), how_far_figure(d)})
        EXPECT_NO_THROW(draw_figure(*figure, folder.path));
}

}  // namespace
}  // namespace mcdem
