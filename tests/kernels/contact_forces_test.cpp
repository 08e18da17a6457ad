// Collisions of two grains, or of a grain with the floor, against the closed-form solution for Hertz's law.
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "reference/test_scene.h"
#include "sim/device_replica.h"

namespace mcdem::reference {
namespace {

using std::numbers::pi;
constexpr double radius = 0.01, other_radius = 0.007, speed = 0.2;

/// Two free grains, or one grain above the floor.
enum class Against { grain, floor };

Replica collision_replica(double restitution, double time_step) {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e5, 0.3, 1000, 0, 0, restitution, 0};
    replica.walls = {1e12, 0.3, 0, restitution};
    replica.numerics.time_step = time_step;
    return replica;
}

constexpr double default_gap = 1e-4;

Start collision(Against against, double restitution, double time_step, double gap = default_gap) {
    const Replica replica = collision_replica(restitution, time_step);
    if (against == Against::grain)
        return free_cluster(replica, {{0, 0, 0}, {radius + other_radius + gap, 0, 0}},
                            {2 * radius, 2 * other_radius});
    Start start = free_cluster(replica, {{0, 0, 0}}, {2 * radius});
    start.packing.position[0].z() = radius + gap;
    return start;
}

/// F = stiffness delta^(3/2) with reduced mass `mass` and impact velocity `speed`.
struct Hertz {
    double mass, stiffness;
    explicit Hertz(Against against) {
        const bool pair = against == Against::grain;
        const double modulus = 1e5 / (1 - 0.09) / (pair ? 2 : 1);
        const double r = pair ? radius * other_radius / (radius + other_radius) : radius;
        const double m = 1000 * 4 / 3.0 * pi * std::pow(radius, 3),
                     n = m * std::pow(other_radius / radius, 3);
        mass = pair ? m * n / (m + n) : m;
        stiffness = 4.0 / 3 * modulus * std::sqrt(r);
    }
    /// 2 delta/v times the integral of (1 - x^(5/2))^(-1/2) from 0 to 1, which is 2.943 delta/v, with the
    /// largest overlap delta from conservation of energy: m v^2 / 2 = 2/5 k delta^(5/2).
    double duration() const {
        const double deepest = std::pow(5 * mass * speed * speed / (4 * stiffness), 0.4);
        return 4.0 / 5 * std::sqrt(pi) * std::tgamma(0.4) / std::tgamma(0.9) * deepest / speed;
    }
};

/// Moves the first grain towards the other one, or the floor [m/s].
void set_closing(Engine& engine, int replica, Against against, double velocity) {
    if (against == Against::grain)
        engine.set_velocities(replica, {{velocity, 0, 0}, Vec3::Zero()}, {Vec3::Zero(), Vec3::Zero()});
    else
        engine.set_velocities(replica, {{0, 0, -velocity}}, {Vec3::Zero()});
}

/// Relative errors of the restitution if the touch occurs at different times within a step.
std::vector<double> restitution_errors(Against against, double restitution, double time_step) {
    constexpr double slow = 0.02;
    constexpr int phases = 16;
    const bool pair = against == Against::grain;
    std::vector<Start> starts(1, collision(against, restitution, time_step));
    const double dt = mcdem::time_step(starts[0].replica, starts[0].packing);
    for (int k = 1; k < phases; ++k)
        starts.push_back(collision(against, restitution, time_step, default_gap + slow * dt * k / phases));
    Batch batch(build(finest()), starts);
    for (int k = 0; k < phases; ++k) set_closing(batch.engine(), k, against, slow);
    const double duration = Hertz(against).duration() * std::pow(speed / slow, 0.2);
    batch.advance(static_cast<int>((default_gap / slow + 1.5 * duration) / dt) + 2);
    std::vector<double> errors;
    for (int k = 0; k < phases; ++k) {
        EXPECT_TRUE(batch.engine().state(k).contacts.empty()) << "they have not parted";
        const auto after = batch.engine().state(k).velocity;
        errors.push_back((pair ? (after[1] - after[0]).x() : after[0].z()) / slow / restitution - 1);
    }
    return errors;
}

// A collision takes about 30 steps. With strong damping the result depends by about one per cent on where in
// a step the collision starts; the mean error over many collisions decreases with the time step.
TEST(Collision, HasThePrescribedRestitution) {
    for (Against against : {Against::grain, Against::floor})
        for (double restitution : {0.95, 0.7, 0.5}) {
            std::vector<double> means;
            for (double time_step : {0.1, 0.05, 0.0125}) {
                const auto errors = restitution_errors(against, restitution, time_step);
                means.push_back(std::accumulate(errors.begin(), errors.end(), 0.0) / errors.size());
                for (double error : errors) EXPECT_LT(std::abs(error), 0.2 * time_step) << restitution;
            }
            fmt::print("restitution {}: error {:.2e}, at half the time step {:.2e}, at an eighth {:.2e}\n",
                       restitution, means[0], means[1], means[2]);
            EXPECT_LT(std::abs(means[0]), 0.01) << restitution;
            EXPECT_LT(std::abs(means[1]), 0.005) << restitution;
            EXPECT_LT(std::abs(means[2]), 0.00125) << restitution;
        }
}

// After an elastic collision the grains separate at their impact velocity, delayed by the duration of the
// contact. The gap at a given time is therefore known. The error is of second order.
TEST(Collision, ErrorIsOfSecondOrderInTheTimeStep) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    for (Against against : {Against::grain, Against::floor}) {
        const bool pair = against == Against::grain;
        const Hertz hertz(against);
        std::vector<double> error;
        for (int refine : {1, 2, 4, 8}) {
            const Start start = collision(against, 1, 0.2 / refine);
            Batch batch(build(Precision::double_precision), start);
            set_closing(batch.engine(), 0, against, speed);
            const double dt = batch.engine().time_step(0), touch = default_gap / speed;
            const int steps =
                refine * static_cast<int>(std::ceil((touch + 1.2 * hertz.duration()) / (dt * refine)));
            batch.advance(steps);
            const auto x = batch.engine().state(0).position;
            const double gap = pair ? (x[1] - x[0]).norm() - radius - other_radius : x[0].z() - radius;
            error.push_back(std::abs(gap - speed * (steps * dt - touch - hertz.duration())));
        }
        fmt::print("error of the gap after a collision: {:.2e} m\n", fmt::join(error, " "));
        // The second derivative of Hertz's force is singular at the touch, which falls at random within a
        // step: the ratio is not 4 each time.
        EXPECT_GT(error[0] / error[2], 10);
        EXPECT_GT(error[1] / error[3], 10);
        EXPECT_LT(error[0] / error[3], 200);
    }
}

}  // namespace
}  // namespace mcdem::reference
