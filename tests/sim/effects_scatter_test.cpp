// Grains of unequal stiffness, and grains whose true diameters differ from the stated ones.
#include <numbers>
#include <numeric>

#include "scene/packing/true_grains.h"
#include "sim/simulated.h"
#include "sim/squeezed_grain.h"

namespace mcdem::reference {
namespace {

/// Young's moduli of the grains, drawn as the scene specifies.
std::vector<double> moduli(const Replica& replica, std::size_t grains) {
    std::vector<double> all;
    for (double excess_compliance : mcdem::excess_compliance(replica, grains))
        all.push_back(replica.grains.youngs_modulus / (1 + excess_compliance));
    return all;
}

TEST(ModulusScatter, IsLogNormalAboutTheMean) {
    Replica replica;
    replica.effects.modulus_scatter = 0.3;
    constexpr int count = 1000;
    double sum = 0, squares = 0, mean = 0;
    for (double modulus : moduli(replica, count)) {
        const double x = std::log(modulus / replica.grains.youngs_modulus);
        sum += x;
        squares += x * x;
        mean += modulus / replica.grains.youngs_modulus / count;
    }
    const double s = 0.3, sd = std::sqrt(squares / count - std::pow(sum / count, 2));
    EXPECT_NEAR(sum / count, -s * s / 2, 4 * s / std::sqrt(count));
    EXPECT_NEAR(sd, s, 4 * s / std::sqrt(2.0 * count));
    EXPECT_NEAR(mean, 1, 4 * s / std::sqrt(count)) << "the mean of E stays";
    Replica other = replica;
    other.packing.seed = 2;
    EXPECT_NE(moduli(replica, 3), moduli(other, 3));
    EXPECT_EQ(moduli(replica, 3).back(), moduli(replica, 7)[2]) << "a grain's modulus hangs on its number";
}

// Two grains and a wall; each pair has its own 1/E* = (1 - nu^2)(1/E_i + 1/E_j).
TEST(ModulusScatter, PairsHaveTheirOwnModulus) {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {1e5, 0.3, 1000, 0, 0, 1, 0};
    replica.walls = {4e5, 0.2, 0, 1};
    replica.effects.modulus_scatter = 0.5;
    replica.packing.seed = 4;
    Start start = free_cluster(replica, {{0, 0, 0}, {0.0155, 0, 0}}, {0.02, 0.012});
    for (auto& x : start.packing.position) x.z() = 0.0095;
    start.packing.position[1].z() = 0.0095 + 0.002;
    Batch batch(build(finest()), start);
    batch.advance(1);
    const auto state = batch.engine().state(0);
    const auto e = moduli(replica, 2);
    EXPECT_GT(std::abs(e[0] / e[1] - 1), 0.05);
    ASSERT_EQ(state.contacts.size(), 2u);
    for (const auto& contact : state.contacts) {
        const bool wall = mcdem::is_wall(contact.partner);
        const double compliance = 0.91 / e[0] + (wall ? 0.96 / 4e5 : 0.91 / e[1]);
        const double radius = wall ? 0.01 : 0.01 * 0.006 / 0.016;
        const double distance = wall ? state.position[0].z() : (state.position[1] - state.position[0]).norm();
        const double overlap = (wall ? 0.01 : 0.016) - distance;
        const double expected = 4.0 / 3 / compliance * std::sqrt(radius) * std::pow(overlap, 1.5);
        EXPECT_GT(overlap, 1e-4);
        EXPECT_NEAR(contact.force.norm() / expected, 1, has_double() ? 1e-9 : 1e-3);
    }
}

TEST(ModulusScatter, TheStiffestGrainSetsTheTimeStep) {
    Replica replica = test_replica();
    const Start plain = jittered_lattice(replica, 27, 3);
    Start scattered = plain;
    scattered.replica.effects.modulus_scatter = 0.4;
    const auto e = moduli(scattered.replica, 27);
    Batch batch(build(finest()), std::vector<Start>{plain, scattered});
    double shortest = 1e300, equal = 1e300;
    for (std::size_t i = 0; i < e.size(); ++i) {
        shortest = std::min(shortest, plain.packing.diameter[i] / std::sqrt(e[i]));
        equal = std::min(equal, plain.packing.diameter[i] / std::sqrt(replica.grains.youngs_modulus));
    }
    EXPECT_NEAR(batch.engine().time_step(1) / batch.engine().time_step(0), shortest / equal, 1e-12);
}

// The simulated grain is larger than stated by the diameter error; the recording contains the stated
// diameter.
TEST(TrueDiameter, LargerTrueDiameterIncreasesTheForce) {
    constexpr double radius = SqueezedGrain::radius, overlap = 2e-4, error = 3e-4;
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {SqueezedGrain::youngs_modulus, SqueezedGrain::poisson_ratio, 1000, 0, 0, 0.5, 0};
    replica.walls = {SqueezedGrain::wall_modulus, SqueezedGrain::poisson_ratio, 0, 0.5};
    replica.effects.diameter_error = error;
    replica.box = {6 * radius, 6 * radius};
    replica.plate = {2 * radius, 2 * (radius - overlap), 0.05};
    replica.protocol.scans_per_stroke = 1;
    replica.protocol.settle_unbalanced_force = 1e-6;
    mcdem::Scene scene;
    scene.precision = finest();
    scene.replicas = {replica};
    const Packing stated{{{3 * radius, 3 * radius, radius}}, {2 * radius}};
    const auto scans = simulated(scene, stated).scans[0];
    ASSERT_EQ(scans.size(), 2u);
    const double truly = overlap + error / 2;
    const double expected = SqueezedGrain::hertz(truly) * std::sqrt((radius + error / 2) / radius);
    EXPECT_NEAR(scans[0].top_force() / expected, 1, 1e-3);
    EXPECT_EQ(mcdem::begin_recording(replica, stated).diameter, stated.diameter);
}

}  // namespace
}  // namespace mcdem::reference
