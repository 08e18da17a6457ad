// Adhesion (Derjaguin, Muller & Toporov): pull-off force, range in a gap, energy and friction limit.
// Cohesion.
#include <numbers>

#include "sim/squeezed_grain.h"

namespace mcdem::reference::effects_adhesion {
namespace {

constexpr double work_of_adhesion = 0.05, radius = SqueezedGrain::radius, other_radius = 0.006;

mcdem::Effects adhesive() {
    mcdem::Effects effects;
    effects.adhesion = work_of_adhesion;
    return effects;
}

double pull_off(double reduced_radius) { return 2 * std::numbers::pi * work_of_adhesion * reduced_radius; }

Start two_grains(double overlap) {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {SqueezedGrain::youngs_modulus, SqueezedGrain::poisson_ratio, 1000, 0, 0, 1, 0};
    replica.effects = adhesive();
    replica.numerics.time_step = 0.02;
    return free_cluster(replica, {{0, 0, 0}, {radius + other_radius - overlap, 0, 0}},
                        {2 * radius, 2 * other_radius});
}

// Two grains are moved apart: the largest tension is 2 pi w R*, at zero overlap.
TEST(Adhesion, PullOffForceOfTwoGrainsIsTwoPiTimesWorkTimesReducedRadius) {
    constexpr double overlap = 2e-4;
    constexpr int steps = 400;
    Batch batch(build(finest()), two_grains(overlap));
    const double velocity = overlap / (steps * batch.engine().time_step(0));
    const double reduced = radius * other_radius / (radius + other_radius);
    double tension = 0, parted_at = 0;
    for (int step = 0; step < steps + 20; ++step) {
        batch.engine().set_velocities(0, {Vec3::Zero(), {velocity, 0, 0}}, {2, Vec3::Zero()});
        batch.advance(1);
        const auto state = batch.engine().state(0);
        if (state.contacts.empty()) {
            parted_at = radius + other_radius - (state.position[1] - state.position[0]).norm();
            break;
        }
        tension = std::max(tension, state.contacts.front().force.x());
        const double d = state.contacts.front().overlap;
        const double hertz = 2.0 / 3 * SqueezedGrain::modulus * std::sqrt(reduced) * std::pow(d, 1.5);
        EXPECT_NEAR(state.contacts.front().force.x(), pull_off(reduced) - hertz, 1e-4 * pull_off(reduced))
            << d;
    }
    EXPECT_NEAR(tension / pull_off(reduced), 1, 0.01);
    EXPECT_NEAR(parted_at, 0, 2 * overlap / steps);
}

// At a wall R* is R. In a gap the attraction decreases linearly to zero, without a jump.
TEST(Adhesion, DecreasesToZeroInAGapOfAHundredthOfTheRadius) {
    SqueezedGrain grain(adhesive(), 1e-4);
    const double most = pull_off(radius), range = 0.01 * radius, step = 1e-6;
    double before = grain.squeeze(0);
    for (const auto& [overlap, force, energy, work] : grain.path(-300 * step, 300)) {
        const double gap = -overlap;
        const double expected = SqueezedGrain::hertz(-gap) - most * std::clamp(1 - gap / range, 0.0, 1.0);
        EXPECT_NEAR(force, expected, 1e-4 * most) << gap;
        if (gap > 0) {
            EXPECT_LT(std::abs(force - before), 1.1 * most * step / range) << "a jump at " << gap;
        }
        before = force;
    }
    EXPECT_EQ(before, 0);
}

// Two grains are brought together, compressed and separated along one curve. The reported energy equals the
// work; it is zero beyond the range.
TEST(Adhesion, EnergyIsTheWorkDone) {
    SqueezedGrain grain(adhesive(), -1.5 * 0.01 * radius);
    for (const auto& [overlap, force, energy, work] : grain.path(400e-6, 200))
        EXPECT_NEAR(energy, work, 2e-3 * pull_off(radius) * 0.01 * radius) << overlap;
    EXPECT_GT(grain.overlap(), 2e-4);
}

/// Force of the floor on a grain that slides fast, and the grain's overlap.
struct Sliding {
    Vec3 force;
    double overlap;
};
constexpr double friction = 0.2;

Sliding slide(const mcdem::Effects& effects, double overlap) {
    Start start = two_grains(0);
    start.replica.effects = effects;
    start.replica.grains.friction = friction;
    start.replica.walls = {SqueezedGrain::wall_modulus, SqueezedGrain::poisson_ratio, friction, 1};
    start.packing.position = {{0.5, 0.5, radius - overlap}, {0.1, 0.1, 0.5}};
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {{1, 0, 0}, Vec3::Zero()},
                                  {2, Vec3::Zero()});  // 1000 times the sliding velocity
    const auto force = batch.advance(1).front().wall_force[static_cast<int>(mcdem::Wall::floor)];
    return {force, radius - batch.engine().state(0).position[0].z()};
}

// The friction limit is mu (F_n + 2 pi w R*), which is mu times the Hertz force.
TEST(Adhesion, IncreasesTheFrictionLimit) {
    const Sliding floor = slide(adhesive(), 1e-4);
    const double hertz = SqueezedGrain::hertz(floor.overlap);
    EXPECT_NEAR(floor.force.x() / (friction * hertz), 1, 1e-3);
    EXPECT_NEAR(-floor.force.z() / (hertz - pull_off(radius)), 1, 1e-3);
}

// With net_force_friction = 1 the friction limit is mu times the net force, repulsive or attractive.
TEST(Adhesion, NetForceLimitsFrictionIfTheSceneSaysSo) {
    mcdem::Effects effects = adhesive();
    effects.net_force_friction = 1;
    for (const double overlap : {2e-5, 4e-4}) {
        const Sliding floor = slide(effects, overlap);
        const double net = SqueezedGrain::hertz(floor.overlap) - pull_off(radius);
        EXPECT_EQ(net > 0, overlap > 1e-4);
        EXPECT_NEAR(-floor.force.z() / net, 1, 2e-3) << overlap;
        EXPECT_NEAR(floor.force.x() / (friction * std::abs(net)), 1, 2e-3) << overlap;
    }
}

// Cohesion: k times the area 2 pi R* overlap; the energy is the work. Trapezoids of Hertz's law over such
// steps have an error of 1e-10 J, a part in 10^5 of the final energy of cohesion.
TEST(Cohesion, AttractsInProportionToTheAreaOfIntersection) {
    constexpr double per_overlap = 5000 * 2 * std::numbers::pi * radius, step = 2e-6, most = 200 * step;
    mcdem::Effects effects;
    effects.cohesion = 5000;
    SqueezedGrain grain(effects, 0);
    for (const auto& [overlap, force, energy, work] : grain.path(most, 200)) {
        EXPECT_NEAR(force, SqueezedGrain::hertz(overlap) - per_overlap * overlap, 1e-4 * per_overlap * most)
            << overlap;
        EXPECT_NEAR(energy, work, 1e-3 * per_overlap * most * most) << overlap;
    }
}

}  // namespace
}  // namespace mcdem::reference::effects_adhesion
