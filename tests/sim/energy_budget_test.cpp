// Energy budget: works and losses against closed forms, in single steps of the engine; and what a budget
// whose dissipated energy falls leads to.
#include "sim/energy_budget.h"

#include <cmath>
#include <numbers>

#include "reference/test_scene.h"

namespace reference {
namespace {

using mcdem::EnergyBudget;
using mcdem::IntervalResult;
using Verdict = EnergyBudget::Verdict;
using std::numbers::pi;

constexpr double grain_radius = 0.01,
                 grain_mass = 1000 * 4.0 / 3 * pi * grain_radius * grain_radius * grain_radius;

Replica plain_replica() {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e5, 0.3, 1000, 0, 0, 1, 0};
    replica.walls = {1e13, 0.3, 0, 1};
    replica.numerics.time_step = 0.02;
    return replica;
}

EnergyBudget budget_of(const Start& start) {
    return {start.replica, mcdem::scale_of(start.replica, start.packing)};
}

/// Advances the replica in intervals of 7 steps, at which sums must not depend.
mcdem::EnergyTerms advanced(Batch& batch, EnergyBudget& budget, int steps, double plate_velocity = 0) {
    double plate_z = batch.start().replica.plate.start;
    budget.add(batch.engine().advance({{1, plate_z, 0, 0}}).front());
    while (steps > 0) {
        const auto result =
            batch.engine().advance({{std::min(steps, 7), plate_z, plate_velocity, 0}}).front();
        EXPECT_EQ(result.status, 0);
        budget.add(result);
        plate_z += plate_velocity * batch.engine().time_step(0) * result.steps;
        steps -= result.steps;
    }
    return budget.terms();
}

double rounding_error() { return has_double() ? 1e-7 : 1e-3; }

// A plate presses one grain onto the floor without waves: its work is stored by the two contacts.
TEST(EnergyBudget, WorkOfThePlateIsStored) {
    Replica replica = plain_replica();
    replica.grains.restitution = replica.walls.restitution = 0.1;
    replica.box = {6 * grain_radius, 6 * grain_radius};
    replica.plate.start = 2 * grain_radius;
    const Start start{replica, {{{3 * grain_radius, 3 * grain_radius, grain_radius}}, {2 * grain_radius}}};
    Batch batch(build(finest()), start);
    EnergyBudget budget = budget_of(start);
    const double dt = batch.engine().time_step(0);
    const int steps = 20000;
    const auto terms = advanced(batch, budget, steps, -0.002 / (steps * dt));
    const double modulus = 1e5 / (1 - 0.09), overlap = 0.001;
    const double stored = 2 * 8.0 / 15 * modulus * std::sqrt(grain_radius) * std::pow(overlap, 2.5);
    EXPECT_NEAR((terms.wall_work - terms.damping_loss) / stored, 1, 1e-3);
    EXPECT_LT(std::abs(terms.energy_error), 1e-5 * stored);
    EXPECT_GT(terms.damping_loss, 0);
}

// Two grains collide: damping takes (1 - e^2) of the energy of their relative motion.
TEST(EnergyBudget, DampingTakesTheLossOfACollision) {
    Replica replica = plain_replica();
    replica.grains.restitution = 0.7;
    const Start start = free_cluster(replica, {{0, 0, 0}, {2.001 * grain_radius, 0, 0}},
                                     {2 * grain_radius, 2 * grain_radius});
    Batch batch(build(finest()), start);
    batch.engine().set_velocities(0, {{0.1, 0, 0}, {-0.1, 0, 0}}, std::vector<Vec3>(2, Vec3::Zero()));
    EnergyBudget budget = budget_of(start);
    const auto terms = advanced(batch, budget, 4000);
    const double before = grain_mass * 0.01, loss = (1 - 0.49) * before;
    // The damping force at first touch pulls nothing back: the restitution is 0.7 within 1 %.
    EXPECT_NEAR(terms.damping_loss / loss, 1, 0.02);
    EXPECT_LT(std::abs(terms.energy_error), 2e-3 * before);  // of second order in the step
}

// A grain slides along the floor and begins to roll: 2/7 of its kinetic energy are lost.
TEST(EnergyBudget, FrictionTakesTwoSeventhsUntilAGrainRolls) {
    for (const FrictionLaw law : {FrictionLaw::mindlin, FrictionLaw::saturated}) {
        Replica replica = plain_replica();
        replica.contact.friction_law = law;
        replica.grains = {1e5, 0.3, 1000, 1000, 0.5, 0.1, 0};
        replica.walls = {1e13, 0.3, 0.5, 0.1};
        replica.box = {1, 1};
        replica.plate.start = 0.1;
        const double modulus = 1e5 / (1 - 0.09);
        const double sunk = std::pow(grain_mass * 9.81 * 0.75 / modulus / std::sqrt(grain_radius), 2.0 / 3);
        const Start start{replica, {{{0.3, 0.5, grain_radius - sunk}}, {2 * grain_radius}}};
        Batch batch(build(finest()), start);
        batch.engine().set_velocities(0, {{0.1, 0, 0}}, {Vec3::Zero()});
        EnergyBudget budget = budget_of(start);
        const auto terms = advanced(batch, budget, 4000);
        const double before = grain_mass * 0.01 / 2;
        EXPECT_NEAR(terms.friction_loss / before, 2.0 / 7, 0.01) << mcdem::name(law);
        // Friction follows the motion by a step: the first one's work is missing.
        const double of_a_step = 0.5 * grain_mass * 9.81 * 0.1 * batch.engine().time_step(0);
        EXPECT_LT(std::abs(terms.energy_error), 1.5 * of_a_step) << mcdem::name(law);
    }
}

// A free grain falls and is slowed by drag: weight and drag alone.
TEST(EnergyBudget, WeightAndDragOfAFreeGrain) {
    Replica replica = plain_replica();
    replica.grains.excess_density = 500;
    replica.grains.drag = 3;
    const Start start = free_cluster(replica, {{0, 0, 0.3}}, {2 * grain_radius});
    Batch batch(build(finest()), start);
    EnergyBudget budget = budget_of(start);
    const int steps = 3000;
    const auto terms = advanced(batch, budget, steps);
    const double fallen = 0.8 - batch.engine().state(0).position[0].z();
    ASSERT_GT(fallen, 0.01);
    EXPECT_NEAR(terms.weight_work / (grain_mass / 2 * 9.81 * fallen), 1, 1e-4 + rounding_error());
    EXPECT_GT(terms.drag_loss, 0.05 * terms.weight_work);
    EXPECT_LT(std::abs(terms.energy_error), 3e-4 * terms.weight_work);  // first order in drag times step
}

// In a sheared cell the work of the motion is stored or dissipated.
TEST(EnergyBudget, ClosesInADeformedCell) {
    Replica replica = test_replica(ContactModel::elastic_sphere);
    replica.grains.drag = 0;
    const Start start = cell_lattice(replica, 3, 5);
    Batch batch(build(finest()), start);
    EnergyBudget budget = budget_of(start);
    mcdem::StepInterval interval{1, 0, 0, 0};
    budget.add(batch.engine().advance({interval}).front());
    interval.steps = 9;
    interval.strain_rate = {0.2, 0, -0.1, 0.3, 0.1, 0};
    for (int k = 0; k < 60; ++k) {
        const double step = batch.engine().time_step(0);
        interval.steps = std::min(9, batch.engine().max_interval(0, interval));
        const auto result = batch.engine().advance({interval}).front();
        ASSERT_EQ(result.status, 0);
        budget.add(result);
        const double time = step * result.steps;
        for (std::size_t q = 0; q < 6; ++q) interval.strain[q] += interval.strain_rate[q] * time;
    }
    const auto& terms = budget.terms();
    EXPECT_GT(std::abs(terms.wall_work), 0.02 * budget.state().most_stored);
    // Friction follows the motion by a step, and the lattice starts with overlaps of 5 %.
    EXPECT_LT(std::abs(terms.energy_error), 0.02 * budget.state().most_stored);
    EXPECT_GT(terms.friction_loss, 0);
}

IntervalResult report(double work, double elastic, double kinetic) {
    IntervalResult result;
    result.work = work;
    result.elastic_energy = elastic;
    result.kinetic_energy = kinetic;
    return result;
}

TEST(EnergyBudget, DissipationThatFallsIsNoticedBeforeItIsTooMuch) {
    const Start start = free_cluster(plain_replica(), {{0, 0, 0}}, {2 * grain_radius});
    EnergyBudget budget = budget_of(start);
    budget.add(report(0, 0, 0));
    budget.add(report(1.1, 1, 0));  // 0.1 dissipated
    EXPECT_EQ(budget.verdict(), Verdict::sound);
    budget.add(report(0, 1, 0.003));
    EXPECT_EQ(budget.verdict(), Verdict::sound);
    budget.add(report(0, 1, 0.006));
    EXPECT_EQ(budget.verdict(), Verdict::creates_energy);
    budget.correct();
    EXPECT_EQ(budget.verdict(), Verdict::sound);
    EXPECT_NEAR(budget.created(), 0.006 / 1.006, 1e-9);
    budget.add(report(0, 1, 0.012));
    EXPECT_EQ(budget.verdict(), Verdict::too_much_created);
}

// 1e-9 E R^3 a grain is rounded, with E/(1 - nu^2) of the stiff ones: 2e-9 * 6e7/0.91 Pa * (0.01 m)^3.
TEST(EnergyBudget, OfUnlikeGrainsTheStiffestRoundMost) {
    Start start =
        free_cluster(plain_replica(), {{0, 0, 0}, {0.1, 0, 0}}, {2 * grain_radius, 2 * grain_radius});
    start.replica.species = {{"soft", {6e4, 0.3, 1000, 0, 0, 1}}, {"stiff", {6e7, 0.3, 1000, 0, 0, 1}}};
    start.packing.species = {0, 1};
    EnergyBudget budget = budget_of(start);
    budget.add(report(0, 0, 0));
    EXPECT_NEAR(budget.state().most_stored, 2e-15 * 6e7 / 0.91, 1e-12);
}

TEST(EnergyBudget, ContactsWithoutAPotentialAreNotJudged) {
    Start start = free_cluster(plain_replica(), {{0, 0, 0}}, {2 * grain_radius});
    start.replica.effects.viscoelasticity = 0.3;
    EnergyBudget budget = budget_of(start);
    budget.add(report(0, 0, 0));
    budget.add(report(0, 1, 1));
    EXPECT_EQ(budget.verdict(), Verdict::sound);
}

}  // namespace
}  // namespace reference
