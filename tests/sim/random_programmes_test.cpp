// Random programmes on a packing that is represented by a spring: they end, time increases, and scans are at
// the prescribed positions, forces and times.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/driven_protocol.h"
#include "sim/random_draws.h"

namespace mcdem::random_programmes {
namespace {

constexpr double start = 0.1, end = 0.06, time_step = 1e-4, touching = 0.098;
constexpr double volume = 60 * std::numbers::pi / 6 * 8e-6, density = 11.5;
const PackingScale scale{.diameter = 0.02,
                         .count = 60,
                         .volume = volume,
                         .mass = volume * density,
                         .density = density,
                         .modulus = 23.3e3 / (1 - 0.5 * 0.5)};

/// Hertz contacts between the plate and a floor of grains, elastic and without inertia [N].
double spring_force(double plate_z) { return 500 * std::pow(std::max(0.0, touching - plate_z), 1.5); }

class RandomProgramme : RandomDraws {
public:
    using RandomDraws::RandomDraws;

    std::vector<Stage> draw() {
        std::vector<Stage> stages;
        for (int n = whole(1, 6); n > 0; --n) stages.push_back(stage(static_cast<int>(stages.size())));
        return stages;
    }

private:
    Stage stage(int number) {
        Stage stage;
        stage.kind = static_cast<StageKind>(whole(0, number > 0 ? 3 : 0));
        stage.scans = whole(0, 4);
        if (stage.kind == StageKind::repeat) {
            stage.stages = whole(1, number);
            return stage;
        }
        if (stage.kind == StageKind::hold) {
            stage.time = between(0.01, 0.3);
            stage.keep = forced_ && whole(0, 1) ? Controlled::force : Controlled::position;
            return stage;
        }
        forced_ = whole(0, 1);
        if (forced_) {
            stage.force = between(0.2, 2.5);
            stage.back = between(0.05, 0.2);
        } else if (whole(0, 1)) {
            stage.position = between(end, 0.09);
            stage.back = between(0.091, start);
        } else {
            stage.strain = between(0.1, 0.39);
            stage.back = between(0, 0.09);
        }
        stage.cycles = whole(1, 3);
        if (whole(0, 1)) stage.speed = between(0.01, 0.2);
        return stage;
    }
    bool forced_ = false;
};

/// Values of the leg's quantity at which scans are required.
void expect_scans(const Replica& replica, const std::vector<ProtocolRunner::ScanTag>& scans,
                  const std::vector<int>& leg_of) {
    const auto stages = stages_of(replica);
    const auto legs = legs_of(stages, replica.plate);
    ASSERT_EQ(static_cast<double>(scans.size()), scan_count(stages));
    std::vector<int> wanted(legs.size());
    for (std::size_t l = 0; l < legs.size(); ++l)
        wanted[l] = scans_of(stages[static_cast<std::size_t>(legs[l].stage)]);
    for (std::size_t l = 0, s = 0; l < legs.size(); ++l)
        for (int k = 0; k < wanted[l]; ++k, ++s) {
            ASSERT_EQ(leg_of[s], static_cast<int>(l));
            const Stage& stage = stages[static_cast<std::size_t>(legs[l].stage)];
            if (k + 1 < wanted[l] || stage.kind == StageKind::hold) continue;
            if (controlled(stage) == Controlled::position)
                EXPECT_EQ(scans[s].plate_z, legs[l].target);
            else
                EXPECT_NEAR(spring_force(scans[s].plate_z) / legs[l].target, 1, 1e-3);
        }
}

TEST(RandomProgrammes, EndAndScanAtThePrescribedValues) {
    int by_force = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        Replica replica;
        replica.box = {0.08, 0.08};
        replica.plate = {start, end, 0.1};
        replica.programme = RandomProgramme(seed).draw();
        if (leg_count(replica.programme) > 60) continue;
        ProtocolRunner runner(replica, time_step, scale);
        std::vector<ProtocolRunner::ScanTag> scans;
        std::vector<int> leg_of;
        double before = -1, highest = -1;
        drive(
            runner, time_step, 60,
            [](const IntervalEnd& end_of, IntervalResult& result) {
                ASSERT_GE(end_of.plate_z, end - 1e-12);
                ASSERT_LE(end_of.plate_z, start + 1e-12);
                set_force(result, spring_force(end_of.plate_z));
            },
            [&](const ProtocolState& state, const StepInterval&, const IntervalEnd&, const auto& scan) {
                if (scan) {
                    EXPECT_GT(scan->time, before);
                    before = scan->time;
                    EXPECT_EQ(scan->frame, static_cast<int>(scans.size()));
                    scans.push_back(*scan);
                    leg_of.push_back(state.leg);
                }
                EXPECT_GE(runner.progress(), highest - 0.1);
                highest = std::max(highest, runner.progress());
            });
        ASSERT_EQ(runner.hindrance(), "");
        EXPECT_EQ(highest, 1);
        expect_scans(replica, scans, leg_of);
        for (const Stage& stage : replica.programme) by_force += controlled(stage) == Controlled::force;
    }
    EXPECT_GT(by_force, 30);
}

}  // namespace
}  // namespace mcdem::random_programmes
