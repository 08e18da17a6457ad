// One grain between six walls, compressed and released by one of them: its energy equals the work done on
// it, and the work of a closed path is zero.
#include <cmath>

#include "core/names.h"
#include "reference/test_scene.h"

namespace mcdem::reference::surface_energy {
namespace {

constexpr double radius = 0.01;

/// Walls at these overlaps along x, y and z, over the radius. No friction, no damping.
Start boxed(ContactModel model, double x, double y, double z) {
    Replica replica = test_replica(model);
    replica.grains = {23.3e3, 0.45, 1000, 0, 0, 1, 0};
    replica.walls = {1e13, 0.45, 0, 1};
    replica.numerics.time_step = 0.02;
    replica.box = {2 * radius * (1 - x), 2 * radius * (1 - y)};
    replica.plate.start = 2 * radius * (1 - z);
    const Vec3 middle(replica.box.size_x / 2, replica.box.size_y / 2, replica.plate.start / 2);
    return {replica, {{middle}, {2 * radius}}};
}

struct Squeezed {
    double work = 0, energy = 0, force = 0;
};

/// Moves the plate by `change` (in radii, per side) in steps; the grain is kept in the middle. Then
/// everything is at rest until the delayed displacements have converged.
class Path {
public:
    explicit Path(const Start& start) : batch_(build(finest()), start), plate_(start.replica.plate.start) {
        for (int rest = 0; rest < 40; ++rest) step(0);
    }
    Squeezed move(double change, int steps) {
        Squeezed s;
        double before = force_;
        for (int k = 0; k < steps; ++k) {
            step(-2 * radius * change / steps);
            s.work += (before + force_) / 2 * 2 * radius * change / steps;
            before = force_;
        }
        for (int rest = 0; rest < 40; ++rest) step(0);
        s.energy = energy_;
        s.force = force_;
        return s;
    }

private:
    void step(double by) {
        const double velocity = by / batch_.engine().time_step(0);
        batch_.engine().set_velocities(0, {{0, 0, velocity / 2}}, {Vec3::Zero()});
        const auto result = batch_.engine().advance({{1, plate_, velocity, 0}}).front();
        ASSERT_EQ(result.status, 0);
        plate_ += by;
        force_ = result.wall_force[static_cast<int>(mcdem::Wall::plate)].z();
        energy_ = result.elastic_energy;
    }
    Batch batch_;
    double plate_, force_ = 0, energy_ = 0;
};

TEST(SurfaceEnergy, EqualsTheWorkDoneOnTheGrain) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    for (ContactModel model : {ContactModel::independent, ContactModel::point_force_on_sphere,
                               ContactModel::elastic_sphere, ContactModel::hyperelastic_sphere}) {
        Path path(boxed(model, 0.06, 0.04, 0.02));
        const double begun = path.move(0, 1).energy;
        const Squeezed there = path.move(0.06, 2000), back = path.move(-0.06, 2000);
        // displacements are delayed: the force is that of some steps before
        EXPECT_NEAR((there.energy - begun) / there.work, 1, 2e-4) << name(model);
        EXPECT_NEAR(back.work / there.work, -1, 2e-4) << name(model);
        EXPECT_NEAR(back.energy / begun, 1, 1e-6) << name(model);
        EXPECT_GT(there.energy, 1.5 * begun) << name(model);
    }
}

Start with_finite_strain(ContactModel model, double share) {
    Start start = boxed(model, 0.06, 0.04, 0.02);
    start.replica.effects.finite_strain = share;
    return start;
}

TEST(FiniteStrain, InterpolatesBetweenElasticAndHyperelasticSphere) {
    const auto force = [](ContactModel model, double share) {
        return Path(with_finite_strain(model, share)).move(0.06, 100).force;
    };
    const double elastic = force(ContactModel::elastic_sphere, 0);
    const double hyperelastic = force(ContactModel::hyperelastic_sphere, 0);
    EXPECT_EQ(force(ContactModel::elastic_sphere, 1), hyperelastic);
    EXPECT_EQ(force(ContactModel::hyperelastic_sphere, 0.5), hyperelastic) << "unused by other models";
    EXPECT_EQ(force(ContactModel::point_force_on_sphere, 1), force(ContactModel::point_force_on_sphere, 0));
    const double half = force(ContactModel::elastic_sphere, 0.5);
    EXPECT_GT(half, elastic + 0.3 * (hyperelastic - elastic));
    EXPECT_LT(half, elastic + 0.7 * (hyperelastic - elastic));
    EXPECT_GT(hyperelastic, 1.005 * elastic);
}

}  // namespace
}  // namespace mcdem::reference::surface_energy
