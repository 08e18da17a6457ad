#include <gmock/gmock.h>

#include <sstream>

#include "ensemble/diagnose_experiment.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

using testing::ElementsAre;

/// An experiment whose plate stands for `pause` at each scan, and a scene with these settings.
struct Compared {
    Replica replica;
    Experiment experiment;
};

Compared compared(double pause, std::optional<double> speed, const std::vector<std::string>& settings = {}) {
    Compared both{small_scene(settings).replicas.front(), {}};
    both.experiment.plate_speed = speed;
    both.experiment.plate_pause = pause;
    return both;
}

std::optional<NextStep> step_for(const Compared& both) {
    return simulate_pauses(both.replica, both.experiment);
}

/// The values of --set in the advice; nothing without advice.
std::vector<std::string> advised(const Compared& both) {
    const auto step = step_for(both);
    if (!step) return {};
    std::vector<std::string> settings;
    std::istringstream words(step->what);
    for (std::string word; words >> word;)
        if (word == "--set") words >> settings.emplace_back();
    return settings;
}

TEST(SimulatePauses, AtTheSpeedOfTheExperiment) {
    EXPECT_THAT(advised(compared(0.15, 0.01, {"protocol.relax_time=0.2"})),
                ElementsAre("protocol.stop_at_scans=true", "protocol.pause=0.15", "plate.speed=0.01"));
}

// In the blind test with pauses, gaps were claimed where the plate was faster than that of the scene.
TEST(SimulatePauses, AlsoAtTheSpeedOfAFasterExperiment) {
    EXPECT_THAT(advised(compared(0.01, 0.2, {"plate.speed=0.1"})),
                ElementsAre("protocol.stop_at_scans=true", "protocol.pause=0.01", "plate.speed=0.2"));
}

TEST(SimulatePauses, KeepsTheSpeedOfTheSceneIfThatOfTheExperimentIsTheSameOrUnknown) {
    EXPECT_THAT(advised(compared(0.01, 0.1, {"plate.speed=0.1"})),
                ElementsAre("protocol.stop_at_scans=true", "protocol.pause=0.01"));
    EXPECT_THAT(advised(compared(0.01, std::nullopt)),
                ElementsAre("protocol.stop_at_scans=true", "protocol.pause=0.01"));
}

TEST(SimulatePauses, NoLongerThanGrainsNeedToRest) {
    EXPECT_THAT(advised(compared(60, std::nullopt, {"protocol.relax_time=0.2"})),
                ElementsAre("protocol.stop_at_scans=true", "protocol.pause=0.2"));
    EXPECT_THAT(advised(compared(60, std::nullopt, {"protocol.relax_time=0"})),
                ElementsAre("protocol.stop_at_scans=true", "protocol.pause=60"));
}

TEST(SimulatePauses, NotIfTheExperimentOrTheSceneSaysOtherwise) {
    EXPECT_FALSE(step_for(compared(0, 0.01)));
    EXPECT_FALSE(step_for(compared(0.15, 0.01, {"protocol.stop_at_scans=true", "protocol.pause=0.1"})));
    Compared with_programme = compared(0.15, 0.01);
    with_programme.replica.programme.resize(1);
    EXPECT_FALSE(step_for(with_programme));
}

TEST(SimulatePauses, TheAdviceIsAValidScene) {
    const Compared both = compared(0.01, 0.02, {"protocol.stop_at_scans=false"});
    const Protocol followed = small_scene(advised(both)).replicas.front().protocol;
    EXPECT_TRUE(followed.stop_at_scans);
    EXPECT_EQ(followed.pause, 0.01);
}

}  // namespace
}  // namespace mcdem
