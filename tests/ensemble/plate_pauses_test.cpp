#include "ensemble/plate_pauses.h"

#include <gmock/gmock.h>

#include <sstream>

#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

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

std::optional<PlatePauses> neglected(const Compared& both, double max_slowdown = 4) {
    return neglected_pauses(both.replica, both.experiment, max_slowdown);
}

MATCHER_P2(PauseAt, time, speed, "") { return arg.has_value() && arg->time == time && arg->speed == speed; }

TEST(PlatePauses, AreTakenAtTheSpeedOfTheExperiment) {
    EXPECT_THAT(neglected(compared(0.01, 0.05, {"plate.speed=0.1"})), PauseAt(0.01, 0.05));
}

// In the blind test with pauses, gaps were claimed where the plate was faster than that of the scene.
TEST(PlatePauses, AreAlsoTakenAtTheSpeedOfAFasterExperiment) {
    EXPECT_THAT(neglected(compared(0.01, 0.2, {"plate.speed=0.1"})), PauseAt(0.01, 0.2));
}

TEST(PlatePauses, AreNotSimulatedForASlowPlate) {
    EXPECT_FALSE(neglected(compared(0.01, std::nullopt)));
    EXPECT_FALSE(neglected(compared(0.01, 0.024, {"plate.speed=0.1"})));
    EXPECT_THAT(neglected(compared(0.01, 0.024, {"plate.speed=0.1"}), 5), PauseAt(0.01, 0.024));
}

TEST(PlatePauses, AreNoLongerThanGrainsNeedToRest) {
    EXPECT_THAT(neglected(compared(60, 0.1, {"protocol.relax_time=0.2"})), PauseAt(0.2, 0.1));
    EXPECT_THAT(neglected(compared(60, 0.1, {"protocol.relax_time=0"})), PauseAt(60, 0.1));
}

TEST(PlatePauses, AreNoneIfTheExperimentOrTheSceneSaysOtherwise) {
    EXPECT_FALSE(neglected(compared(0, 0.1)));
    EXPECT_FALSE(neglected(compared(0.15, 0.1, {"protocol.stop_at_scans=true", "protocol.pause=0.1"})));
    Compared with_programme = compared(0.15, 0.1);
    with_programme.replica.programme.resize(1);
    EXPECT_FALSE(neglected(with_programme));
}

/// The values of --set in the advice.
std::vector<std::string> advised(const PlatePauses& pauses) {
    std::vector<std::string> settings;
    std::istringstream words(simulate_pauses(pauses).what);
    for (std::string word; words >> word;)
        if (word == "--set") words >> settings.emplace_back();
    return settings;
}

TEST(PlatePauses, TheAdviceMakesTheSameScene) {
    const PlatePauses pauses{0.01, 0.02};
    Replica replica = small_scene({"protocol.stop_at_scans=false"}).replicas.front();
    apply(replica, pauses);
    const Replica advice = small_scene(advised(pauses)).replicas.front();
    for (const Replica* one : std::initializer_list<const Replica*>{&replica, &advice}) {
        EXPECT_TRUE(one->protocol.stop_at_scans);
        EXPECT_EQ(one->protocol.pause, 0.01);
        EXPECT_EQ(one->plate.speed, 0.02);
    }
}

}  // namespace
}  // namespace mcdem
