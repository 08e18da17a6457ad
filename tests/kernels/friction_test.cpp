// Mindlin friction at one contact with the floor, with prescribed motion of the grain: Mindlin's stiffness,
// the Coulomb limit, and the hysteresis loop of cyclic shear.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/test_scene.h"

namespace mcdem::reference::friction {
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

// From rest to slip, to slip in the other direction, and back: at every step the force is that of a spring of
// Mindlin's stiffness that yields at the Coulomb limit. tests/truth/pair_motions_test.py has pairs and
// turning contacts.
TEST(Mindlin, CyclicShearFollowsTheHysteresisLoop) {
    ShearedGrain grain;
    const double slip = ShearedGrain::slip(), limit = friction * ShearedGrain::weight();
    double expected = 0;
    for (const auto& [distance, steps] :
         {std::pair(0.5, 20), {-0.5, 20}, {3.0, 300}, {-6.0, 600}, {6.0, 600}}) {
        const auto forces = grain.shear(distance * slip, steps);
        for (std::size_t step = 0; step < forces.size(); ++step) {
            expected = std::clamp(expected - distance / steps * limit, -limit, limit);
            EXPECT_NEAR(forces[step], expected, 1e-3 * std::abs(expected) + 1e-4 * limit)
                << distance << ", step " << step;
        }
        if (distance == 0.5) {
            EXPECT_NEAR(forces[0] / expected * steps, 1, 1e-3) << "the first step";
        }
    }
}

}  // namespace
}  // namespace mcdem::reference::friction
