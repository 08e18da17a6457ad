// Effect friction_history (a weighted mean of both friction laws), and rolling resistance.
#include <algorithm>
#include <numbers>

#include "reference/moved_pair.h"

namespace mcdem::reference {
namespace {

Start lattice(FrictionLaw law, double friction_history) {
    Replica replica = test_replica(ContactModel::independent);
    replica.contact.friction_law = law;
    replica.effects.friction_history = friction_history;
    return jittered_lattice(replica, 27, 51);
}

// With weight 1 the other law is used alone, bit for bit.
TEST(FrictionHistory, WeightOneGivesTheOtherLaw) {
    for (Precision precision : {Precision::single_precision, finest()}) {
        Batch batch(build(precision),
                    std::vector<Start>{lattice(FrictionLaw::saturated, 0), lattice(FrictionLaw::mindlin, 1),
                                       lattice(FrictionLaw::mindlin, 0), lattice(FrictionLaw::saturated, 1),
                                       lattice(FrictionLaw::mindlin_displacement, 1),
                                       lattice(FrictionLaw::mindlin_displacement, 0)});
        for (int r = 0; r < 6; ++r) {
            Uniform uniform(3);
            batch.engine().set_velocities(r, uniform.vectors(27, 0.1), uniform.vectors(27, 10));
        }
        batch.advance(100);
        EXPECT_TRUE(same_bits(batch.engine().state(0), batch.engine().state(1)));
        EXPECT_TRUE(same_bits(batch.engine().state(2), batch.engine().state(3)));
        EXPECT_TRUE(same_bits(batch.engine().state(0), batch.engine().state(4)));
        EXPECT_FALSE(same_bits(batch.engine().state(0), batch.engine().state(2)));
        EXPECT_FALSE(same_bits(batch.engine().state(2), batch.engine().state(5)));
    }
}

// Three grains on the floor with the same prescribed shear: the third has 0.7 of the first law's force and
// 0.3 of the other's. In the single step between two prescribed velocities friction changes the velocity by
// about 1e-4.
TEST(FrictionHistory, ForceIsTheWeightedMean) {
    std::vector<Start> starts;
    for (double share : {0.0, 1.0, 0.3}) {
        Replica replica = test_replica(ContactModel::independent);
        replica.grains.excess_density = 1000;
        replica.effects.friction_history = share;
        replica.contact.sliding_velocity = 0.2;
        replica.numerics.time_step = 2e-3;
        Start start = free_cluster(replica, {Vec3::Zero()}, {0.02});
        start.packing.position[0].z() = 0.01 - 2e-4;
        starts.push_back(start);
    }
    Batch batch(build(finest()), starts);
    double most = 0;
    for (int step = 0; step < 40; ++step) {
        for (int r = 0; r < 3; ++r)
            batch.engine().set_velocities(r, {{step < 25 ? 0.4 : -0.4, 0, 0}}, {Vec3::Zero()});
        const auto results = batch.advance(1);
        const auto force = [&](int r) {
            return results[r].wall_force[static_cast<int>(mcdem::Wall::floor)].x();
        };
        most = std::max({most, std::abs(force(0)), std::abs(force(1))});
        EXPECT_NEAR(force(2), 0.7 * force(0) + 0.3 * force(1), 1e-3 * most) << step;
        if (step == 3) {
            EXPECT_GT(std::abs(force(0) - force(1)), 0.1 * most) << "the laws differ";
        }
    }
    EXPECT_GT(most, 0);
}

struct Rolling {
    std::vector<double> speed;
    double time_step = 0;
};

/// A sphere that starts to roll at 0.05 m/s along the floor under its weight.
Rolling roll(double rolling_resistance, int steps) {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e6, 0.3, 1000, 1000, 0.5, 0.3, 0};
    replica.walls = {1e12, 0.3, 0.5, 0.3};
    replica.effects.rolling_resistance = rolling_resistance;
    replica.contact.sliding_velocity = 1e-4;
    Start start = free_cluster(replica, {Vec3::Zero()}, {0.02});
    const double weight = 1000 * 9.81 * 4.0 / 3 * std::numbers::pi * 1e-6;
    start.packing.position[0].z() = 0.01 - std::pow(weight / (4.0 / 3 * 1e6 / 0.91 * 0.1), 2.0 / 3);
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {{0.05, 0, 0}}, {{0, 5, 0}});
    Rolling rolling;
    rolling.time_step = batch.engine().time_step(0);
    for (int step = 0; step < steps; step += 20) {
        batch.advance(20);
        rolling.speed.push_back(batch.engine().state(0).velocity[0].x());
    }
    return rolling;
}

// The torque M = mu_r R m g and the friction of rolling give a = -M / (R (m + I/R^2)) = -5/7 mu_r g. The
// overlap shortens the arm by a thousandth of R.
TEST(RollingResistance, DeceleratesARollingSphereByFiveSeventhsOfMuTimesG) {
    constexpr double resistance = 0.02;
    const Rolling rolling = roll(resistance, 2000);
    const double expected = -5.0 / 7 * resistance * 9.81;
    const std::size_t first = 20, last = 80;
    const double measured =
        (rolling.speed[last] - rolling.speed[first]) / ((last - first) * 20 * rolling.time_step);
    EXPECT_GT(rolling.speed[last], 0.01);
    EXPECT_NEAR(measured / expected, 1, 0.01);
    const Rolling free = roll(0, 2000);
    EXPECT_NEAR(free.speed[last], 0.05, 1e-3);
}

// Below its yield torque the spring holds a sphere that is pushed: it stops, and goes back by no more than
// the spring has stored, R times the yield angle mu_r F_n / (8 G* a R).
TEST(RollingResistance, StopsASphere) {
    const Rolling rolling = roll(0.3, 4000);
    EXPECT_LT(std::abs(rolling.speed.back()), 1e-4);
    const auto least = std::ranges::min_element(rolling.speed);
    EXPECT_GT(*least, -0.5 * rolling.speed.front()) << "the spring is damped";
}

// Two grains pressed together roll on each other with constant relative spin, which is prescribed: the torque
// on both is 8 G* a R*^2 times the angle until it reaches mu_r R* F, and follows at once when the spin
// reverses.
TEST(RollingResistance, IsASpringThatYields) {
    constexpr double resistance = 0.1, radius = 0.01, reduced = radius / 2, overlap = 1e-4;
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e5, 0.3, 1000, 0, 0, 1, 0};
    replica.effects.rolling_resistance = resistance;
    replica.numerics.time_step = 0.005;  // the grains hardly move in 60 steps
    const Start start =
        free_cluster(replica, {{0, 0, 0}, {2 * radius - overlap, 0, 0}}, {2 * radius, 2 * radius});
    const double inertia = 0.4 * 1000 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 5);
    Batch batch(build(finest()), start);
    const double shear = 1e5 / (2 * 1.3) / (2 * (2 - 0.3)),
                 force = 4.0 / 3 * 1e5 / (2 * 0.91) * std::sqrt(reduced) * std::pow(overlap, 1.5);
    const double stiffness = 8 * shear * std::sqrt(reduced * overlap) * reduced * reduced;
    const double limit = resistance * reduced * force, step = batch.engine().time_step(0);
    const double spin = limit / stiffness / (10 * step);  // yields within ten steps
    double angle = 0;
    for (int i = 0; i < 60; ++i) {
        const double relative = i < 30 ? spin : -spin;
        batch.engine().set_velocities(0, {2, Vec3::Zero()}, {{0, -relative / 2, 0}, {0, relative / 2, 0}});
        batch.advance(1);
        angle = std::clamp(angle + relative * step, -limit / stiffness, limit / stiffness);
        const auto now = batch.engine().state(0).angular_velocity;
        EXPECT_NEAR((now[0].y() + relative / 2) * inertia / step, stiffness * angle, 0.01 * limit) << i;
        EXPECT_NEAR(now[0].y() + now[1].y(), 0, 1e-6 * spin) << "angular momentum";
    }
}

/// Couple on the first grain of a pair [N m], from the change of its spin in a step in which it is at rest.
Vec3 couple(MovedPair& pair) {
    constexpr double inertia = 0.4 * 1000 * 4.0 / 3 * std::numbers::pi * 1e-10;  // R = 0.01 m
    pair.move(Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 1);
    return pair.engine().state(0).angular_velocity[0] * inertia / pair.engine().time_step(0);
}

MovedPair rolled_pair() {
    mcdem::Effects effects;
    effects.rolling_resistance = 10;
    MovedPair pair(build(finest()), MovedPair::start(1e-4, 0, FrictionLaw::saturated, effects));
    pair.move(Vec3::Zero(), Vec3::Zero(), {0, -1e-4, 0}, {0, 1e-4, 0}, 100);
    return pair;
}

// The couple stays while the load grows and decreases with the contact radius, the root of the overlap.
TEST(RollingResistance, KeepsItsCoupleWhenTheLoadGrows) {
    MovedPair pair = rolled_pair();
    const Vec3 rolled = couple(pair);
    ASSERT_GT(rolled.y(), 0);
    pair.move_second({-3e-4, 0, 0}, 500);
    EXPECT_NEAR(couple(pair).y() / rolled.y(), 1, 1e-3);
    pair.move_second({3e-4, 0, 0}, 500);
    EXPECT_NEAR(couple(pair).y() / rolled.y(), 0.5, 1e-3);
}

TEST(RollingResistance, TurnsWithThePair) {
    const std::vector<Vec3> axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3(1, 1, 1).normalized()};
    for (const Vec3& axis : axes) {
        MovedPair pair = rolled_pair();
        const Vec3 rolled = couple(pair);
        pair.turn_together(axis, std::numbers::pi / 2, 500);
        const Vec3 wanted = Eigen::AngleAxisd(std::numbers::pi / 2, axis) * rolled;
        EXPECT_LT((couple(pair) - wanted).norm() / rolled.norm(), 1e-3) << axis.transpose();
    }
}

// Spins about the line of centres are not resisted.
TEST(RollingResistance, DoesNotResistTwisting) {
    Replica replica = test_replica(ContactModel::independent);
    replica.effects.rolling_resistance = 0.5;
    const Start start = free_cluster(replica, {{0, 0, 0}, {0.0199, 0, 0}}, {0.02, 0.02});
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {2, Vec3::Zero()}, {{3, 0, 0}, {-1, 0, 0}});
    batch.advance(20);
    EXPECT_NEAR(batch.engine().state(0).angular_velocity[0].x(), 3, 1e-6);
}

}  // namespace
}  // namespace mcdem::reference
