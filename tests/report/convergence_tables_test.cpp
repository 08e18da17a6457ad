// Table, text, JSON and figure of a convergence study contain the same numbers.
#include "report/run/convergence_tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mcdem {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two causes: the first makes the top force 2 % too large while loading at 10 mm; everything else is within
/// limits.
Convergence example() {
    const Grid grid{{0.01, 0.02}, 0.002, 0.02};
    Convergence c;
    c.scene = "example";
    c.copies = "jittered copies of one packing";
    c.cells = cells_of(grid);
    c.replicas = 32;
    const auto count = static_cast<Eigen::Index>(c.cells.size());
    c.mean = Eigen::VectorXd::Constant(count, 1);
    c.deviation = Eigen::VectorXd::Constant(count, 0.1);
    c.causes = {{"plate speed", "plate.speed = 0.1 / {0:.2g}",
                 std::vector<CellError>(c.cells.size(), {0.001, 0.0005})},
                {"list margin", "", std::vector<CellError>(c.cells.size(), {-0.0005, 0.0005})}};
    c.causes[0].cells[0] = {0.02, 0.002};
    return c;
}

TEST(ConvergenceTables, TextNamesCauseSizeSignPositionAndRemedy) {
    const auto words = words_of_convergence(example());
    ASSERT_EQ(words.size(), 3u);
    EXPECT_EQ(words[0], "Not converged.");
    EXPECT_EQ(words[1],
              "plate speed: top_force is 2 +- 0.2 % too high at 10.0 mm of loading; within the limit with "
              "plate.speed = 0.1 / 4");
    EXPECT_EQ(words[2], "list margin: no error beyond its limit");
}

TEST(ConvergenceTables, TextSaysConvergedIfNothingExceedsItsLimit) {
    Convergence c = example();
    c.causes[0].cells[0] = {0.004, 0.0001};
    EXPECT_EQ(words_of_convergence(c)[0], "Converged: no error is beyond its limit.");
    EXPECT_THAT(to_text(table_of_convergence(c), TableFormat::terminal), Not(HasSubstr(" % *")));
}

TEST(ConvergenceTables, TextSaysNotDecidedIfErrorsAreTooUncertain) {
    Convergence c = example();
    c.causes[0].cells[0] = {0.004, 0.02};
    const auto words = words_of_convergence(c);
    EXPECT_THAT(words[0],
                HasSubstr("Not decided: no error is beyond its limit, but more replicas are needed"));
    EXPECT_EQ(words[1], fmt::format("plate speed: no error beyond its limit, but 1 of {} values have "
                                    "standard errors that are too large to tell; use more --replicas",
                                    c.cells.size()));
}

TEST(ConvergenceTables, TextSaysIfACauseChangesNothing) {
    Convergence c = example();
    c.causes[1].cells.assign(c.cells.size(), {0, 0});
    EXPECT_EQ(words_of_convergence(c)[2], "list margin: no influence in these runs");
}

TEST(ConvergenceTables, TableMarksErrorsBeyondTheirLimit) {
    const std::string text = to_text(table_of_convergence(example()), TableFormat::terminal);
    EXPECT_THAT(text, HasSubstr("+2.00 +- 0.20 % *"));
    EXPECT_THAT(text, HasSubstr("+0.01 +- 0.01 sd"));
    EXPECT_THAT(text, HasSubstr("32 jittered copies of one packing"));
}

TEST(ConvergenceTables, JsonContainsEveryError) {
    const auto json = nlohmann::json::parse(convergence_json(example()));
    EXPECT_EQ(json["causes"].size(), 2u);
    EXPECT_EQ(json["causes"][0]["errors"].size(), example().cells.size());
    EXPECT_EQ(json["causes"][0]["errors"][0]["error"], 0.02);
    EXPECT_EQ(json["causes"][0]["errors"][0]["beyond"], true);
    EXPECT_EQ(json["causes"][1]["errors"][0]["beyond"], false);
}

TEST(ConvergenceTables, FigureHasARowPerObservableAndASeriesPerCause) {
    const auto values = convergence_figure_values(example());
    EXPECT_EQ(values["rows"].size(), observables().size());
    EXPECT_EQ(values["causes"][0]["words"], "plate speed");
    EXPECT_EQ(values["rows"][0]["words"], "top force");
    EXPECT_NEAR(values["rows"][0]["errors"][0]["over_limit"].get<double>(), 4, 1e-12);  // 2 % over 0.5 %
    EXPECT_NEAR(values["rows"][0]["errors"][0]["standard_error"].get<double>(), 0.4, 1e-12);
}

}  // namespace
}  // namespace mcdem
