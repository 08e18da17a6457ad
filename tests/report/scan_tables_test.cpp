#include <gmock/gmock.h>

#include "core/errors.h"
#include "metrics/synthetic.h"
#include "report/page/labels.h"
#include "report/run/tables.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Recording held_plate() {
    Recording made = synthetic::recording({.levels = 2});
    made.parameters["programme.1.stage"] = "\"hold\"";
    return made;
}

std::vector<std::string> titles(const TextTable& table) {
    std::vector<std::string> titles;
    for (const auto& column : table.columns) titles.push_back(column.title);
    return titles;
}

TEST(TablesOfScans, OfCellsContainStrainsAndStressesInsteadOfAPlate) {
    const Recording one = synthetic::cell("mc_dem"), two = synthetic::cell("mc_dem", 2, 3);
    const auto tables = tables_of_scans({{"mc_dem", {&one, &two}}});
    ASSERT_EQ(tables.size(), 1u);
    EXPECT_THAT(titles(tables[0]), ElementsAre("model", "scan", "phase", "time [s]", "strain [%]",
                                               "shear xz [%]", "φ", "p [kPa]", "q [kPa]", "Z"));
    EXPECT_THAT(tables[0].rows[2],
                ElementsAre("MC-DEM", "2", "load", "2.500", "2.00 ± 0.00", "10.00 ± 0.00", "0.6200 ± 0.0000",
                            "11.76 ± 5.88", "2.04 ± 1.02", "6.00 ± 0.00"));
    const auto text = to_text(tables[0], TableFormat::terminal);
    EXPECT_THAT(text, Not(HasSubstr("plate")));
    EXPECT_THAT(text, Not(HasSubstr("force")));
    EXPECT_THAT(
        text,
        HasSubstr(
            "error of stresses by the strain rate: at most 0.4 % in the mean over packings (estimate)"));
}

TEST(TablesOfScans, HaveThreeStrainsIfTheyDiffer) {
    Recording one = synthetic::cell("mc_dem");
    one.scans[1].strain[2] = 0.05;
    EXPECT_THAT(titles(tables_of_scans({{"mc_dem", {&one}}})[0]),
                ElementsAre("model", "scan", "phase", "time [s]", "strain x [%]", "strain y [%]",
                            "strain z [%]", "shear xz [%]", "φ", "p [Pa]", "q [Pa]", "Z"));
}

TEST(TablesOfScans, AreSeparateForPlatesAndCells) {
    const Recording plate = held_plate(), cell = synthetic::cell("mc_dem");
    const auto tables = tables_of_scans({{"cell", {&cell}}, {"plate", {&plate}}});
    ASSERT_EQ(tables.size(), 2u);
    EXPECT_THAT(titles(tables[0]),
                ElementsAre("model", "scan", "phase", "time [s]", "displacement [mm]", "top force [N]", "Z"));
    EXPECT_EQ(tables[0].rows.size(), 4u);
    EXPECT_THROW(csv_of_scans({{"cell", {&cell}}, {"plate", {&plate}}}), InputError);
}

TEST(TablesOfScans, MarkReplicasThatStoppedEarlyAndScansBeyondAModelsRange) {
    const Recording whole = synthetic::cell("elastic_sphere", 1);
    Recording broken = synthetic::cell("elastic_sphere", 2);
    broken.scans.resize(3);
    broken.scans[1].max_overlap = 0.12;
    broken.scans[2].max_overlap = 0.14;
    broken.failure = Failure{100, 3, "it ran away"};
    const auto table = tables_of_scans({{"elastic_sphere", {&whole, &broken}}})[0];
    EXPECT_EQ(table.columns.back().title, "replicas");
    EXPECT_EQ(table.rows[2].back(), "2");
    EXPECT_EQ(table.rows[3].back(), "1");
    EXPECT_THAT(
        table.notes,
        testing::Contains("Elastic sphere: 1 of 2 stopped early, the first after 3 scans: it ran away"));
    EXPECT_THAT(table.notes,
                testing::Contains(HasSubstr(
                    "Elastic sphere: from scan 1 on, overlaps exceed the tested range of the contact model "
                    "(0.10 of the sum of two radii) and reach 0.14")));
}

TEST(CsvOfScans, HasAllStrainsInSiUnitsAndTheKeysThatVary) {
    Recording one = synthetic::cell("mc_dem"), other = synthetic::cell("independent");
    for (Recording* recording : {&one, &other}) recording->scans.resize(1);
    const std::string text = csv_of_scans({{"mc_dem", {&one}}, {"independent", {&other}}});
    EXPECT_THAT(text, testing::StartsWith("setting,contact.model,frame,cycle,phase,time_s,strain_x,strain_x_"
                                          "standard_error,strain_y,"));
    EXPECT_THAT(text, HasSubstr(",p_Pa,p_Pa_standard_error,q_Pa,q_Pa_standard_error,coordination_number,"
                                "coordination_number_standard_error,replicas\n"
                                "mc_dem,mc_dem,0,0,load,0.5,0.01,,0.01,,0.01,,0,,0,,0,,0.61,,"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST(StressUnit, GivesFewDigitsBeforeThePoint) {
    EXPECT_STREQ(stress_unit(9999).name, "Pa");
    EXPECT_STREQ(stress_unit(10000).name, "kPa");
    EXPECT_EQ(stress_unit(1e7).size, 1e6);
}

}  // namespace
}  // namespace mcdem
