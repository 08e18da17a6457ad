// Programmes of experiments: written from runs, read back, and refused if the rows are not their scans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/check_experiment.h"
#include "experiment/experiment_folder.h"
#include "experiment/instrument.h"
#include "experiment/measurements.h"
#include "scene/programme/programme_text.h"

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;

/// Down to 19 mm and a hold there, then up to 0.1 N and a hold there.
constexpr auto stages = R"([plate]
start = 0.022
[[programme]]
position = 0.019
[[programme]]
stage = "hold"
time = 2.0
scan_at = [0.5, 2.0]
[[programme]]
force = 0.1
[[programme]]
stage = "hold"
keep = "force"
time = 4
scans = 2
)";
constexpr auto rows = R"(frame,cycle,phase,plate_z_m,top_force_N,set_force_N,time_s
0,0,load,0.022,0,,0.1
1,0,load,0.019,0.4,,1.1
2,0,load,0.019,0.3,,1.6
3,0,load,0.019,0.25,,3.1
4,0,unload,0.021,0.1,0.1,4
5,0,unload,0.0209,0.1,0.1,6
6,0,unload,0.02085,0.1,0.1,8
)";

class Programmes : public ::testing::Test {
protected:
    Programmes() {
        folder["experiment.toml"] += stages;
        folder["plate.csv"] = rows;
    }
    ExperimentFolder folder;
};

TEST_F(Programmes, AreReadWithTheirTimes) {
    const Recording recording = folder.read().recording;
    const auto programme = programme_of(recording.parameters);
    ASSERT_EQ(programme.size(), 4u);
    EXPECT_EQ(programme[1].kind, StageKind::hold);
    EXPECT_EQ(programme[1].scan_at, (std::vector<double>{0.5, 2.0}));
    EXPECT_EQ(programme[3].keep, Controlled::force);
    EXPECT_EQ(recording.scans[3].time, 3.1);
}

TEST_F(Programmes, AreReadBackAsWritten) {
    folder["experiment.toml"] += "[[programme]]\nstage = \"repeat\"\nstages = 2\ntimes = 2\n";
    folder["plate.csv"] +=
        "7,0,unload,0.0211,0.1,0.1,9\n8,0,unload,0.0211,0.1,0.1,11\n9,0,unload,0.0211,0.1,0.1,13\n";
    const Experiment experiment = folder.read();
    ExperimentFolder other;
    write_experiment(other.path(), experiment);
    const Experiment back = read_experiment(other.path());
    EXPECT_EQ(back.recording.parameters, experiment.recording.parameters);
    for (std::size_t s = 0; s < experiment.recording.scans.size(); ++s)
        EXPECT_EQ(back.recording.scans[s].time, experiment.recording.scans[s].time);
}

TEST_F(Programmes, PositionsOfScansFollowFromTheStages) {
    const auto places = scan_places(programme_of(folder.read().recording.parameters), {0.022, 0});
    ASSERT_EQ(places.size(), 6u);
    EXPECT_EQ(places[0].set, 0.019);
    EXPECT_TRUE(places[0].at_end && !places[0].held);
    EXPECT_EQ(places[1].set, 0.019);
    EXPECT_EQ(places[1].time, 0.5);
    EXPECT_TRUE(places[2].at_end && places[2].held);
    EXPECT_EQ(places[3].by, Controlled::force);
    EXPECT_EQ(places[5].set, 0.1);
    EXPECT_EQ(places[5].time, 4);
}

TEST_F(Programmes, TimesAreRequiredAndMustIncrease) {
    folder.replace("plate.csv", ",time_s", ",t");
    EXPECT_THAT(folder.error(), HasSubstr("plate.csv:1: the header must name time_s where experiment.toml"));
    folder["plate.csv"] = rows;
    folder.replace("plate.csv", "0.3,,1.6", "0.3,,1.1");
    EXPECT_THAT(folder.error(),
                HasSubstr("plate.csv:4: time_s must rise from row to row, got 1.1 after 1.1"));
}

TEST_F(Programmes, RowsMustBeTheScansOfTheStages) {
    folder.replace("plate.csv", "6,0,unload,0.02085,0.1,0.1,8\n", "");
    EXPECT_THAT(folder.error(), HasSubstr("plate.csv: must have 7 rows, one of the packing at rest and one "
                                          "for each of the 6 scans of [[programme]]"));
    const std::pair<const char*, const char*> spoilt[] = {{"load,0.019,0.3", "load,0.0215,0.3"},
                                                          {"0.3,,1.6", "0.3,0.3,1.6"},
                                                          {"0.25,,3.1", "0.25,,2.6"},
                                                          {"0.1,0.1,4", "0.1,0.2,4"},
                                                          {"unload,0.021,0.1", "unload,0.021,0.3"}};
    const char* const messages[] = {
        "plate.csv:4: plate_z_m must be near 0.019 m, which stage 2 of [[programme]]",
        "plate.csv:4: set_force_N must be empty, got 0.3: stage 2 of",
        "plate.csv:5: time_s must be 1.5 s after the row before, as stage 2 of",
        "plate.csv:6: set_force_N must be 0.1 N, which stage 3 of",
        "plate.csv:6: top_force_N must be near 0.1 N, which stage 3 of"};
    for (std::size_t k = 0; k < std::size(spoilt); ++k) {
        folder["plate.csv"] = rows;
        folder.replace("plate.csv", spoilt[k].first, spoilt[k].second);
        EXPECT_THAT(folder.error(), HasSubstr(messages[k]));
    }
}

TEST_F(Programmes, StagesAreCheckedAsInAScene) {
    folder.replace("experiment.toml", "keep = \"force\"", "kept = \"force\"");
    EXPECT_THAT(folder.error(), HasSubstr(": programme.4.kept must be a key of a stage, got an unknown one"));
    folder.replace("experiment.toml", "kept = \"force\"", "keep = \"stress\"");
    EXPECT_THAT(folder.error(), HasSubstr(": programme.4.keep must be position or force in a hold of the "
                                          "plate, got stress"));
    folder.replace("experiment.toml", "keep = \"stress\"", "keep = 3");
    EXPECT_THAT(folder.error(),
                HasSubstr(": programme.4.keep must be one of position, force, stress, got 3"));
    folder.replace("experiment.toml", "keep = 3", "keep = \"force\"");
    folder.replace("experiment.toml", "start = 0.022\n", "");
    EXPECT_THAT(folder.error(), HasSubstr("[[programme]] requires plate.start"));
}

TEST_F(Programmes, AreDescribedAndMayCreep) {
    folder.replace("plate.csv", "unload,0.02085", "unload,0.0208");
    const ExperimentCheck check = check_experiment(folder.read());
    EXPECT_THAT(check.of(Severity::note),
                ::testing::Contains("a programme of 4 stages in 7.9 s; position held for 2 s, which shows "
                                    "relaxation; force held for 4 s, which shows creep"));
    for (const std::string& odd : check.of(Severity::odd)) EXPECT_EQ(odd.find("against its phase"), odd.npos);
}

TEST_F(Programmes, ASimulationHasItsOwnFromTheStart) {
    Recording truth = folder.read().recording;
    const Recording seen = experiment_from(truth, {}, 1).recording;
    EXPECT_EQ(seen.scans[2].time, 1.6);
    EXPECT_EQ(set_forces(seen)[5], 0.1);
    EXPECT_EQ(set_forces(seen)[2], std::nullopt);
    std::erase_if(truth.parameters, [](const auto& one) { return one.first.starts_with("programme."); });
    EXPECT_TRUE(std::isnan(experiment_from(truth, {}, 1).recording.scans[2].time));
}

}  // namespace
}  // namespace mcdem::test
