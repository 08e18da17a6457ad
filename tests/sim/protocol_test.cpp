// The protocol on its own, with artificial results: where it scans, in which order, and when it considers a
// packing at rest.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/driven_protocol.h"

namespace mcdem {
namespace {

constexpr double time_step = 1e-3;
const PackingScale scale{.diameter = 0.02, .count = 100, .density = GrainMaterial{}.density};

Replica replica_of(int cycles, int scans, bool stop_at_scans) {
    Replica replica;
    replica.plate = {0.2, 0.1, 0.5};
    replica.protocol.cycles = cycles;
    replica.protocol.scans_per_stroke = scans;
    replica.protocol.stop_at_scans = stop_at_scans;
    replica.protocol.rate_tolerance = 0;
    replica.protocol.settle_time = 0.05;
    replica.protocol.relax_time = 0.08;
    return replica;
}

/// Results of a packing with this kinetic energy.
IntervalResult answer(int steps, double kinetic) {
    IntervalResult result;
    result.steps = steps;
    result.kinetic_energy = kinetic;
    result.elastic_energy = 1;
    return result;
}

/// Runs a whole protocol and stores its intervals and scans.
struct Course {
    std::vector<ProtocolRunner::ScanTag> scans;
    std::vector<StepInterval> intervals;
    std::vector<double> progress;
    long steps = 0;
    Course(const Replica& replica, double kinetic, int longest = 60) { run(replica, kinetic, longest); }

private:
    void run(const Replica& replica, double kinetic, int longest) {
        ProtocolRunner runner(replica, time_step, scale);
        drive(
            runner, time_step, longest,
            [&](const IntervalEnd&, IntervalResult& result) { result.kinetic_energy = kinetic; },
            [&](const ProtocolState&, const StepInterval& interval, const IntervalEnd&, const auto& scan) {
                intervals.push_back(interval);
                steps += interval.steps;
                if (scan) scans.push_back(*scan);
                progress.push_back(runner.progress());
            });
    }
};

TEST(Protocol, ScansAtEveryLevelLoadingAndUnloading) {
    for (bool stops : {true, false}) {
        const Course course(replica_of(2, 4, stops), 0, 10);
        ASSERT_EQ(course.scans.size(), 16u);
        for (int k = 0; k < 16; ++k) {
            const auto& scan = course.scans[k];
            const int level = k % 4 + 1;
            EXPECT_EQ(scan.frame, k);
            EXPECT_EQ(scan.cycle, k / 8);
            EXPECT_EQ(scan.phase, k / 4 % 2 ? Phase::unload : Phase::load);
            EXPECT_NEAR(scan.plate_z, k / 4 % 2 ? 0.1 + 0.025 * level : 0.2 - 0.025 * level, 1e-15);
            EXPECT_EQ(scan.settled, stops);
        }
        EXPECT_NEAR(course.scans.back().time, course.steps * time_step, 1e-12);
    }
}

TEST(Protocol, RelaxedPackingIsScannedFirstIfRequested) {
    for (double kinetic : {0.0, 1.0}) {
        Replica replica = replica_of(2, 3, true);
        const Course without(replica, kinetic);
        replica.protocol.scan_at_start = true;
        const Course with(replica, kinetic);
        ASSERT_EQ(with.scans.size(), without.scans.size() + 1);
        const auto& first = with.scans.front();
        EXPECT_EQ(first.frame, 0);
        EXPECT_EQ(first.cycle, 0);
        EXPECT_EQ(first.phase, Phase::load);
        EXPECT_EQ(first.plate_z, 0.2);
        EXPECT_EQ(first.settled, kinetic == 0);
        EXPECT_NEAR(first.time, 0.08, 1e-12);
        for (std::size_t k = 0; k < without.scans.size(); ++k) {
            EXPECT_EQ(with.scans[k + 1].frame, without.scans[k].frame + 1);
            EXPECT_EQ(with.scans[k + 1].plate_z, without.scans[k].plate_z);
            EXPECT_EQ(with.scans[k + 1].time, without.scans[k].time);
        }
        EXPECT_TRUE(std::is_sorted(with.progress.begin(), with.progress.end()));
        EXPECT_EQ(with.progress.back(), 1);
    }
}

// 25 mm at 0.5 m/s are 50 steps; each interval starts at the plate position where the previous one ended.
TEST(Protocol, MovesAtTheGivenSpeedWithoutJumps) {
    const Course course(replica_of(1, 4, true), 0, 7);
    double plate = 0.2;
    int moving = 0;
    for (const StepInterval& interval : course.intervals) {
        EXPECT_NEAR(interval.plate_z, plate, 1e-12);
        plate += interval.plate_velocity * interval.steps * interval.step_part * time_step;
        moving += interval.plate_velocity != 0 ? interval.steps : 0;
        EXPECT_NEAR(std::abs(interval.plate_velocity), interval.plate_velocity != 0 ? 0.5 : 0, 1e-9);
        EXPECT_EQ(interval.settle_drag > 0, interval.plate_velocity == 0)
            << "drag while the plate stands still";
    }
    EXPECT_EQ(moving, 2 * 4 * 50);
    EXPECT_NEAR(plate, 0.2, 1e-12);
}

// 25 mm between scans take 50 steps, as at a constant speed of 0.5 m/s. The plate stands for the whole pause,
// without drag, also when the packing is at rest.
TEST(Protocol, StartsAndStopsSmoothlyForAPauseAndLeavesThePackingAlone) {
    Replica replica = replica_of(1, 4, true);
    replica.protocol.pause = 0.12;
    const Course course(replica, 0, 7);
    ASSERT_EQ(course.scans.size(), 8u);
    double plate = 0.2, standing = 0;
    int moving = 0;
    for (const StepInterval& interval : course.intervals) {
        EXPECT_NEAR(interval.plate_z, plate, 1e-12);
        plate += interval.plate_velocity * interval.steps * interval.step_part * time_step;
        if (interval.plate_velocity == 0 && moving == 0) continue;  // relaxes at first
        if (interval.plate_velocity == 0) {
            standing += interval.steps * time_step;
            EXPECT_EQ(interval.settle_drag, 0);
            continue;
        }
        const double middle = std::numbers::pi * (moving % 50 + interval.steps / 2.0) / 50;
        EXPECT_NEAR(std::abs(interval.plate_velocity), 0.5 * std::numbers::pi / 2 * std::sin(middle), 1e-3);
        moving += interval.steps;
    }
    EXPECT_EQ(moving, 8 * 50);
    EXPECT_NEAR(plate, 0.2, 1e-12);
    replica.protocol.stop_at_scans = false;
    for (const StepInterval& interval : Course(replica, 0, 7).intervals)
        EXPECT_TRUE(interval.plate_velocity == 0 || std::abs(interval.plate_velocity) > 0.499) << "no stop";
    EXPECT_NEAR(standing, 8 * 0.12, 1e-9);
    for (int k = 0; k < 8; ++k)
        EXPECT_NEAR(course.scans[k].plate_z, k < 4 ? 0.175 - 0.025 * k : 0.125 + 0.025 * (k - 4), 1e-12);
}

TEST(Protocol, HoldsThePlateAfterEachStrokeDown) {
    for (const bool stops : {false, true}) {
        Replica replica = replica_of(2, 4, stops);
        const Course without(replica, 0);
        replica.protocol.hold = 0.3;
        const Course with(replica, 0);
        ASSERT_EQ(with.scans.size(), 16u);
        int undamped = 0;
        for (const StepInterval& interval : with.intervals)
            if (interval.plate_velocity == 0 && interval.settle_drag == 0) {
                EXPECT_NEAR(interval.plate_z, 0.1, 1e-12);
                undamped += interval.steps;
            }
        EXPECT_EQ(undamped, 2 * 300);
        const double longer = stops ? 0.3 - 0.05 : 0.3;  // the hold replaces the settling
        for (int k = 0; k < 16; ++k) {
            const int holds = (k + 5) / 8;  // the scans at the lowest position, 3 and 11, are taken after it
            EXPECT_NEAR(with.scans[k].time, without.scans[k].time + holds * longer, 1e-9) << k;
            EXPECT_NEAR(with.scans[k].plate_z, without.scans[k].plate_z, 1e-12) << k;
        }
    }
}

/// A plate whose force increases as it moves down.
struct Pressed {
    explicit Pressed(double tolerance) {
        replica.protocol.rate_tolerance = tolerance;
        replica.plate.speed = 100;
        ProtocolRunner runner(replica, time_step, scale);
        while (runner.state().phase == Phase::load) {
            const StepInterval interval = runner.next([](const StepInterval&) { return 5; });
            IntervalResult result = answer(interval.steps, 0);
            const double force = 2e4 * std::max(0.0, 0.19 - interval.plate_z);
            result.wall_force[static_cast<int>(Wall::plate)] = {0, 0, force};
            result.wall_force[static_cast<int>(Wall::floor)] = {0, 0, -force};
            const double last = runner.state().pressure;
            if (const auto scan = runner.on_interval_done(result)) scans.push_back(*scan);
            pressure.push_back(last);
            intervals.push_back(interval);
        }
    }
    Replica replica = replica_of(1, 4, false);
    std::vector<StepInterval> intervals;
    std::vector<double> pressure;  ///< pressure before each interval
    std::vector<ProtocolRunner::ScanTag> scans;
};

// The estimate that the tolerance limits is ten times the inertial number (v / H) d sqrt(rho / P).
TEST(Protocol, KeepsTheInertialNumberWithinTheTolerance) {
    const Pressed pressed(0.02);
    double slowest = 1e9, fastest = 0;
    for (std::size_t k = 0; k < pressed.intervals.size(); ++k) {
        const StepInterval& interval = pressed.intervals[k];
        if (interval.plate_velocity == 0) continue;
        const double speed = std::abs(interval.plate_velocity);
        const double inertial_number =
            speed / interval.plate_z * 0.02 * std::sqrt(pressed.replica.grains.density / pressed.pressure[k]);
        EXPECT_LE(10 * inertial_number, 0.02 * (1 + 1e-9)) << k;
        EXPECT_GE(10 * inertial_number, 0.02 * 0.5)
            << k << ": no slower than it must be, but at a scan's approach";
        slowest = std::min(slowest, speed);
        fastest = std::max(fastest, speed);
    }
    EXPECT_GT(fastest, 3 * slowest) << "slow where the load is small";
    ASSERT_EQ(pressed.scans.size(), 4u);
    for (const auto& scan : pressed.scans) EXPECT_LE(scan.rate_error, 0.02 * (1 + 1e-9));
}

// Kinetic energy of m v^2/6 is that of a homogeneous deformation; above four times as much the plate slows
// down.
TEST(Protocol, ThePlateWaitsWhileGrainsRearrange) {
    Replica replica = replica_of(1, 4, false);
    replica.plate.speed = 1e-3;  // lower than the tolerance allows
    PackingScale grains = scale;
    grains.mass = 0.5;
    const double driven = grains.mass * 1e-6 / 6;
    const auto speed_after = [&](double energy) {
        ProtocolRunner runner(replica, time_step, grains);
        const auto five_steps = [](const StepInterval&) { return 5; };
        while (runner.state().activity == Activity::relax) runner.on_interval_done(answer(10, 0));
        runner.on_interval_done(answer(runner.next(five_steps).steps, energy));
        return std::abs(runner.next(five_steps).plate_velocity);
    };
    replica.protocol.rate_tolerance = 0.02;
    for (const auto& [energy, speed] :
         {std::pair{0.0, 1e-3}, {4 * driven, 1e-3}, {8 * driven, 5e-4}, {16 * driven, 2.5e-4}, {1.0, 1e-4}})
        EXPECT_NEAR(speed_after(energy), speed, 1e-6) << energy / driven;
    replica.protocol.rate_tolerance = 0;
    EXPECT_NEAR(speed_after(1), 1e-3, 1e-9) << "a constant speed";
    replica.protocol.rate_tolerance = 0.02;
    replica.protocol.stop_at_scans = true;
    replica.protocol.pause = 0.1;
    EXPECT_EQ(speed_after(1), speed_after(0)) << "as the plate of an experiment";
}

/// Plate positions and speeds of a stroke down and up, above grains that reach up to 0.15 m and yield to the
/// plate.
std::vector<StepInterval> stroke_above_grains(double weight) {
    PackingScale grains = scale;
    grains.top = 0.15;
    grains.weight = weight;
    Replica replica = replica_of(1, 2, false);
    replica.protocol.rate_tolerance = 0.02;
    ProtocolRunner runner(replica, time_step, grains);
    std::vector<StepInterval> moves;
    double lowest = grains.top, before = HUGE_VAL;
    drive(
        runner, time_step, 5,
        [&](const IntervalEnd& end, IntervalResult& result) {
            lowest = std::min(lowest, end.plate_z);
            // Half of the way is plastic: on the way up the plate leaves the grains at 0.125 m.
            const double surface = end.plate_z < before ? grains.top : (grains.top + lowest) / 2;
            result.wall_force[static_cast<int>(Wall::plate)] = {0, 0,
                                                                1e3 * std::max(0.0, surface - end.plate_z)};
            before = end.plate_z;
        },
        [&](const ProtocolState&, const StepInterval& interval, const auto&, const auto&) {
            if (interval.plate_velocity != 0) moves.push_back(interval);
        });
    return moves;
}

// Farther than a tenth of a diameter, 2 mm, from the grains the plate moves at the scene's 0.5 m/s.
TEST(Protocol, APlateThatTouchesNoGrainIsFast) {
    for (const StepInterval& move : stroke_above_grains(1)) {
        const double speed = std::abs(move.plate_velocity),
                     way = move.plate_velocity * move.steps * move.step_part * time_step;
        if (move.plate_z > (way < 0 ? 0.1521 : 0.1291)) {
            EXPECT_NEAR(speed, 0.5, 0.5 / 40)
                << move.plate_z << ": moves have at least 40 steps, a whole number";
        } else if (move.plate_z < (way < 0 ? 0.1519 : 0.126)) {
            EXPECT_LT(speed, 0.1) << move.plate_z;
        }
        if (way < 0 && move.plate_z > 0.152) {
            EXPECT_GT(move.plate_z + way, 0.152 - 0.5 * time_step);
        }
    }
    for (const StepInterval& move : stroke_above_grains(0))
        if (move.plate_velocity < 0) {
            EXPECT_LT(std::abs(move.plate_velocity), 0.1) << "grains without weight may be anywhere";
        }
}

TEST(Protocol, WithoutAToleranceTheSpeedIsThatOfTheScene) {
    Replica replica = replica_of(1, 4, false);
    ProtocolRunner runner(replica, time_step, scale);
    while (runner.state().activity == Activity::relax) runner.on_interval_done(answer(10, 0));
    EXPECT_NEAR(runner.next([](const StepInterval&) { return 5; }).plate_velocity, -0.5, 1e-9);
    const double strain_rate = 0.5 / replica.plate.start, min_pressure = 1e-5 * replica.grains.youngs_modulus;
    ASSERT_FALSE(runner.on_interval_done(answer(5, 0)));
    EXPECT_NEAR(runner.state().rate_error,
                10 * strain_rate * 0.02 * std::sqrt(replica.grains.density / min_pressure), 1e-6 * 10)
        << "the estimate is there all the same";
}

/// Way of the plate, or strain of the cell, over the time of all moves.
double mean_speed(const Course& course) {
    double way = 0, time = 0;
    for (const StepInterval& interval : course.intervals) {
        const double rate = std::abs(interval.plate_velocity) + std::abs(interval.strain_rate[2]);
        if (rate == 0) continue;
        way += rate * interval.steps * interval.step_part * time_step;
        time += interval.steps * interval.step_part * time_step;
        EXPECT_LE(interval.step_part, 1);
    }
    return way / time;
}

// Ways of 48, 1.1 and 0.14 steps. A tenth of a percent is left to whole steps.
TEST(Protocol, WithoutAToleranceCloseScansDoNotSlowThePlate) {
    for (const int scans : {3, 130, 1000})
        for (const bool pauses : {false, true}) {
            Replica replica = replica_of(1, scans, pauses);
            replica.plate.speed = 0.7;
            replica.protocol.pause = pauses ? 0.002 : 0;
            const Course course(replica, 0);
            EXPECT_EQ(course.scans.size(), 2u * scans);
            EXPECT_NEAR(mean_speed(course), 0.7, 1.1e-3 * 0.7) << scans << ' ' << pauses;
            if (!pauses) {
                const double time = course.scans[scans - 1].time - course.scans[0].time;
                EXPECT_NEAR(time, 0.1 / 0.7 * (scans - 1) / scans, 1.1e-3 * time);
            }
            replica.protocol.rate_tolerance = 1;
            for (const StepInterval& interval : Course(replica, 0).intervals)
                ASSERT_EQ(interval.step_part, 1) << "the speed is a maximum";
        }
}

TEST(Protocol, WithoutAToleranceCloseScansDoNotSlowACell) {
    Replica cell = replica_of(1, 1, false);
    cell.box = {0.1, 0.1, ContainerShape::cell, 0.1};
    cell.plate = {0.1, 0, 0.5};
    Stage move;
    move.strain_z = 0.05;
    move.rate = 0.7;
    move.scans = 65;
    cell.programme = {move};
    EXPECT_NEAR(mean_speed(Course(cell, 0)), 0.7, 1.1e-3 * 0.7) << "1.1 steps between two scans";
}

// If the distance is not a multiple of speed times step, steps are shorter; the speed is never higher.
TEST(Protocol, NeverMovesFasterThanGiven) {
    Replica replica = replica_of(1, 7, true);
    replica.plate.speed = 0.37;
    for (const StepInterval& interval : Course(replica, 0).intervals) {
        EXPECT_LE(std::abs(interval.plate_velocity), 0.37 * (1 + 1e-9));
        EXPECT_TRUE(interval.plate_velocity == 0 || std::abs(interval.plate_velocity) > 0.35);
    }
}

TEST(Protocol, WaitsUntilThePackingIsAtRestOrTheTimeLimit) {
    const Course calm(replica_of(1, 2, true), 1e-16, 10), restless(replica_of(1, 2, true), 1e-3);
    for (const auto& scan : calm.scans) EXPECT_TRUE(scan.settled);
    for (const auto& scan : restless.scans) EXPECT_FALSE(scan.settled);
    EXPECT_EQ(restless.scans.size(), 4u);
    // 80 steps of relaxation, then 100 of motion and 50 of waiting for each scan
    EXPECT_EQ(restless.steps, 80 + 4 * (100 + 50));

    EXPECT_EQ(calm.steps, 20 + 4 * (100 + 20)) << "settled after two intervals in a row";
}

TEST(Protocol, ProgressGrowsFromZeroToOne) {
    for (int longest : {7, 60}) {
        const Course course(replica_of(3, 5, true), 0, longest);
        EXPECT_TRUE(std::is_sorted(course.progress.begin(), course.progress.end()));
        EXPECT_LT(course.progress.front(), 0.05);
        EXPECT_EQ(course.progress.back(), 1);
    }
}

TEST(Protocol, ContinuesFromItsSavedState) {
    const Replica replica = replica_of(2, 3, true);
    ProtocolRunner runner(replica, time_step, scale);
    for (int round = 0; !runner.finished(); ++round) {
        ProtocolRunner other(replica, time_step, scale);
        other.set_state(runner.state());
        const auto longest = [](const StepInterval&) { return 17; };
        const StepInterval one = runner.next(longest), two = other.next(longest);
        ASSERT_EQ(one.steps, two.steps) << "round " << round;
        ASSERT_EQ(one.plate_z, two.plate_z);
        ASSERT_EQ(one.plate_velocity, two.plate_velocity);
        runner.on_interval_done(answer(one.steps, 0));
    }
    runner.stop();
    EXPECT_TRUE(runner.finished());
}

}  // namespace
}  // namespace mcdem
