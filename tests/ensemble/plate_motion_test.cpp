#include "ensemble/diagnosis/plate_motion.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

/// An experiment whose plate has this motion, and a scene with these settings.
struct Compared {
    Replica replica;
    Experiment experiment;
};

Compared compared(std::optional<double> speed, double pause, double hold,
                  const std::vector<std::string>& settings = {}) {
    Compared both{small_scene(settings).replicas.front(), {}};
    both.experiment.plate_speed = speed;
    both.experiment.plate_pause = pause;
    both.experiment.plate_hold = hold;
    return both;
}

std::optional<PlateMotion> neglected(const Compared& both, double max_slowdown = 4) {
    return neglected_motion(both.replica, both.experiment, max_slowdown);
}

MATCHER_P3(Moves, speed, pause, hold, "") {
    return arg.has_value() && arg->speed == speed && arg->pause == pause && arg->hold == hold;
}

TEST(PlateMotion, IsThatOfTheExperiment) {
    EXPECT_THAT(neglected(compared(0.05, 0.01, 0.02, {"plate.speed=0.1"})), Moves(0.05, 0.01, 0.02));
    EXPECT_THAT(neglected(compared(0.05, 0, 0, {"plate.speed=0.1"})), Moves(0.05, 0.0, 0.0));
}

// In the blind test with pauses, gaps were claimed where the plate was faster than that of the scene.
TEST(PlateMotion, IsAlsoThatOfAFasterExperiment) {
    EXPECT_THAT(neglected(compared(0.2, 0.01, 0, {"plate.speed=0.1"})), Moves(0.2, 0.01, 0.0));
}

TEST(PlateMotion, IsNotSimulatedForASlowPlate) {
    EXPECT_FALSE(neglected(compared(std::nullopt, 0.01, 0.01)));
    EXPECT_FALSE(neglected(compared(0.024, 0.01, 0, {"plate.speed=0.1"})));
    EXPECT_THAT(neglected(compared(0.024, 0.01, 0, {"plate.speed=0.1"}), 5), Moves(0.024, 0.01, 0.0));
}

TEST(PlateMotion, StandsNoLongerThanGrainsNeedToRest) {
    EXPECT_THAT(neglected(compared(0.1, 60, 90, {"protocol.relax_time=0.2"})), Moves(0.1, 0.2, 0.2));
    EXPECT_THAT(neglected(compared(0.1, 60, 90, {"protocol.relax_time=0"})), Moves(0.1, 60.0, 90.0));
}

TEST(PlateMotion, OfTheSceneIsKept) {
    EXPECT_FALSE(neglected(compared(0.1, 0, 0, {"plate.speed=0.1", "protocol.rate_tolerance=0"})));
    EXPECT_THAT(neglected(compared(0.1, 0, 0, {"plate.speed=0.1", "protocol.rate_tolerance=0.01"})),
                Moves(0.1, 0.0, 0.0));
    EXPECT_FALSE(neglected(compared(0.1, 0.15, 0.25,
                                    {"plate.speed=0.1", "protocol.rate_tolerance=0", "protocol.hold=0.2",
                                     "protocol.stop_at_scans=true", "protocol.pause=0.1"})));
    Compared with_programme = compared(0.1, 0.15, 0.15);
    with_programme.replica.programme.resize(1);
    EXPECT_FALSE(neglected(with_programme));
}

/// Settings that make these changes.
std::vector<std::string> settings_of(const Replica& replica, const PlateMotion& motion) {
    std::vector<std::string> settings;
    if (motion.pause > 0) settings.push_back("protocol.stop_at_scans=true");
    for (const SettingChange& change : changes(replica, motion))
        settings.push_back(fmt::format("{}={}", change.key, change.to));
    return settings;
}

TEST(PlateMotion, ItsChangesAreSettingsThatMakeTheSameScene) {
    const std::vector<std::string> given{"protocol.stop_at_scans=false", "protocol.rate_tolerance=0.01"};
    for (const PlateMotion& motion : {PlateMotion{0.02, 0.01, 0.03}, PlateMotion{0.02, 0, 0.03}}) {
        Replica replica = small_scene(given).replicas.front();
        std::vector<std::string> settings = settings_of(replica, motion);
        settings.insert(settings.begin(), given.begin(), given.end());
        apply(replica, motion);
        const Replica set = small_scene(settings).replicas.front();
        for (const Replica* one : std::initializer_list<const Replica*>{&replica, &set}) {
            EXPECT_EQ(one->protocol.stop_at_scans, motion.pause > 0);
            EXPECT_EQ(one->protocol.pause, motion.pause);
            EXPECT_EQ(one->protocol.hold, 0.03);
            EXPECT_EQ(one->protocol.rate_tolerance, 0);
            EXPECT_EQ(one->plate.speed, 0.02);
        }
        EXPECT_THAT(changes(replica, motion), testing::IsEmpty());
    }
}

}  // namespace
}  // namespace mcdem
