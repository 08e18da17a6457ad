// Figures of programmes: forces and displacements of a plate, stresses and strains of a cell.
#include <gmock/gmock.h>

#include "metrics/synthetic.h"
#include "report/run/figure_values.h"
#include "report/run/run_figures.h"
#include "report/run/run_page.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> figure_names(const std::vector<RunFigure>& figures) {
    std::vector<std::string> names;
    for (const RunFigure& figure : figures) names.push_back(figure.name);
    return names;
}

std::vector<RunFigure> figures_of(const std::vector<Setting>& settings) {
    static FigureData data;  // static, because figures refer to it
    data = figure_data(settings, std::nullopt, {});
    return programme_figures(data);
}

TEST(ProgrammeFigures, OfACellShowStressesAndStrains) {
    const Recording one = synthetic::cell("mc_dem"), two = synthetic::cell("mc_dem", 2, 3);
    const auto figures = figures_of({{"mc_dem", {&one, &two}}});
    EXPECT_THAT(figure_names(figures),
                ElementsAre("pressure_strain", "shear_stress_strain", "cell_coordination", "stress_path",
                            "pressure_time", "volume_time", "shear_stress_time", "shear_strain_time"));
    for (const RunFigure& figure : figures)
        for (const std::string& text : {figure.title, figure.x_label, figure.y_label}) {
            EXPECT_THAT(text, Not(HasSubstr("plate")));
            EXPECT_THAT(text, Not(HasSubstr("orce")));
        }
    EXPECT_EQ(figures[0].y_label, "mean stress p [kPa]");
    const auto& points = figures[0].series.at(0).curves.at(0).points;
    ASSERT_EQ(points.size(), 4u);
    const double gone = 1 - std::pow(0.98, 3);
    EXPECT_NEAR(points[1].x, 100 * gone, 1e-12);
    EXPECT_NEAR(points[1].y, 200 * gone, 1e-12);
    EXPECT_NEAR(points[1].error, 100 * gone, 1e-12);
    const auto& path = figures[3].series.at(0).curves.at(0).points;
    EXPECT_NEAR(path[2].y / path[2].x, 0.1 * std::sqrt(3), 1e-12);
}

TEST(ProgrammeFigures, OfACellWithoutShearAndHoldsAreTwo) {
    Recording plain = synthetic::cell("mc_dem");
    plain.scans.resize(2);
    plain.parameters.erase("programme.3.stage");
    EXPECT_THAT(figure_names(figures_of({{"mc_dem", {&plain}}})),
                ElementsAre("pressure_strain", "cell_coordination"));
}

TEST(ProgrammeFigures, OfAPlateHaveAStressPathIfStressesAreKnown) {
    Recording held = synthetic::recording({.levels = 2});
    held.parameters["programme.1.stage"] = "\"hold\"";
    EXPECT_THAT(figure_names(figures_of({{"held", {&held}}})),
                ElementsAre("force_time", "displacement_time", "force_displacement"));
    for (Scan& scan : held.scans) scan.stress = Vec3(1, 1, 3).asDiagonal();
    const auto figures = figures_of({{"held", {&held}}});
    EXPECT_EQ(figures.back().name, "stress_path");
    EXPECT_EQ(figures.back().y_label, "deviatoric stress q [Pa]");
}

TEST(ProgrammeCharts, AxesAreLabelled) {
    const Recording one = synthetic::cell("mc_dem");
    const auto made = run_charts({{"mc_dem", {&one}}}, std::nullopt);
    ASSERT_EQ(made.charts.size(), 8u);
    EXPECT_EQ(made.charts[0].title, "Mean stress against volume strain");
    EXPECT_THAT(made.charts[0].caption, HasSubstr("a third of the stress tensor's trace"));
    EXPECT_EQ(made.charts[0].log_axes, "y");
    EXPECT_EQ(made.charts[0].values["y_label"], "mean stress p [Pa]");
}

TEST(FigureFile, ContainsTheFiguresOfCells) {
    const Recording one = synthetic::cell("mc_dem");
    const auto data = figure_data({{"mc_dem", {&one}}}, std::nullopt, {});
    const auto values = figure_values(run_figures(data, {}), data);
    EXPECT_EQ(values["pressure_time"]["x_label"], "time [s]");
    EXPECT_EQ(values["pressure_time"]["series"][0]["curves"][0]["x"].size(), 4u);
}

}  // namespace
}  // namespace mcdem
