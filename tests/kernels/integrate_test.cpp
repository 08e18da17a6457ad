// Motion of single grains with closed-form solutions: free fall, drag, sliding, rolling, spinning.
#include <cmath>
#include <numbers>

#include "core/names.h"
#include "reference/test_scene.h"

namespace mcdem::reference::integrate {
namespace {

constexpr double radius = 0.01, gravity = 9.81;

Start single_grain(const Replica& replica, double height) {
    Start start = free_cluster(replica, {Vec3::Zero()}, {2 * radius});
    start.packing.position[0].z() = height;
    return start;
}

// Velocities are half a step behind positions, so after n steps z0 - z = g/2 t (t + dt) exactly.
TEST(Motion, FreeFallIsExact) {
    Replica replica = test_replica();
    replica.grains.drag = 0;
    const double weight = gravity * replica.grains.excess_density / replica.grains.density;
    Batch batch(build(finest()), single_grain(replica, 0.5));
    const double dt = batch.engine().time_step(0), t = 100 * dt;
    batch.advance(100);
    const auto state = batch.engine().state(0);
    const double rounding = has_double() ? 1e-13 : 1e-6;
    EXPECT_NEAR(state.position[0].z(), 0.5 - weight / 2 * t * (t + dt), rounding);
    EXPECT_NEAR(state.velocity[0].z(), -weight * t, 10 * rounding);
    EXPECT_EQ(state.position[0].x(), 0.5);
    EXPECT_EQ(state.angular_velocity[0], Vec3::Zero());
}

TEST(Motion, DragLeadsToTerminalVelocity) {
    Replica replica = test_replica();
    replica.grains.drag = 30;
    const double extra = 10, terminal = gravity * 0.3 / (30 + extra);
    Batch batch(build(finest()), single_grain(replica, 0.5));
    const double dt = batch.engine().time_step(0);
    batch.advance(10, extra);
    const double rounding = has_double() ? 1e-13 : 1e-6;
    EXPECT_NEAR(batch.engine().state(0).velocity[0].z(), -terminal * (1 - std::pow(1 - 40 * dt, 10)),
                rounding);
    batch.advance(2000, extra);
    EXPECT_NEAR(batch.engine().state(0).velocity[0].z(), -terminal, rounding);
}

/// A grain on the floor, at the overlap that its weight causes.
Start on_the_floor(FrictionLaw law) {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e6, 0.3, 1000, 1000, 0.3, 1, 0};
    replica.walls = {1e12, 0.3, 0.2, 0.9};
    replica.contact.friction_law = law;
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3), force = volume * 1000 * gravity;
    const double overlap = std::pow(force / (4.0 / 3 * 1e6 / (1 - 0.09) * std::sqrt(radius)), 2.0 / 3);
    Start start = single_grain(replica, radius - overlap);
    start.packing.position[0].x() = 0.2;
    return start;
}

// v = v0 - mu g t and R omega = 5/2 mu g t, until v = R omega = 5/7 v0. The arm is R minus the overlap,
// which is shorter by half a per mille.
TEST(Motion, SlidesThenRolls) {
    constexpr double v0 = 0.3, friction = 0.2;
    for (FrictionLaw law : {FrictionLaw::saturated, FrictionLaw::mindlin}) {
        const Start start = on_the_floor(law);
        Batch batch(build(finest()), start);
        batch.engine().set_velocities(0, {{v0, 0, 0}}, {Vec3::Zero()});
        const double dt = batch.engine().time_step(0), rolls = 2 * v0 / (7 * friction * gravity);
        const int half_way = static_cast<int>(rolls / 2 / dt);
        batch.advance(half_way);
        auto state = batch.engine().state(0);
        const double lost = friction * gravity * half_way * dt;
        EXPECT_NEAR((v0 - state.velocity[0].x()) / lost, 1, 0.01) << name(law);
        EXPECT_NEAR(state.angular_velocity[0].y() * radius / (2.5 * lost), 1, 0.01) << name(law);
        EXPECT_NEAR(state.rotation[0].y() * radius / (1.25 * lost * half_way * dt), 1, 0.01) << name(law);
        batch.advance(6 * half_way);
        state = batch.engine().state(0);
        EXPECT_NEAR(state.velocity[0].x() / v0, 5.0 / 7, 0.003) << name(law);
        EXPECT_NEAR(state.angular_velocity[0].y() * radius / v0, 5.0 / 7, 0.003) << name(law);
        EXPECT_NEAR(state.velocity[0].y(), 0, 1e-6) << name(law);
    }
}

// A spinning grain placed on the floor accelerates to v = 2/7 R omega0.
TEST(Motion, SpinsThenRolls) {
    constexpr double spin = 30;
    const Start start = on_the_floor(FrictionLaw::saturated);
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {Vec3::Zero()}, {{0, spin, 0}});
    batch.advance(static_cast<int>(std::ceil(0.5 / batch.engine().time_step(0))));
    const auto state = batch.engine().state(0);
    EXPECT_NEAR(state.velocity[0].x() / (spin * radius), 2.0 / 7, 0.002);
    EXPECT_NEAR(state.angular_velocity[0].y() / spin, 2.0 / 7, 0.002);
}

// A contact point on the axis does not slide, so spin about the normal does not decay.
TEST(Motion, SpinAboutTheNormalPersists) {
    const Start start = on_the_floor(FrictionLaw::saturated);
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {Vec3::Zero()}, {{0, 0, 30}});
    batch.advance(200);
    const auto state = batch.engine().state(0);
    EXPECT_NEAR(state.angular_velocity[0].z(), 30, 1e-4);
    EXPECT_NEAR(state.velocity[0].head<2>().norm(), 0, 1e-6);
}

/// A free grain that spins about several axes in turn, for `steps` steps each.
Vec3 turned_by(const std::vector<Vec3>& spins, int steps) {
    Replica replica = test_replica();
    replica.grains.drag = replica.grains.excess_density = 0;
    Batch batch(build(finest()), single_grain(replica, 0.5));
    for (const Vec3& spin : spins) {
        batch.engine().set_velocities(0, {Vec3::Zero()}, {spin});
        batch.advance(steps);
    }
    return batch.engine().state(0).rotation[0];
}

double step_length() {
    return Batch(build(finest()), single_grain(test_replica(), 0.5)).engine().time_step(0);
}

TEST(Motion, RotationIsSpinTimesTime) {
    const double dt = step_length(), rounding = has_double() ? 1e-12 : 1e-5;
    for (const Vec3& spin : {Vec3(12, 0, 0), Vec3(-5, 10, 2), Vec3(0, 0, 0)}) {
        const Vec3 angle = 100 * dt * spin;
        const double step = dt * spin.norm();  // the small-angle update replaces the angle by its arc tangent
        EXPECT_LT((turned_by({spin}, 100) - angle).norm(), step * step * angle.norm() / 12 + rounding);
    }
}

// A quarter turn about x and then one about y is a third of a turn about (1, 1, -1); in the reverse order it
// is a third of a turn about (1, 1, 1).
TEST(Motion, RotationsAreAboutTheLaboratorysAxes) {
    const int steps = 1000;
    const double quarter = std::numbers::pi / 2, spin = quarter / steps / step_length();
    const Vec3 x(spin, 0, 0), y(0, spin, 0), third = 2 * std::numbers::pi / 3 * Vec3(1, 1, 1).normalized();
    const double error = 1e-5;  // of large steps and of single precision
    EXPECT_LT((turned_by({x, y}, steps) - third.cwiseProduct(Vec3(1, 1, -1))).norm(), error);
    EXPECT_LT((turned_by({y, x}, steps) - third).norm(), error);
    const Vec3 around =
        turned_by({x, x, x}, steps);  // three quarter turns equal one in the opposite direction
    EXPECT_LT((around - Vec3(-quarter, 0, 0)).norm(), error);
}

}  // namespace
}  // namespace mcdem::reference::integrate
