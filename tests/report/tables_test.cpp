#include "report/run/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(TextTable, columns_are_aligned_by_characters_on_terminals) {
    const TextTable table{
        {{"name", Align::left}, {"F"}}, {{"φ", "1.5"}, {"long name", "10 ± 2"}}, {"a note"}};
    EXPECT_EQ(to_text(table, TableFormat::terminal),
              "name            F\n"
              "─────────  ──────\n"
              "φ             1.5\n"
              "long name  10 ± 2\n"
              "\n"
              "  a note\n");
}

TEST(TextTable, markdown_is_written) {
    const TextTable table{{{"name", Align::left}, {"F"}}, {{"a|b", "1"}}, {"a note"}};
    EXPECT_EQ(to_text(table, TableFormat::markdown),
              "| name |   F |\n"
              "| :--- | --: |\n"
              "| a\\|b |   1 |\n"
              "\n"
              "- a note\n");
}

TEST(TextTable, cells_cannot_control_the_terminal_or_break_the_row) {
    const TextTable table{{{"n", Align::left}}, {{"a\x1b[31m\nb"}}, {}};
    EXPECT_THAT(to_text(table, TableFormat::terminal), HasSubstr("a [31m b\n"));
}

TEST(WithError, shows_only_known_errors) {
    EXPECT_EQ(with_error({0.43, 0.0123, 8}, 2), "0.43 ± 0.01");
    EXPECT_EQ(with_error({0.004, not_available, 1}, 2, 1e-3), "4.00");
    EXPECT_EQ(with_error({}, 2), "–");
    // small forces, as of emulsions
    EXPECT_EQ(with_error({0.0523, not_available, 1}, 2), "0.052");
    EXPECT_EQ(with_error({3.021e-8, 4.2e-10, 8}, 2), "3.02e-08 ± 4.2e-10");
    EXPECT_EQ(with_error({0.001, 0.22, 8}, 2), "0.00 ± 0.22");
    EXPECT_EQ(with_error({0, not_available, 1}, 2), "0.00");
}

TEST(TableOfModels, names_reference_stroke_and_failures) {
    auto run = synthetic::run({{.model = "independent", .top = 6.45}, {.model = "mc_dem"}}, 2);
    auto text = to_text(table_of_models(model_table(group_by_setting(run))), TableFormat::terminal);
    EXPECT_THAT(text, HasSubstr("top force at 30.00 mm [N]"));
    EXPECT_THAT(text, HasSubstr("over MC-DEM"));
    EXPECT_THAT(text, HasSubstr("0.430 ± 0.000"));
    EXPECT_THAT(text, Not(HasSubstr("stopped early")));
    run.recordings[0].failure = Failure{};
    run.recordings[0].scans.resize(3);
    text = to_text(table_of_models(model_table(group_by_setting(run))), TableFormat::terminal);
    EXPECT_THAT(text, HasSubstr("stopped early"));
}

TEST(TableOfModels, marks_settings_that_did_not_reach_full_stroke) {
    auto run = synthetic::run({{.model = "independent", .top = 6.45}, {.model = "mc_dem"}}, 1);
    run.recordings[1].failure = Failure{};
    run.recordings[1].scans.resize(6);
    const auto text = to_text(table_of_models(model_table(group_by_setting(run))), TableFormat::terminal);
    EXPECT_THAT(text, HasSubstr("top force at 30.00 mm [N]"));
    EXPECT_THAT(text, testing::ContainsRegex("MC-DEM +[0-9.]+ \\* at [0-9.]+ mm +1\\.000 +1 +1"));
    EXPECT_THAT(text, HasSubstr("*: no replica reached full stroke"));
}

TEST(TableOfModels, marks_scans_beyond_a_models_range) {
    auto run = synthetic::run({{.model = "elastic_sphere", .levels = 2}}, 1);
    EXPECT_THAT(to_text(table_of_models(model_table(group_by_setting(run))), TableFormat::terminal),
                Not(HasSubstr("tested")));
    run.recordings[0].scans[1].max_overlap = 0.15;
    EXPECT_THAT(to_text(table_of_models(model_table(group_by_setting(run))), TableFormat::terminal),
                HasSubstr("Elastic sphere: from 30.00 mm on, overlaps exceed the tested range of the contact "
                          "model (0.10 of the sum of two radii) and reach 0.15"));
}

TEST(CsvOfModels, has_a_column_for_each_key_that_differs) {
    auto run = synthetic::run({{.model = "mc_dem", .top = 12}}, 2);
    run.recordings[1].parameters["contact.gamma"] = "1.125";
    run.recordings[0].parameters["contact.gamma"] = "1";
    run.recordings[0].parameters["name"] = run.recordings[1].parameters["name"] = "\"same\"";
    const auto settings = group_by_setting(run);
    EXPECT_EQ(csv_of_models(model_table(settings), settings),
              "setting,contact.gamma,displacement_mm,top_force_N,standard_error_N,over,ratio,"
              "ratio_standard_error,replicas,stopped_early\n"
              "gamma=1,1,30,12,,gamma=1,1,,1,0\n"
              "gamma=1.125,1.125,30,12,,gamma=1,1,,1,0\n");
}

TEST(CsvOfModels, starts_no_formula) {
    auto run = synthetic::run({{.model = "mc_dem", .top = 12}}, 1);
    run.recordings[0].label = "=1+1, mc_dem";
    const auto settings = group_by_setting(run);
    EXPECT_NE(csv_of_models(model_table(settings), settings).find("\n\"'=1+1, mc_dem\","), std::string::npos);
}

TEST(TableOfComparisons, has_the_papers_columns_and_units) {
    Comparison c;
    c.setting = "mc_dem";
    c.Rtop = {1, 0.004, 32};
    c.errf = {0.41, 0.02, 32};
    c.errZ = {0.26, 0.01, 32};
    c.bhat = {0.0098, 0.0004, 32};
    c.tau = {4e-3, 1e-4, 32};
    c.levels_errf = 50;
    c.reference_levels = 60;
    const auto text = to_text(table_of_comparisons({c}), TableFormat::terminal);
    EXPECT_THAT(text, HasSubstr("Rtop"));
    EXPECT_THAT(
        text,
        HasSubstr(
            "MC-DEM       1.000 ± 0.004  0.41 ± 0.02  0.26 ± 0.01  0.98 ± 0.04  4.00 ± 0.10  50 of 60"));
}

TEST(TableOfComparisons, a_common_note_appears_once) {
    Comparison a, b;
    a.setting = "independent";
    b.setting = "mc_dem";
    a.notes = {"shared", "its own"};
    b.notes = {"shared"};
    const auto table = table_of_comparisons({a, b});
    const std::string meaning =
        "levels: displacements used for errf, in loading and unloading, of those of the reference";
    EXPECT_EQ(table.notes, (std::vector<std::string>{"shared", "Independent contacts: its own", meaning}));
}

TEST(TableOfScaling, has_one_row_per_phase) {
    const auto run = synthetic::run({{}}, 1);
    const auto table = table_of_scaling(group_by_setting(run));
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[1],
              (std::vector<std::string>{"MC-DEM", "unload", "150.0", "1.0000", "-0.000", "10"}));
}

}  // namespace
}  // namespace mcdem
