// Springs of a pair of grains on prescribed paths: what changes of the normal load leave of their force, and
// how they turn with the pair.
#include <cmath>
#include <numbers>

#include "kernels/saved_rows.h"
#include "kernels/test_kernel.h"
#include "reference/moved_pair.h"

namespace mcdem::reference::turning_springs {
namespace {

using std::numbers::pi;
constexpr double shear = 1e-5;

/// Both precisions and both layouts.
std::vector<KernelBuild> builds() {
    std::vector<KernelBuild> all = all_ways(build(Precision::single_precision));
    if (has_double())
        for (const KernelBuild& way : all_ways(build(Precision::double_precision))) all.push_back(way);
    return all;
}
/// Float: positions of 0.01 m are rounded to 5e-10 m in each step, which adds up to some 1e-3 of the ways;
/// the contact radius of a spring may be 5e-4 above the contact's.
double tolerance(const KernelBuild& way, double in_double) {
    return way.precision == Precision::double_precision ? in_double : std::max(in_double, 1e-2);
}

// A contact is sheared, loaded to four times its overlap, that is twice its radius a, sheared back, unloaded.
// A spring that keeps its force: k1 s, k1 s, k1 s - k2 s, (k1 - k2) s k1/k2, with k2 = 2 k1. The work of the
// cycle is (k2 - k1) s^2/2, as large as that of the shear. A spring that keeps its displacement: k1 s, k2 s,
// 0, 0, and it returns twice the work of the shear. The normal is up to s/(2R) off the direction of the load:
// of its way of 30 s, 0.15 % of s are shear, at stiffness k2.
TEST(LoadedSpring, KeepsForceOrDisplacement) {
    constexpr double overlap = 1e-5, little = 1e-6;
    for (const KernelBuild& way : builds())
        for (FrictionLaw law : {FrictionLaw::mindlin, FrictionLaw::mindlin_displacement}) {
            const bool keeps_force = law == FrictionLaw::mindlin;
            MovedPair pair(way, MovedPair::start(overlap, 10, law));
            const double work_of_shear = pair.move_second({0, little, 0}, 100);
            const double sheared = pair.tangential().y(), allowed = tolerance(way, 4e-3);
            ASSERT_GT(sheared, 0);
            double work = work_of_shear + pair.move_second({-3 * overlap, 0, 0}, 500);
            EXPECT_NEAR(pair.tangential().y() / sheared, keeps_force ? 1 : 2, allowed);
            work += pair.move_second({0, -little, 0}, 100);
            EXPECT_NEAR(pair.tangential().y() / sheared, keeps_force ? -1 : 0, allowed);
            work += pair.move_second({3 * overlap, 0, 0}, 500);
            EXPECT_NEAR(pair.tangential().y() / sheared, keeps_force ? -0.5 : 0, allowed);
            EXPECT_NEAR(work / work_of_shear, keeps_force ? 1 : -1, 5 * allowed);
        }
}

// Unloading alone: the force decreases with the contact radius, which is the root of the overlap, down to the
// end of the contact; the next contact begins without.
TEST(LoadedSpring, LosesForceWithTheContactRadius) {
    constexpr double overlap = 1e-5;
    for (const KernelBuild& way : builds()) {
        MovedPair pair(way, MovedPair::start(overlap, 10, FrictionLaw::mindlin));
        pair.move_second({0, 1e-6, 0}, 100);
        const double sheared = pair.tangential().y();
        for (int part = 1; part <= 3; ++part) {
            pair.move_second({overlap / 4, 0, 0}, 100);
            EXPECT_NEAR(pair.tangential().y() / sheared, std::sqrt(1 - part / 4.0), tolerance(way, 1e-3));
        }
        pair.move_second({overlap / 2, 0, 0}, 20);
        EXPECT_TRUE(pair.engine().state(0).contacts.empty());
        pair.move_second({-overlap / 2, 0, 0}, 20);
        EXPECT_NEAR(pair.tangential().norm() / sheared, 0, tolerance(way, 1e-3));
    }
}

// A pair turned as one body takes its tangential force along, about any axis. The errors of a step are of
// third order in its angle.
TEST(TurningSpring, TurnsWithThePair) {
    for (const KernelBuild& way : builds()) {
        for (int k = 0; k < 4; ++k) {
            MovedPair pair(way, MovedPair::start(2e-4, 0.5, FrictionLaw::mindlin));
            pair.move_second({0, shear, 0}, 200);
            const Vec3 n = pair.normal(), force = pair.tangential(), t = force.normalized();
            const std::vector<Vec3> axes{n, t, n.cross(t), (t + n.cross(t)).normalized()};
            for (int quarter = 1; quarter <= 4; ++quarter) {
                pair.turn_together(axes[k], pi / 2, 500);
                const Vec3 wanted = Eigen::AngleAxisd(quarter * pi / 2, axes[k]) * force;
                EXPECT_LT((pair.tangential() - wanted).norm() / force.norm(), tolerance(way, 1e-4))
                    << "axis " << k << ", quarter " << quarter;
                EXPECT_NEAR(pair.tangential().norm() / force.norm(), 1, tolerance(way, 1e-5));
            }
        }
    }
}

// About the normal a spring turns by the mean of the two grains' turns.
TEST(TurningSpring, TurnsByTheMeanOfBothSpins) {
    for (const auto& [here, there] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {1.5, -0.5}, {1.0, -1.0}}) {
        MovedPair pair(build(finest()), MovedPair::start(2e-4, 0.5, FrictionLaw::mindlin));
        pair.move_second({0, shear, 0}, 200);
        const Vec3 n = pair.normal(), force = pair.tangential();
        pair.move(Vec3::Zero(), Vec3::Zero(), here * pi / 2 * n, there * pi / 2 * n, 500);
        const Vec3 wanted = Eigen::AngleAxisd((here + there) / 2 * pi / 2, n) * force;
        EXPECT_LT((pair.tangential() - wanted).norm() / force.norm(), 1e-4) << here << " " << there;
    }
}

/// Force of the wall on a grain without weight that touches it.
Vec3 wall_force(Engine& engine) {
    const auto state = engine.state(0);
    return state.contacts.empty() ? Vec3::Zero() : state.contacts.at(0).force;
}

// The spin of a wall is zero: a grain that turns about the normal takes half of its turn along. A plane
// wall's normal does not turn with a grain that rolls along it.
TEST(TurningSpring, AtAWall) {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e6, 0.3, 1000, 0, 10, 1, 0};
    replica.walls = {1e13, 0.3, 10, 1};
    replica.numerics.time_step = 5e-5;
    Start start = free_cluster(replica, {Vec3::Zero()}, {0.02});
    start.packing.position[0].z() = 0.01 - 1e-4;
    Batch batch(build(finest()), start);
    const double dt = batch.engine().time_step(0);
    const auto move = [&](const Vec3& way, const Vec3& turn, int steps) {
        for (int s = 0; s < steps; ++s) {
            batch.engine().set_velocities(0, {way / steps / dt}, {turn / steps / dt});
            batch.advance(1);
        }
    };
    move({shear, 0, 0}, Vec3::Zero(), 100);
    const Vec3 force = wall_force(batch.engine());
    ASSERT_LT(force.x(), 0);
    move(Vec3::Zero(), {0, 0, pi / 2}, 500);
    Vec3 turned = wall_force(batch.engine());
    EXPECT_NEAR(turned.x() / force.x(), std::cos(pi / 4), 1e-3);
    EXPECT_NEAR(turned.y() / force.x(), std::sin(pi / 4), 1e-3);
    const double radius = 0.01 - 1e-4;  // to the wall
    move({radius, 0, 0}, {0, 1, 0}, 1000);
    EXPECT_LT((wall_force(batch.engine()) - turned).norm() / force.norm(), 1e-3)
        << "it rolls without sliding";
}

// A grain that rolls around inside a cylinder takes its spring along, the axial part and that around the
// axis.
TEST(TurningSpring, GoesAroundACylinder) {
    constexpr double radius = 0.01, cylinder = 0.04, overlap = 1e-4, orbit = cylinder - radius + overlap;
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e6, 0.3, 1000, 0, 10, 1, 0};
    replica.walls = {1e13, 0.3, 10, 1};
    replica.numerics.time_step = 5e-5;
    replica.box = {2 * cylinder, 2 * cylinder, mcdem::ContainerShape::cylinder};
    replica.plate.start = 0.1;
    replica.plate.end = 0.05;
    const Start start{replica, {{Vec3(cylinder + orbit, cylinder, 0.05)}, {2 * radius}}};
    Batch batch(build(finest()), start);
    const double dt = batch.engine().time_step(0);
    const auto step = [&](const Vec3& to, const Vec3& turn) {
        const Vec3 now = batch.engine().state(0).position[0];
        batch.engine().set_velocities(0, {(to - now) / dt}, {turn / dt});
        batch.advance(1);
    };
    const Vec3 axis(cylinder, cylinder, 0.05);
    for (int s = 1; s <= 100; ++s)
        step(axis + Vec3(orbit, 0, shear * s / 100), Vec3(0, 0, shear / radius / 100));
    const Vec3 force = wall_force(batch.engine());
    ASSERT_LT(force.z(), 0);
    ASSERT_GT(std::abs(force.y()), 0.1 * std::abs(force.z()));
    const int steps = 1000;
    const double angle = pi / 2, roll = -angle * orbit / (radius - overlap);
    for (int s = 1; s <= steps; ++s) {
        const Vec3 out(std::cos(angle * s / steps), std::sin(angle * s / steps), 0);
        step(axis + orbit * out + Vec3(0, 0, shear), {0, 0, roll / steps});
    }
    const Vec3 turned = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * force, now = wall_force(batch.engine());
    const Vec3 out = Vec3::UnitY();
    EXPECT_LT(((now - now.dot(out) * out) - (turned - turned.dot(out) * out)).norm() / std::abs(force.z()),
              2e-2);
}

// Momentum: both grains store opposite forces, to the last bit.
TEST(TurningSpring, IsOppositeOnBothSidesToTheLastBit) {
    for (const KernelBuild& way : builds()) {
        std::vector<Start> starts;
        for (unsigned seed = 1; seed <= 6; ++seed)
            for (FrictionLaw law : {FrictionLaw::mindlin, FrictionLaw::mindlin_displacement}) {
                Replica replica = test_replica(seed % 2 ? ContactModel::mc_dem : ContactModel::independent);
                replica.contact.friction_law = law;
                if (seed > 2) replica.effects.rolling_resistance = 0.2;
                Uniform uniform(seed);
                starts.push_back(
                    free_cluster(replica, {uniform.vector(1e-3), {0.0155, 5e-3, -4e-3}}, {0.02, 0.015}));
            }
        Batch batch(way, starts);
        Uniform uniform(9);
        for (std::size_t r = 0; r < starts.size(); ++r)
            batch.engine().set_velocities(r, uniform.vectors(2, 0.02), uniform.vectors(2, 20));
        batch.advance(8);
        const SavedRows rows(batch, way, starts);
        int compared = 0;
        for (int r = 0; r < static_cast<int>(starts.size()); ++r)
            for (int row : {0, 1, 2, 4, 5, 6}) {
                const double here = rows.by_partner("contact_memory", r, 0, row).at(1);
                const double there = rows.by_partner("contact_memory", r, 1, row).at(0);
                EXPECT_EQ(here, -there) << "replica " << r << ", row " << row;
                compared += here != 0;
            }
        EXPECT_GT(compared, 30);
    }
}

// In float, positions of half a metre are rounded to 3e-8 m in each step, 3e-4 of this overlap. A pair that
// moves on while its load grows by 2 % keeps its force, although the rounded overlap decreases in many steps.
// (If each decrease counted, a tenth of the force would be lost.)
TEST(LoadedSpring, IsNotWornByRoundingErrors) {
    MovedPair pair(build(Precision::single_precision),
                   MovedPair::start(1e-4, 100, FrictionLaw::mindlin, {}, Vec3::Constant(0.4)));
    pair.move_second({0, 10 * shear, 0}, 200);
    const double sheared = pair.tangential().norm();
    const Vec3 far(1.1e-3, 1.3e-3, 0), closer(-2e-6, 0, 0);
    pair.move(far, far + closer, Vec3::Zero(), Vec3::Zero(), 4000);
    EXPECT_NEAR(pair.tangential().norm() / sheared, 1, 0.03);
}

TEST(SpringEnergy, IsHalfTheSquareOfTheForceOverTheStiffness) {
    const auto energy = mapped_rows(
        "const lanes stiffness = in[3]; const lanes3 force = {in[0], in[1], in[2]};\n"
        "const lanes energy = spring_energy(force, stiffness); out[0] = LANE(real, energy, 0);",
        {}, {3, -4, 12, 2, 0, 0, 0, 0, 1, 0, 0, 4}, 4, 1);
    EXPECT_EQ(energy, (std::vector<float>{169.F / 4, 0, 1.F / 8}));
}

}  // namespace
}  // namespace mcdem::reference::turning_springs
