// Cylinders and periodic containers: closed-form solutions, symmetries, conservation laws.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/container.h"
#include "core/errors.h"
#include "core/names.h"
#include "sim/whole_run.h"

namespace mcdem::reference::containers {
namespace {

using mcdem::ContainerShape;
using std::numbers::pi;

constexpr double radius = 0.01;

/// No weight, friction or damping.
Replica conservative(ContactModel model) {
    Replica replica = test_replica(model);
    replica.grains = {23.3e3, 0.45, 1000, 0, 0, 1, 0};
    replica.walls = {1e12, 0.45, 0, 1};
    return replica;
}

double modulus_at_wall(const Replica& replica) {
    const auto& g = replica.grains;
    const auto& w = replica.walls;
    return 1 / ((1 - g.poisson_ratio * g.poisson_ratio) / g.youngs_modulus +
                (1 - w.poisson_ratio * w.poisson_ratio) / w.youngs_modulus);
}

Vec3 force_on(const mcdem::IntervalResult& result, mcdem::Wall wall) {
    return result.wall_force[static_cast<std::size_t>(wall)];
}

/// One grain in a cylinder, `overlap` deep in its wall at this angle; returns the force on the wall.
Vec3 force_on_cylinder(double cylinder, double overlap, double angle) {
    Replica replica = conservative(ContactModel::independent);
    replica.box = {2 * cylinder, 2 * cylinder, ContainerShape::cylinder};
    replica.plate.start = 0.1;
    replica.plate.end = 0.09;
    replica.numerics.time_step = 1e-9;  // the grain does not move
    const double out = cylinder - radius + overlap;
    const Start start{
        replica,
        {{{cylinder + out * std::cos(angle), cylinder + out * std::sin(angle), 0.05}}, {2 * radius}}};
    Batch batch(build(finest()), start);
    const auto result = batch.advance(1).front();
    const auto contacts = batch.engine().state(0).contacts;
    EXPECT_EQ(contacts.size(), 1u);
    const Vec3 way(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR((contacts.front().point - Vec3(cylinder, cylinder, 0.05) - cylinder * way).norm(), 0,
                1e-6 * radius);
    EXPECT_LT((contacts.front().force + force_on(result, mcdem::curved_wall)).norm(),
              1e-6 * contacts.front().force.norm());
    return force_on(result, mcdem::curved_wall);
}

// R*/R of Hertz's elliptical contact between a sphere and a cylinder, from complete elliptic integrals
// (Johnson 1985, section 4.2), at R/R_c = 0.05, 0.1, 0.25 and 0.5. With the geometric mean, forces are too
// small by at most 0.2 % up to 0.25 and 1 % at 0.5.
TEST(Cylinder, WallForceAgreesWithHertz) {
    const Replica replica = conservative(ContactModel::independent);
    const double overlap = 2e-4, allowed = has_double() ? 1e-6 : 1e-3;
    for (const auto& [ratio, exact, lack] :
         {std::tuple(0.05, 1.0260908271, 5.5e-5), std::tuple(0.1, 1.0545801456, 2.3e-4),
          std::tuple(0.25, 1.1586846708, 1.72e-3), std::tuple(0.5, 1.4426201027, 9.9e-3)})
        for (const double angle : {0.3, 2.0, 4.4}) {
            const Vec3 force = force_on_cylinder(radius / ratio, overlap, angle);
            const double hertz =
                4.0 / 3 * modulus_at_wall(replica) * std::sqrt(exact * radius) * std::pow(overlap, 1.5);
            EXPECT_NEAR(force.norm() / hertz, 1 - lack, 0.02 * lack + allowed) << ratio;
            EXPECT_NEAR(std::atan2(force.y(), force.x()), std::remainder(angle, 2 * pi), 10 * allowed);
        }
}

// All grains of the ring have the same forces; the net force on the wall is zero.
TEST(Cylinder, HoldsARingOfGrains) {
    const double cylinder = 0.04, ring = cylinder - 0.97 * radius;
    const int count = 9;
    Replica replica = conservative(ContactModel::mc_dem);
    replica.box = {2 * cylinder, 2 * cylinder, ContainerShape::cylinder};
    Start start{replica, {}};
    for (int i = 0; i < count; ++i) {
        const double angle = 0.1 + 2 * pi * i / count;
        start.packing.position.push_back(
            {cylinder + ring * std::cos(angle), cylinder + ring * std::sin(angle), 0.05});
        start.packing.diameter.push_back(2.15 * ring * std::sin(pi / count));
    }
    Batch batch(build(finest()), start);
    const auto result = batch.advance(10).front();
    EXPECT_EQ(result.status, 0);
    double least = 1e9, most = 0, pairs = 0;
    for (const auto& contact : batch.engine().state(0).contacts) {
        pairs += !mcdem::is_wall(contact.partner);
        if (!mcdem::is_wall(contact.partner)) continue;
        EXPECT_EQ(mcdem::wall_of(contact.partner), mcdem::curved_wall);
        least = std::min(least, contact.force.norm());
        most = std::max(most, contact.force.norm());
    }
    EXPECT_EQ(pairs, count);
    EXPECT_GT(least, 0);
    EXPECT_LT(most / least - 1, has_double() ? 1e-9 : 2e-3);
    EXPECT_LT(force_on(result, mcdem::curved_wall).norm() / most, has_double() ? 1e-9 : 2e-3);
}

TEST(Cylinder, WallsCarryTheWeight) {
    Replica replica = test_replica(ContactModel::mc_dem);
    replica.grains.excess_density = 1000;
    replica.contact.friction_law = FrictionLaw::mindlin;
    const Start start = rings_in_a_cylinder(replica, 3, 5);
    Batch batch(build(finest()), start);
    const auto result = batch.advance(6000, 0.3 / batch.engine().time_step(0)).front();
    ASSERT_EQ(result.status, 0);
    double weight = 0;
    for (double diameter : start.packing.diameter) weight += 1000 * 9.81 * pi / 6 * std::pow(diameter, 3);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& force : result.wall_force) sum += force;
    EXPECT_NEAR(sum.z() / -weight, 1, 2e-3);
    EXPECT_LT(std::hypot(sum.x(), sum.y()) / weight, 2e-3);
    EXPECT_LT(force_on(result, mcdem::curved_wall).z(), -0.05 * weight)
        << "friction at the side carries a part";
    for (const mcdem::Wall wall : {mcdem::Wall::x_max, mcdem::Wall::y_min, mcdem::Wall::y_max})
        EXPECT_EQ(force_on(result, wall).norm(), 0);
}

// A simple cubic crystal between plates: Hertz force at every contact; closed form for the force on the
// plate.
TEST(PeriodicCell, CrystalHasTheExpectedPressure) {
    const double spacing = 0.0194, wall_overlap = 3e-4;
    for (const int side : {3, 4, 9}) {
        Replica replica = conservative(ContactModel::independent);
        replica.box = {side * spacing, side * spacing, ContainerShape::periodic};
        replica.numerics.time_step = 1e-9;
        replica.plate.start = 2 * (radius - wall_overlap) + spacing;
        Start start{replica, {}};
        for (int i = 0; i < 2 * side * side; ++i) {
            start.packing.position.push_back(spacing * Vec3(i % side, i / side % side, i / (side * side)) +
                                             Vec3(0.001, -0.003, radius - wall_overlap));
            start.packing.diameter.push_back(2 * radius);
        }
        Batch batch(build(finest()), start);
        const auto result = batch.advance(1).front();
        const double modulus = replica.grains.youngs_modulus / (1 - 0.45 * 0.45) / 2;
        const double pair = 4.0 / 3 * modulus * std::sqrt(radius / 2) * std::pow(2 * radius - spacing, 1.5);
        const double wall =
            4.0 / 3 * modulus_at_wall(replica) * std::sqrt(radius) * std::pow(wall_overlap, 1.5);
        const double allowed = has_double() ? 1e-6 : 2e-3;
        EXPECT_NEAR(force_on(result, mcdem::Wall::plate).z() / (side * side * wall), 1, allowed);
        EXPECT_NEAR(-force_on(result, mcdem::Wall::floor).z() / (side * side * wall), 1, allowed);
        int pairs = 0;
        double virial = 0;  // sum of f . b along x
        const auto state = batch.engine().state(0);
        for (const auto& contact : state.contacts) {
            if (mcdem::is_wall(contact.partner)) continue;
            ++pairs;
            EXPECT_NEAR(contact.force.norm() / pair, 1, allowed);
            const Vec3 branch =
                mcdem::apart(replica.box, state.position[contact.grain], state.position[contact.partner]);
            EXPECT_NEAR(branch.norm(), spacing, 1e-6);
            virial -= contact.force.x() * branch.x();
        }
        EXPECT_EQ(pairs, (4 + 1) * side * side) << "along x and y in both layers, and between them";
        const double area = side * spacing * 2 * spacing;  // two layers, each as high as wide
        EXPECT_NEAR(virial / (side * spacing * area) / (pair / (spacing * spacing)), 1, allowed);
    }
}

/// All models in one batch; grains at rest between floor and plate of a periodic container.
std::vector<Start> periodic_starts(const Replica& like, int layers) {
    std::vector<Start> starts;
    for (ContactModel model : all_models) {
        Replica replica = like;
        replica.contact.model = model;
        replica.contact.friction_law = FrictionLaw::mindlin;
        starts.push_back(periodic_lattice(replica, 4, layers, 31));
    }
    return starts;
}

TEST(PeriodicCell, ConservesMomentumToRounding) {
    Replica replica = test_replica();
    replica.grains.drag = replica.grains.excess_density = 0;
    auto starts = periodic_starts(replica, 2);
    for (Start& start : starts) {
        start.replica.plate.start = 0.5;  // far from floor and plate
        for (Vec3& x : start.packing.position) x.z() += 0.2;
    }
    Batch batch(build(finest()), starts);
    Uniform uniform(3);
    const std::size_t count = starts[0].packing.size();
    const auto velocity = uniform.vectors(count, 0.1), spin = uniform.vectors(count, 10);
    for (std::size_t r = 0; r < starts.size(); ++r)
        batch.engine().set_velocities(static_cast<int>(r), velocity, spin);
    const auto momentum = [&](std::size_t r, const std::vector<Vec3>& v) {
        std::pair<Vec3, double> sum{Vec3::Zero(), 0};
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 one = std::pow(starts[r].packing.diameter[i], 3) * v[i];
            sum = {sum.first + one, sum.second + one.norm()};
        }
        return sum;
    };
    batch.advance(200);
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const auto [before, size] = momentum(r, velocity);
        const auto [after, other_size] = momentum(r, batch.engine().state(static_cast<int>(r)).velocity);
        EXPECT_LT((after - before).norm() / size, has_double() ? 1e-13 : 1e-5) << name(all_models[r]);
        EXPECT_GT(std::abs(other_size - size) / size, 1e-2) << "nothing has happened";
    }
}

/// The packings after thirty steps.
std::vector<mcdem::ReplicaState> after_steps(const std::vector<Start>& starts,
                                             std::vector<mcdem::IntervalResult>* results = nullptr) {
    Batch batch(build(finest()), starts);
    const auto last = batch.advance(30);
    if (results) *results = last;
    std::vector<mcdem::ReplicaState> states;
    for (std::size_t r = 0; r < starts.size(); ++r)
        states.push_back(batch.engine().state(static_cast<int>(r)));
    return states;
}

// Translation by lattice vectors (equal for all grains, or different), translation by any vector, and a
// quarter turn about the vertical.
TEST(PeriodicCell, TranslationAndRotationChangeNothing) {
    const double allowed = has_double() ? 1e-11 : 2e-3;
    const auto starts = periodic_starts(test_replica(), 3);
    const double cell = starts[0].replica.box.size_x;
    const auto original = after_steps(starts);
    const auto quarter = [](const Vec3& x) -> Vec3 { return {-x.y(), x.x(), x.z()}; };
    const auto same = [](const Vec3& x) -> Vec3 { return x; };
    struct Change {
        const char* what;
        std::function<Vec3(const Vec3&, std::size_t)> point;
        std::function<Vec3(const Vec3&)> direction;
    };
    const std::vector<Change> changes{
        {"a lattice vector", [&](const Vec3& x, std::size_t) -> Vec3 { return x + Vec3(cell, -2 * cell, 0); },
         same},
        {"lattice vectors",
         [&](const Vec3& x, std::size_t i) -> Vec3 {
             return x + cell * Vec3(double(i % 3) - 1, double(i % 5) - 2, 0);
         },
         same},
        {"any vector", [](const Vec3& x, std::size_t) -> Vec3 { return x + Vec3(0.0123, -0.0456, 0); }, same},
        {"a quarter turn", [&](const Vec3& x, std::size_t) { return quarter(x); }, quarter}};
    for (const Change& change : changes) {
        auto moved = starts;
        for (Start& start : moved)
            for (std::size_t i = 0; i < start.packing.size(); ++i)
                start.packing.position[i] = change.point(start.packing.position[i], i);
        const auto states = after_steps(moved);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            auto velocity = original[r].velocity, forces = forces_of(original[r]);
            for (auto* vectors : {&velocity, &forces})
                for (Vec3& v : *vectors) v = change.direction(v);
            EXPECT_LT(relative_difference(states[r].velocity, velocity), allowed) << change.what;
            EXPECT_LT(relative_difference(forces_of(states[r]), forces), allowed) << change.what;
        }
    }
}

TEST(PeriodicCell, FourTilesGiveFourTimesTheForce) {
    const auto starts = periodic_starts(test_replica(), 3);
    auto tiled = starts;
    for (Start& start : tiled) {
        const double cell = start.replica.box.size_x;
        const Packing one = start.packing;
        for (const Vec3& shift : {Vec3(cell, 0, 0), Vec3(0, cell, 0), Vec3(cell, cell, 0)})
            for (std::size_t i = 0; i < one.size(); ++i) {
                start.packing.position.push_back(one.position[i] + shift);
                start.packing.diameter.push_back(one.diameter[i]);
            }
        start.replica.box.size_x = start.replica.box.size_y = 2 * cell;
    }
    std::vector<mcdem::IntervalResult> one, four;
    const auto states = after_steps(starts, &one), tiles = after_steps(tiled, &four);
    for (std::size_t r = 0; r < starts.size(); ++r) {
        EXPECT_EQ(tiles[r].contacts.size(), 4 * states[r].contacts.size());
        EXPECT_LT((force_on(four[r], mcdem::Wall::plate) - 4 * force_on(one[r], mcdem::Wall::plate)).norm() /
                      force_on(one[r], mcdem::Wall::plate).norm(),
                  has_double() ? 1e-11 : 2e-3);
        EXPECT_NEAR(four[r].elastic_energy / (4 * one[r].elastic_energy), 1, has_double() ? 1e-11 : 1e-4);
    }
}

// Hertz contacts alone, with initial velocities: kinetic plus elastic energy is constant.
TEST(Containers, ConserveEnergy) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    Replica replica = conservative(ContactModel::independent);
    replica.numerics.time_step = 0.02;
    const std::vector<Start> starts{rings_in_a_cylinder(replica, 2, 7), periodic_lattice(replica, 4, 2, 8)};
    Batch batch(build(Precision::double_precision), starts);
    batch.advance(1);
    std::vector<double> most(2, 0), first(2, 0), drift(2, 0);
    for (int step = 0; step < 4000; ++step) {
        const auto results = batch.advance(1);
        for (int r = 0; r < 2; ++r) {
            ASSERT_EQ(results[r].status, 0);
            const double energy = results[r].elastic_energy + results[r].kinetic_energy;
            most[r] = std::max(most[r], results[r].kinetic_energy);
            if (step == 0) first[r] = energy;
            drift[r] = std::max(drift[r], std::abs(energy - first[r]));
        }
    }
    for (int r = 0; r < 2; ++r) EXPECT_LT(drift[r] / most[r], 0.02) << r;
}

TEST(PeriodicCell, IsRefusedIfGrainsCouldTouchTwice) {
    Start start = periodic_lattice(test_replica(), 3, 2, 3);
    start.replica.numerics.skin = 0.7;
    try {
        WholeRun run(Precision::single_precision, {start});
        ADD_FAILURE() << "must be refused";
    } catch (const mcdem::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("two grains could meet twice"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace mcdem::reference::containers
