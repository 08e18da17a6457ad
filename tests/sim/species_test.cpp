// Grains of several species compared with closed-form solutions: a pair, a chain, friction of every pair,
// energy.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/test_scene.h"

namespace mcdem::reference::species {
namespace {

using mcdem::GrainMaterial;
using mcdem::Wall;
using std::numbers::pi;

const GrainMaterial soft{2e4, 0.45, 900, 0, 0.5, 1}, stiff{6e5, 0.2, 2500, 0, 0.1, 1};

Replica of_two(ContactModel model) {
    Replica replica = test_replica(model);
    replica.grains = {1, 0.1, 1, 0, 0, 1, 0};  // values that no species uses
    replica.walls = {1e12, 0.3, 0, 1};
    replica.species = {{"soft", soft}, {"stiff", stiff}};
    return replica;
}

/// 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j
double reduced_modulus(const GrainMaterial& a, const GrainMaterial& b) {
    return 1 / ((1 - a.poisson_ratio * a.poisson_ratio) / a.youngs_modulus +
                (1 - b.poisson_ratio * b.poisson_ratio) / b.youngs_modulus);
}

// Hertz (1882), for every pair of species in both orders.
TEST(SpeciesContact, ForceIsHertzWithBothMaterials) {
    const double a = 0.012, b = 0.007, distance = 0.018;
    std::vector<Start> starts;
    for (const auto& [first, second] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 0), std::pair(1, 1)}) {
        starts.push_back(
            free_cluster(of_two(ContactModel::independent), {{0, 0, 0}, {distance, 0, 0}}, {2 * a, 2 * b}));
        starts.back().packing.species = {first, second};
    }
    Batch batch(build(finest()), starts);
    batch.advance(1);
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const auto state = batch.engine().state(static_cast<int>(r));
        const auto& species = starts[r].packing.species;
        const double overlap = a + b - (state.position[1] - state.position[0]).norm();
        const double modulus = reduced_modulus(species[0] ? stiff : soft, species[1] ? stiff : soft);
        const double force = 4.0 / 3 * modulus * std::sqrt(a * b / (a + b)) * std::pow(overlap, 1.5);
        ASSERT_EQ(state.contacts.size(), 1u);
        EXPECT_NEAR(state.contacts[0].force.norm() / force, 1, has_double() ? 1e-9 : 1e-3) << r;
        // Equal and opposite momenta, with each grain's own mass.
        const auto mass = [&](double radius, int s) {
            return (s ? stiff : soft).density * 4 / 3 * pi * std::pow(radius, 3);
        };
        EXPECT_NEAR(
            state.velocity[0].x() * mass(a, species[0]) / (state.velocity[1].x() * mass(b, species[1])), -1,
            has_double() ? 1e-12 : 1e-5);
    }
}

/// Soft and stiff grains alternate in a column between floor and plate, at rest.
TEST(SpeciesChain, ForceIsThatOfSpringsInSeries) {
    constexpr double radius = 0.01, compression = 0.004;
    constexpr int count = 6;
    Start start{of_two(ContactModel::independent), {}};
    for (int k = 0; k < count; ++k) {
        start.packing.position.push_back(
            {0.05, 0.05, (2 * k + 1) * radius * (1 - compression / (2 * count * radius))});
        start.packing.diameter.push_back(2 * radius);
        start.packing.species.push_back(k / 2 % 2);
    }
    start.replica.box = {0.1, 0.1};
    start.replica.plate.start = 2 * count * radius - compression;
    start.replica.plate.end = 0.1 * start.replica.plate.start;
    Batch batch(build(finest()), start);
    const auto result = batch.advance(60000, 2e3)[0];
    const double force = result.wall_force[static_cast<int>(Wall::plate)].z();
    // The overlaps of all contacts under one force add up: delta_k = (F / (4/3 E* sqrt(R*)))^(2/3).
    const GrainMaterial wall{1e12, 0.3};
    double sum = 0;
    const auto add = [&](const GrainMaterial& a, const GrainMaterial& b, double reduced_radius) {
        sum += std::pow(4.0 / 3 * reduced_modulus(a, b) * std::sqrt(reduced_radius), -2.0 / 3);
    };
    const auto material = [&](int k) { return start.packing.species[k] ? stiff : soft; };
    for (int k = 0; k + 1 < count; ++k) add(material(k), material(k + 1), radius / 2);
    add(material(0), wall, radius);
    add(material(count - 1), wall, radius);
    EXPECT_NEAR(force / std::pow(compression / sum, 1.5), 1, has_double() ? 1e-6 : 1e-3);
}

/// Two grains slide past each other, much faster than the sliding velocity of the scene: mu is the ratio of
/// the forces.
TEST(SpeciesFriction, CoefficientIsThatOfThePair) {
    Replica replica = of_two(ContactModel::independent);
    replica.contact.friction_law = FrictionLaw::saturated;
    replica.contact.sliding_velocity = 1e-9;
    replica.numerics.time_step = 1e-3;
    const std::array<std::array<double, 2>, 2> smaller{{{0.5, 0.1}, {0.1, 0.1}}};
    for (const double told : {mcdem::not_given, 0.3}) {
        replica.pairs = {{"stiff", "soft", told, mcdem::not_given}};
        std::vector<Start> starts;
        for (int first : {0, 1})
            for (int second : {0, 1}) {
                starts.push_back(free_cluster(replica, {{0, 0, 0}, {0.019, 0, 0}}, {0.02, 0.02}));
                starts.back().packing.species = {first, second};
            }
        Batch batch(build(finest()), starts);
        for (int r = 0; r < 4; ++r)
            batch.engine().set_velocities(r, {{0, 1, 0}, {0, 0, 0}}, {2, Vec3::Zero()});
        batch.advance(1);
        for (int r = 0; r < 4; ++r) {
            const Vec3 force = batch.engine().state(r).contacts.at(0).force;
            const bool unlike = r == 1 || r == 2;
            const double mu = unlike && told == told ? told : smaller[r / 2][r % 2];
            EXPECT_NEAR(std::hypot(force.y(), force.z()) / std::abs(force.x()), mu, 2e-3 * mu) << r;
        }
    }
}

/// Each species on the floor, with the walls' friction or that of its [[pair]] with the walls.
TEST(SpeciesFriction, OnWallsIsThatOfTheWallsOrOfTheirPair) {
    Replica replica = of_two(ContactModel::independent);
    replica.walls.friction = 0.25;
    replica.contact.friction_law = FrictionLaw::saturated;
    replica.contact.sliding_velocity = 1e-9;
    replica.numerics.time_step = 1e-3;
    replica.pairs = {{"soft", "walls", 0.6, mcdem::not_given}};
    replica.box = {0.2, 0.2};
    replica.plate.start = 0.2;
    replica.plate.end = 0.1;
    Start start{replica, {{{0.05, 0.1, 0.0095}, {0.15, 0.1, 0.0095}}, {0.02, 0.02}, {0, 1}}};
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {{0, 1, 0}, {0, 1, 0}}, {2, Vec3::Zero()});
    batch.advance(1);
    const auto contacts = batch.engine().state(0).contacts;
    ASSERT_EQ(contacts.size(), 2u);
    EXPECT_NEAR(-contacts[0].force.y() / contacts[0].force.z(), 0.6, 2e-3);
    EXPECT_NEAR(-contacts[1].force.y() / contacts[1].force.z(), 0.25, 2e-3);
}

// Restitution of an unlike pair: separation speed over approach speed.
TEST(SpeciesRestitution, CoefficientIsThatOfThePair) {
    Replica replica = of_two(ContactModel::independent);
    replica.pairs = {{"soft", "stiff", mcdem::not_given, 0.6}};
    replica.numerics.time_step = 0.01;
    Start start = free_cluster(replica, {{0, 0, 0}, {0.0201, 0, 0}}, {0.024, 0.016});
    start.packing.species = {1, 0};
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {{0.2, 0, 0}, {0, 0, 0}}, {2, Vec3::Zero()});
    batch.advance(20000);
    const auto velocity = batch.engine().state(0).velocity;
    EXPECT_NEAR((velocity[1] - velocity[0]).x() / 0.2, 0.6, 2e-3);
}

// Without friction and damping, the energy of a cluster of both species is conserved, for every model.
TEST(SpeciesEnergy, IsConservedForEveryModel) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    std::vector<Start> starts;
    for (ContactModel model : all_models) {
        Replica replica = of_two(model);
        replica.species[1].material.youngs_modulus = 6e4;
        for (auto& species : replica.species) species.material.friction = 0;
        replica.numerics.time_step = 0.01;
        starts.push_back(caged_cluster(replica, 0.03, 1e-4, 3));
        for (int i = 0; i < 13; ++i) starts.back().packing.species.push_back(i % 2);
    }
    Batch batch(build(Precision::double_precision), starts);
    std::vector<std::vector<double>> kinetic(starts.size()), elastic(starts.size());
    for (int step = 0; step < 6000; ++step) {
        const auto results = batch.advance(1);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            ASSERT_EQ(results[r].status, 0);
            kinetic[r].push_back(results[r].kinetic_energy);
            elastic[r].push_back(results[r].elastic_energy);
        }
    }
    for (std::size_t r = 0; r < starts.size(); ++r) {
        // Velocities are half a step behind: the mean of two is the velocity at the step.
        const auto mean = [&](int from, int to) {
            double sum = 0;
            for (int k = from; k < to; ++k) sum += elastic[r][k] + (kinetic[r][k] + kinetic[r][k + 1]) / 2;
            return sum / (to - from);
        };
        const double motion = *std::ranges::max_element(kinetic[r]);
        EXPECT_NEAR((mean(5000, 5999) - mean(0, 1000)) / motion, 0, 2e-3)
            << name(starts[r].replica.contact.model);
        EXPECT_GT(motion, 0);
    }
}

}  // namespace
}  // namespace mcdem::reference::species
