// A replica that fails stops with its cause and its grain; the other replicas of the batch continue as if
// alone.
#include <fmt/core.h>

#include <cmath>

#include "core/names.h"
#include "sim/simulated.h"

namespace mcdem::reference {
namespace {

/// A large grain between floor and plate, and small grains without contacts; `large` is the large grain's
/// index.
Start squeezed(ContactModel model, double gamma, double overlap, int large) {
    constexpr double radius = 0.01, small = 0.004;
    Replica replica = test_replica(model);
    replica.contact.gamma = gamma;
    replica.grains.excess_density = 0;
    replica.grains.poisson_ratio = 0.49;
    replica.walls.youngs_modulus = 1e9;
    const double height = 2 * radius * (1 - overlap);
    replica.box = {0.1, 0.1};
    replica.plate.start = height;
    replica.plate.end = 0.95 * height;
    Packing packing;
    for (int i = 0; i < 8; ++i) {
        packing.position.push_back({0.012 + 0.025 * (i % 4), 0.03 + 0.04 * (i / 4), height / 2});
        packing.diameter.push_back(i == large ? 2 * radius : 2 * small);
    }
    return {replica, packing};
}

/// Advances every replica without a status by `steps`. Returns the last results of each.
std::vector<mcdem::IntervalResult> run(Batch& batch, int steps) { return batch.advance(steps, 50); }

TEST(Failure, RunAwayStopsOnlyItsReplica) {
    const Start healthy = squeezed(ContactModel::mc_dem, 1.125, 0.05, 2);
    const Start runaway = squeezed(ContactModel::mc_dem, 3, 0.15, 5);
    const Start other = squeezed(ContactModel::elastic_sphere, 1, 0.1, 6);
    for (Precision precision : {Precision::single_precision, finest()}) {
        Batch together(build(precision), {healthy, runaway, other});
        const auto results = run(together, 500);
        EXPECT_EQ(results[0].status, 0);
        EXPECT_EQ(results[1].status & (STATUS_OVERLAP | STATUS_SLOTS | STATUS_LOST), STATUS_OVERLAP);
        EXPECT_EQ(results[1].failed_grain, 5);
        EXPECT_GT(results[1].deepest_overlap, runaway.replica.numerics.overlap_limit);
        EXPECT_EQ(results[2].status, 0);
        Batch first(build(precision), healthy), last(build(precision), other);
        run(first, 500);
        run(last, 500);
        EXPECT_TRUE(same_bits(together.engine().state(0), first.engine().state(0)));
        EXPECT_TRUE(same_bits(together.engine().state(2), last.engine().state(0)));
    }
}

TEST(Failure, TooLongATimeStepIsNotANumber) {
    Start start = squeezed(ContactModel::independent, 1, 0.05, 4);
    start.packing.position[4].z() *= 0.99;
    start.replica.numerics.time_step = 1e30;
    start.replica.contact.friction_law = FrictionLaw::saturated;  // springs of all grains would overflow
    Batch batch(build(Precision::single_precision), {squeezed(ContactModel::mc_dem, 1, 0.05, 1), start});
    const auto results = batch.advance(10);
    EXPECT_EQ(results[0].status, 0);
    EXPECT_EQ(results[1].status & STATUS_NOT_A_NUMBER, STATUS_NOT_A_NUMBER);
    EXPECT_EQ(results[1].failed_grain, 4);
}

TEST(Failure, GrainThatLeavesTheBoxIsLost) {
    const Start start = squeezed(ContactModel::independent, 1, 0.05, 4);
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
        Batch batch(build(Precision::single_precision), {start, start});
        std::vector<Vec3> velocity(8, Vec3::Zero());
        velocity[7] = 0.2 / batch.engine().time_step(0) * direction;
        batch.engine().set_velocities(1, velocity, std::vector<Vec3>(8, Vec3::Zero()));
        const auto results = batch.engine().advance(
            {{20, start.replica.plate.start, 0, 0}, {20, start.replica.plate.start, 0, 0}});
        EXPECT_EQ(results[0].status, 0);
        EXPECT_EQ(results[0].steps, 20);
        EXPECT_EQ(results[1].status, STATUS_LOST);
        EXPECT_EQ(results[1].failed_grain, 7);
        EXPECT_EQ(results[1].steps, 1) << "stopped in the step in which it happened";
    }
}

// A large grain among many small ones has more neighbours than slots.
TEST(Failure, MoreNeighboursThanSlotsAreReported) {
    constexpr double radius = 0.01, small = 0.002;
    Start start = free_cluster(test_replica(), {Vec3::Zero()}, {2 * radius});
    start.replica.grains.excess_density = 0;
    const int count = 30;
    for (int k = 0; k < count; ++k) {
        const double z = 1 - (2 * k + 1.0) / count, angle = 2.4 * k;
        const Vec3 direction(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle),
                             z);
        start.packing.position.push_back(Vec3::Constant(0.5) + (radius + 1.001 * small) * direction);
        start.packing.diameter.push_back(2 * small);
    }
    std::swap(start.packing.position[0], start.packing.position[20]);
    std::swap(start.packing.diameter[0], start.packing.diameter[20]);
    Batch few(build(Precision::single_precision, 16), start),
        enough(build(Precision::single_precision, 32), start);
    const auto result = few.advance(1).front();
    EXPECT_EQ(result.status, STATUS_SLOTS);
    EXPECT_EQ(result.failed_grain, 20);
    EXPECT_EQ(enough.advance(1).front().status, 0);
}

// The equator moves outward by 2 % of the radius, more than the probed gap. The walls are in the list, but
// too far to touch.
TEST(Failure, DisplacementBeyondTheProbedGapIsReported) {
    Start start = squeezed(ContactModel::elastic_sphere, 1, 0.12, 0);
    start.packing.position.resize(1);
    start.packing.diameter.resize(1);
    start.packing.position[0].x() = start.packing.position[0].y() = 0.0105;
    start.replica.box = {0.021, 0.021};
    Batch wide(build(Precision::single_precision), start);
    EXPECT_EQ(run(wide, 300).front().status, 0);
    start.replica.numerics.probe_gap = 0.01;
    Batch narrow(build(Precision::single_precision), start);
    EXPECT_EQ(run(narrow, 300).front().status, STATUS_UNPROBED);
}

/// A scene with several replicas and a short protocol.
mcdem::Scene short_scene(const std::vector<Start>& starts) {
    mcdem::Scene scene;
    for (const auto& start : starts) {
        scene.replicas.push_back(start.replica);
        auto& protocol = scene.replicas.back().protocol;
        protocol.scans_per_stroke = 2;
        protocol.settle_time = 0.02;
        protocol.relax_time = 0.02;
    }
    return scene;
}

TEST(Failure, SimulationNamesReplicaGrainStepAndCause) {
    const std::vector<Start> starts{squeezed(ContactModel::mc_dem, 1.125, 0.05, 2),
                                    squeezed(ContactModel::mc_dem, 3, 0.15, 5)};
    const auto [scans, failures, progress] =
        simulated(short_scene(starts), {starts[0].packing, starts[1].packing}, true);
    EXPECT_FALSE(failures[0]);
    ASSERT_TRUE(failures[1]);
    EXPECT_EQ(failures[1]->grain, 5);
    EXPECT_GT(failures[1]->step, 0);
    for (const char* fact : {"before the plate moved", "contact.gamma is too high"})
        EXPECT_THAT(failures[1]->cause, testing::HasSubstr(fact));
    EXPECT_EQ(scans[0].size(), 4u) << "two levels, there and back";
    EXPECT_TRUE(scans[1].empty());
    EXPECT_DOUBLE_EQ(progress, 1);
}

// Two grains on top of each other, compressed by 3 to 14 % of the sum of their radii.
TEST(Failure, BeyondTheModelsRangeAReplicaContinuesOrStopsAsTheSceneSpecifies) {
    Replica going_on = test_replica(ContactModel::elastic_sphere), stopping = going_on, other = going_on;
    stopping.numerics.stop_beyond_law = other.numerics.stop_beyond_law = true;
    other.contact.model = ContactModel::independent;  // a model without a tested range
    std::vector<Start> starts;
    for (Replica* replica : {&going_on, &stopping, &other}) {
        replica->box = {0.03, 0.03};
        replica->walls.youngs_modulus = 1e9;
        replica->grains.friction = replica->walls.friction = 0;
        replica->plate.start = 0.0388;
        replica->plate.end = 0.034;
        starts.push_back({*replica, {{{0.015, 0.015, 0.0097}, {0.015, 0.015, 0.0291}}, {0.02, 0.02}}});
    }
    auto scene = short_scene(starts);
    for (auto& replica : scene.replicas) replica.protocol.scans_per_stroke = 4;
    const auto [scans, failures, progress] =
        simulated(scene, {starts[0].packing, starts[1].packing, starts[2].packing}, true);
    std::vector<std::vector<double>> overlaps(3);
    for (int r = 0; r < 3; ++r)
        for (const mcdem::Scan& scan : scans[r]) overlaps[r].push_back(scan.max_overlap);
    EXPECT_EQ(overlaps[0].size(), 8u);
    EXPECT_EQ(overlaps[2].size(), 8u);
    const auto first = std::ranges::find_if(overlaps[0], [](double overlap) { return overlap > 0.1; });
    ASSERT_NE(first, overlaps[0].end());
    EXPECT_EQ(overlaps[1], std::vector(overlaps[0].begin(), first + 1));
    EXPECT_FALSE(failures[0] || failures[2]);
    ASSERT_TRUE(failures[1]);
    EXPECT_THAT(failures[1]->cause, testing::HasSubstr("more than the law of elastic_sphere was tested"));
}

// A small grain between two large ones: the limit counts for its own size, so the large ones never touch.
// Over the sum of the radii an overlap of its radius would be 0.13 only.
TEST(Failure, AGrainThatVanishesBetweenTwoOthersStopsItsReplica) {
    Replica replica = test_replica(ContactModel::independent);
    replica.box = {0.06, 0.06};
    replica.grains.excess_density = 0;
    replica.plate.start = 0.043;
    replica.plate.end = 0.0375;
    const Start start{replica,
                      {{{0.03, 0.03, 0.01}, {0.03, 0.03, 0.0215}, {0.03, 0.03, 0.033}}, {0.02, 0.003, 0.02}}};
    auto scene = short_scene({start});
    scene.replicas[0].protocol.scans_per_stroke = 30;
    const auto [scans, failures, progress] = simulated(scene, start.packing, true);
    double deepest = 0;
    for (const mcdem::Scan& scan : scans[0]) {
        deepest = std::max(deepest, scan.max_overlap);
        EXPECT_GT(scan.position[2].z() - scan.position[0].z(), 0.02) << "the large grains touch";
    }
    ASSERT_TRUE(failures[0]);
    EXPECT_THAT(failures[0]->cause,
                testing::HasSubstr("passed numerics.overlap_limit = 0.5 of the sum of the radii"));
    EXPECT_GT(deepest, 0.3) << "max_overlap says it before";
    EXPECT_LE(deepest, 0.5);
}

std::string cause_of_failure(const Start& start) {
    const auto failure = simulated(short_scene({start}), start.packing, true).failures[0];
    return failure ? failure->cause : "";
}

TEST(Failure, AdviceNamesOnlyKeysThatTheModelUses) {
    Start start = squeezed(ContactModel::elastic_half_space, 1, 0.35, 5);
    const std::string at_rest = cause_of_failure(start);
    const auto without_gamma = testing::Not(testing::HasSubstr("contact.gamma"));
    EXPECT_THAT(at_rest, testing::AllOf(testing::HasSubstr("before the plate moved"), without_gamma));
    start = squeezed(ContactModel::elastic_half_space, 1, 0.05, 5);
    start.replica.plate.end = 0.6 * start.replica.plate.start;
    const std::string compressed = cause_of_failure(start);
    EXPECT_THAT(compressed, testing::AllOf(testing::HasSubstr("no static solution"),
                                           testing::HasSubstr("raise plate.end"), without_gamma));
    start.replica.contact = squeezed(ContactModel::mc_dem, 2, 0.05, 5).replica.contact;
    EXPECT_THAT(cause_of_failure(start), testing::HasSubstr("or lower contact.gamma"));
}

}  // namespace
}  // namespace mcdem::reference
