// Conservation laws: momentum and angular momentum of free grains; opposite forces on the two sides of a
// contact, at one point.
#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "core/names.h"
#include "reference/test_scene.h"

namespace mcdem::reference {
namespace {

double mass(const Start& start, std::size_t grain) {
    return start.replica.grains.density * std::numbers::pi / 6 * std::pow(start.packing.diameter[grain], 3);
}

double inertia(const Start& start, std::size_t grain) {
    return 0.1 * mass(start, grain) * std::pow(start.packing.diameter[grain], 2);
}

struct Momenta {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    double linear_size = 0, angular_size = 0;  ///< sums of the magnitudes over all grains
};

/// About the centre of the box.
Momenta momenta(const Start& start, const mcdem::ReplicaState& state) {
    Momenta sum;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const Vec3 linear = mass(start, i) * state.velocity[i];
        const Vec3 angular = (state.position[i] - Vec3::Constant(0.5)).cross(linear) +
                             inertia(start, i) * state.angular_velocity[i];
        sum.linear += linear;
        sum.angular += angular;
        sum.linear_size += linear.norm();
        sum.angular_size += angular.norm();
    }
    return sum;
}

/// Every model with both friction laws, in one batch.
std::vector<Start> free_clusters() {
    std::vector<Start> starts;
    for (ContactModel model : all_models)
        for (FrictionLaw law : {FrictionLaw::saturated, FrictionLaw::mindlin}) {
            Replica replica = test_replica(model);
            replica.contact.friction_law = law;
            starts.push_back(irregular_cluster(replica, 1));
        }
    return starts;
}

/// All contact effects together.
Start free_cluster_with_effects() {
    Replica replica = test_replica(ContactModel::mc_dem);
    auto& effects = replica.effects;
    effects.adhesion = 0.02;
    effects.cohesion = 100;
    effects.net_force_friction = 0.5;
    effects.viscoelasticity = 0.3;
    effects.relaxation_time = 0.01;
    effects.stiffening = 0.5;
    effects.law_exponent = 0.2;
    effects.plasticity = effects.friction_history = effects.modulus_scatter = 0.2;
    effects.bulge_contacts = 0.5;
    effects.rolling_resistance = 0.1;
    return irregular_cluster(replica, 1);
}

/// Friction law and contact effects drawn at random.
Start random_free_cluster(unsigned seed, ContactModel model) {
    Uniform uniform(seed);
    const auto some = [&](double most) { return uniform(0, 1) < 0.5 ? uniform(0, most) : 0; };
    Replica replica = test_replica(model);
    replica.contact.friction_law = uniform(0, 1) < 0.5 ? FrictionLaw::mindlin : FrictionLaw::saturated;
    replica.grains.friction = some(0.8);
    replica.grains.restitution = uniform(0.3, 1);
    auto& effects = replica.effects;
    effects.adhesion = some(0.05);
    effects.cohesion = some(200);
    effects.net_force_friction = some(1);
    effects.viscoelasticity = some(0.8);
    effects.relaxation_time = 0.01;
    effects.stiffening = some(2) - some(1);
    effects.law_exponent = some(0.5) - some(0.3);
    effects.finite_strain = some(1);
    effects.plasticity = some(0.5);
    effects.friction_history = some(1);
    effects.modulus_scatter = some(0.4);
    effects.bulge_contacts = 1 - some(1);
    effects.rolling_resistance = some(0.3);
    return irregular_cluster(replica, seed);
}

void set_random_velocities(Batch& batch, std::size_t replicas) {
    Uniform uniform(2);
    for (std::size_t r = 0; r < replicas; ++r) {
        const std::size_t count = batch.start(r).packing.size();
        batch.engine().set_velocities(r, uniform.vectors(count, 0.1), uniform.vectors(count, 10));
    }
}

// Rounding error: coordinates of half a metre are rounded to 3e-8 m in float, which is 1.5e-6 of the arms,
// in each of 200 steps; in double the error is 1e-9 of that.
void expect_momenta_stay(Precision precision, double allowed) {
    auto starts = free_clusters();
    starts.push_back(free_cluster_with_effects());
    for (unsigned seed = 1; seed <= 24; ++seed)
        starts.push_back(random_free_cluster(seed, all_models[seed % std::size(all_models)]));
    Batch batch(build(precision), starts);
    set_random_velocities(batch, starts.size());
    std::vector<Momenta> before;
    for (std::size_t r = 0; r < starts.size(); ++r)
        before.push_back(momenta(starts[r], batch.engine().state(r)));
    batch.advance(200);
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const Momenta after = momenta(starts[r], batch.engine().state(r));
        const std::string where = fmt::format("{} {}", name(starts[r].replica.contact.model),
                                              name(starts[r].replica.contact.friction_law));
        EXPECT_LT((after.linear - before[r].linear).norm() / before[r].linear_size, allowed) << where;
        EXPECT_LT((after.angular - before[r].angular).norm() / before[r].angular_size, allowed) << where;
        EXPECT_GT(std::abs(after.linear_size - before[r].linear_size) / before[r].linear_size, 5e-3)
            << where << ": nothing has happened";
    }
}

TEST(Conservation, MomentumAndAngularMomentumAreConservedInDouble) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    expect_momenta_stay(Precision::double_precision, 1e-12);
}

TEST(Conservation, MomentumAndAngularMomentumAreConservedInFloat) {
    expect_momenta_stay(Precision::single_precision, 5e-4);
}

// Hertz contacts with friction, damping and memory only dissipate energy, up to the error of the integrator.
TEST(Conservation, EnergyDoesNotGrow) {
    std::vector<Start> starts;
    for (unsigned seed = 0; seed < 24 * 6; seed += 6)
        starts.push_back(random_free_cluster(seed, ContactModel::independent));
    Batch batch(build(finest()), starts);
    set_random_velocities(batch, starts.size());
    std::vector<double> least(starts.size(), 1e300), max_growth(starts.size(), 0);
    for (int step = 0; step < 150; ++step) {
        const auto results = batch.advance(1);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            const double energy = results[r].kinetic_energy + results[r].elastic_energy;
            least[r] = std::min(least[r], energy);
            max_growth[r] = std::max(max_growth[r], energy / least[r] - 1);
        }
    }
    for (std::size_t r = 0; r < starts.size(); ++r) {
        ASSERT_EQ(starts[r].replica.contact.model, ContactModel::independent);
        EXPECT_LT(max_growth[r], 0.01) << "seed " << 6 * r;
    }
}

// Each contact is reported once, for the grain of lower index. The next step of both grains must follow from
// these forces, with opposite sign for the second grain, applied at the same points.
TEST(Conservation, ForcesOnBothSidesAreOppositeAtOnePoint) {
    const auto starts = free_clusters();
    Batch batch(build(finest()), starts);
    set_random_velocities(batch, starts.size());
    batch.advance(5);
    std::vector<mcdem::ReplicaState> before;
    for (std::size_t r = 0; r < starts.size(); ++r) before.push_back(batch.engine().state(r));
    batch.advance(1);
    const double allowed = has_double() ? 1e-11 : 1e-4;
    for (std::size_t r = 0; r < starts.size(); ++r) {
        // A Mindlin spring changes within the step, so only saturated friction can be predicted.
        if (starts[r].replica.contact.friction_law == FrictionLaw::mindlin) continue;
        const auto after = batch.engine().state(r);
        ASSERT_GT(before[r].contacts.size(), 20u);
        std::vector<Vec3> force(13, Vec3::Zero()), torque = force, change, turn;
        for (const auto& contact : before[r].contacts) {
            force[contact.grain] += contact.force;
            force[contact.partner] -= contact.force;
            const auto& x = before[r].position;
            torque[contact.grain] += (contact.point - x[contact.grain]).cross(contact.force);
            torque[contact.partner] -= (contact.point - x[contact.partner]).cross(contact.force);
        }
        const double dt = batch.engine().time_step(r);
        for (std::size_t i = 0; i < 13; ++i) {
            change.push_back((after.velocity[i] - before[r].velocity[i]) * mass(starts[r], i) / dt);
            turn.push_back((after.angular_velocity[i] - before[r].angular_velocity[i]) *
                           inertia(starts[r], i) / dt);
        }
        EXPECT_LT(relative_difference(change, force), allowed) << name(starts[r].replica.contact.model);
        EXPECT_LT(relative_difference(turn, torque), allowed) << name(starts[r].replica.contact.model);
    }
}

}  // namespace
}  // namespace mcdem::reference
