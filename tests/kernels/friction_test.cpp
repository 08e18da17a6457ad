// Mindlin friction at one contact with the floor, with prescribed motion of the grain: Mindlin's stiffness,
// the Coulomb limit, and the hysteresis loop of cyclic shear.
#include <cmath>
#include <numbers>

#include "reference/test_scene.h"

namespace reference::friction {
namespace {

constexpr double radius = 0.01, friction = 0.2, youngs_modulus = 1e6, poisson_ratio = 0.3, gravity = 9.81;

/// A grain on the floor with restitution 1, so that there is no damping.
class ShearedGrain {
public:
    ShearedGrain() : batch_(build(finest()), start()) {}

    /// Moves the grain along x by `distance` in `steps` steps. Returns the floor's force on it along x after
    /// each step [N].
    std::vector<double> shear(double distance, int steps) {
        const double velocity = distance / (steps * batch_.engine().time_step(0));
        std::vector<double> forces;
        for (int step = 0; step < steps; ++step) {
            batch_.engine().set_velocities(0, {{velocity, 0, 0}}, {Vec3::Zero()});
            const auto result = batch_.advance(1).front();
            forces.push_back(-result.wall_force[static_cast<int>(mcdem::Wall::floor)].x());
        }
        return forces;
    }
    static double weight() { return 1000 * gravity * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3); }
    static double overlap() {
        const double modulus = youngs_modulus / (1 - poisson_ratio * poisson_ratio);
        return std::pow(weight() / (4.0 / 3 * modulus * std::sqrt(radius)), 2.0 / 3);
    }
    /// 8 G* a; 1/G* = (2 - nu)/G for a rigid floor.
    static double stiffness() {
        const double shear_modulus = youngs_modulus / (2 * (1 + poisson_ratio));
        return 8 * shear_modulus / (2 - poisson_ratio) * std::sqrt(radius * overlap());
    }
    /// Displacement at which the contact begins to slip.
    static double slip() { return friction * weight() / stiffness(); }

private:
    static Start start() {
        Replica replica = test_replica(ContactModel::independent);
        replica.grains = {youngs_modulus, poisson_ratio, 1000, 1000, friction, 1, 0};
        replica.walls = {1e13, poisson_ratio, friction, 1};
        replica.contact.friction_law = FrictionLaw::mindlin;
        Start start = free_cluster(replica, {Vec3::Zero()}, {2 * radius});
        start.packing.position[0].z() = radius - overlap();
        return start;
    }
    Batch batch_;
};

TEST(Mindlin, SmallShearHasMindlinsStiffness) {
    ShearedGrain grain;
    const double distance = 0.5 * ShearedGrain::slip();
    const auto forces = grain.shear(distance, 20);
    for (int step = 1; step <= 20; ++step)
        EXPECT_NEAR(forces[step - 1] / (-ShearedGrain::stiffness() * distance * step / 20), 1, 1e-3) << step;
    const auto back = grain.shear(-distance, 20);
    EXPECT_NEAR(back.back() / forces.back(), 0, 1e-3) << "the spring has kept nothing";
}

TEST(Mindlin, LargeShearReachesTheCoulombLimit) {
    ShearedGrain grain;
    const auto forces = grain.shear(5 * ShearedGrain::slip(), 100);
    for (int step = 21; step <= 100; ++step)
        EXPECT_NEAR(forces[step - 1] / (-friction * ShearedGrain::weight()), 1, 1e-3) << step;
    for (double force : forces) EXPECT_LE(std::abs(force), 1.001 * friction * ShearedGrain::weight());
}

// From slip in one direction to slip in the other. The force-displacement loop is a parallelogram of height
// 2 mu F and width 2 (amplitude - slip): the work lost in a cycle is 4 mu F (amplitude - slip).
TEST(Mindlin, CyclicShearFollowsTheHysteresisLoop) {
    ShearedGrain grain;
    const double slip = ShearedGrain::slip(), amplitude = 3 * slip, limit = friction * ShearedGrain::weight();
    grain.shear(amplitude, 300);
    const auto back = grain.shear(-2 * amplitude, 600), forth = grain.shear(2 * amplitude, 600);
    const double step = 2 * amplitude / 600;
    double work = 0;
    for (double force : back) work += force * step;  // against the motion: positive on the way back
    for (double force : forth) work -= force * step;
    EXPECT_NEAR(work / (4 * limit * (amplitude - slip)), 1, 0.01);
    // after the slip length the force is zero; after twice the slip length it is reversed
    EXPECT_NEAR(back[99] / limit, 0, 0.02);
    EXPECT_NEAR(back[199] / limit, 1, 0.02);
    EXPECT_NEAR(forth.back() / limit, -1, 1e-3);
}

}  // namespace
}  // namespace reference::friction
