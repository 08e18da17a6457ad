#include "report/figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "core/errors.h"
#include "metrics/synthetic.h"
#include "report/figure_parts.h"
#include "report/folder.h"

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename());
    return names;
}

std::vector<std::string> lines_with(const std::string& text, const std::string& part) {
    std::vector<std::string> found;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        if (line.find(part) != std::string::npos) found.push_back(line);
    return found;
}

Run two_models(int replicas, int contacts = 300) {
    return synthetic::run({{.model = "independent", .top = 6, .contacts = contacts},
                           {.model = "mc_dem", .top = 15, .contacts = contacts}},
                          replicas);
}

TEST(DrawFigures, leaves_pictures_with_their_data_and_scripts_and_nothing_else) {
    const TestFolder folder;
    const auto run = two_models(3);
    const auto measured = synthetic::recording({.seed = 50, .contacts = 300});
    const auto drawn = draw_figures(group_by_setting(run), Setting{"experiment", {&measured}}, folder.path);
    EXPECT_EQ(drawn.pictures.size(), 8u);
    EXPECT_TRUE(drawn.notes.empty());
    std::set<std::string> expected;
    for (const char* name : {"top_force", "force_distribution", "coordination", "scaling"})
        for (const char* ending : {".png", ".svg", ".csv", ".gp"})
            expected.insert(std::string(name) + ending);
    EXPECT_EQ(names_in(folder.path), expected);
    for (const auto& picture : drawn.pictures) {
        const auto content = text_of(picture);
        EXPECT_GT(content.size(), 5000u) << picture;
        EXPECT_THAT(content.substr(0, 8), picture.extension() == ".png" ? std::string("\x89PNG\r\n\x1a\n")
                                                                        : std::string("<?xml ve"));
    }
}

TEST(DrawFigures, without_contacts_or_averages_tells_what_is_missing) {
    const TestFolder folder;
    auto run = two_models(1, 0);
    for (auto& recording : run.recordings)
        for (auto& scan : recording.scans)
            scan.coordination_number = scan.mean_force = scan.packing_fraction = scan.branch_length =
                not_available;
    const auto drawn = draw_figures(group_by_setting(run), std::nullopt, folder.path);
    EXPECT_EQ(drawn.pictures.size(), 2u);
    EXPECT_EQ(drawn.notes.size(), 3u);
}

TEST(DrawFigures, labels_from_files_are_shown_and_never_run) {
    const TestFolder folder;
    auto run = two_models(1);
    const std::string hostile = "`touch pwned1` '; system('touch pwned2') \\ <b>&\n! touch pwned3";
    std::vector<Setting> settings{{hostile, replicas_of(run.recordings)}};
    draw_figures(settings, std::nullopt, folder.path);
    for (const auto& name : names_in(folder.path)) EXPECT_THAT(name, Not(HasSubstr("pwned")));
    for (const auto& name : names_in(std::filesystem::current_path()))
        EXPECT_THAT(name, Not(HasSubstr("pwned")));
    const auto svg = text_of(folder.path / "top_force.svg");
    EXPECT_THAT(svg, HasSubstr("touch pwned1"));
    EXPECT_THAT(svg, Not(HasSubstr("<b>")));
}

TEST(DrawFigures, needs_a_folder) {
    const auto run = two_models(1);
    EXPECT_THROW(draw_figures(group_by_setting(run), std::nullopt, "/nonexistent/folder"), RunError);
}

TEST(TopForceFigure, data_are_the_level_means) {
    const auto run = two_models(1);
    const auto figure = top_force_figure(cast_of(group_by_setting(run), std::nullopt, {}));
    const auto lines = lines_with(figure.data, ",load,mc_dem");
    ASSERT_EQ(lines.size(), 11u);  // ten levels, and the turning point once more to open unloading
    EXPECT_EQ(lines[9], "30,15,,load,mc_dem");
    EXPECT_EQ(lines[10], "30,15,,load,mc_dem");
    EXPECT_EQ(lines_with(figure.data, ",unload,mc_dem").size(), 10u);
    EXPECT_EQ(figure.data.substr(0, figure.data.find('\n')),
              "displacement_mm,top_force_N,standard_error_N,phase,setting");
}

TEST(TopForceFigure, bands_only_with_replicas) {
    const auto one = two_models(1), four = two_models(4);
    EXPECT_THAT(top_force_figure(cast_of(group_by_setting(one), {}, {})).script,
                Not(HasSubstr("filledcurves")));
    EXPECT_THAT(top_force_figure(cast_of(group_by_setting(four), {}, {})).script, HasSubstr("filledcurves"));
}

TEST(DistributionFigure, shows_the_level_nearest_to_what_was_asked) {
    const auto run = two_models(1);
    const auto cast = cast_of(group_by_setting(run), std::nullopt, {});
    EXPECT_THAT(distribution_figure(cast, {})->script, HasSubstr("'Contact forces at 18.0 mm, unloading'"));
    const FigureOptions other{
        .compare = {}, .distribution_phase = Phase::load, .distribution_displacement = 50e-3};
    EXPECT_THAT(distribution_figure(cast, other)->script, HasSubstr("'Contact forces at 30.0 mm, loading'"));
}

TEST(DistributionFigure, density_integrates_to_nearly_one) {
    const auto run = synthetic::run({{.contacts = 5000}}, 1);
    const auto figure = distribution_figure(cast_of(group_by_setting(run), std::nullopt, {}), {});
    double sum = 0, first = 0, width = 0;
    for (const auto& line : lines_with(figure->data, ",unload,")) {
        double force, density;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf", &force, &density), 2);
        if (first == 0) first = force, width = 2 * force;
        sum += density * width;
    }
    EXPECT_NEAR(sum, 1, 0.01);  // all but a thousandth of the contacts
}

TEST(CoordinationFigure, thresholds_each_setting_at_its_own_tau) {
    const auto run = synthetic::run({{.contacts = 2000}}, 1);
    auto measured = run.recordings[0];
    for (auto& scan : measured.scans)
        std::erase_if(scan.contacts, [](const Contact& c) { return c.force.norm() < 4e-3; });
    const FigureOptions options;
    const auto cast = cast_of(group_by_setting(run), Setting{"experiment", {&measured}}, options);
    const auto figure = coordination_figure(cast, options);
    EXPECT_THAT(figure->script, HasSubstr("'MC-DEM, tau 4.00 mN'"));
    const auto simulated = lines_with(figure->data, ",unload,mc_dem"),
               real = lines_with(figure->data, ",unload,exp");
    ASSERT_EQ(simulated.size(), real.size());
    EXPECT_EQ(simulated[4].substr(0, simulated[4].find(",,")), real[4].substr(0, real[4].find(",,")));
}

TEST(ScalingFigure, tells_the_slope) {
    const auto run = two_models(1);
    const auto figure = scaling_figure(cast_of(group_by_setting(run), std::nullopt, {}));
    EXPECT_THAT(figure->script, HasSubstr("'MC-DEM, 150 /m'"));
}

TEST(Styles, a_model_keeps_its_colour_and_settings_differ) {
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
