// Reports of replicas that are summed by several work-groups, compared with sums over the state.
#include <cmath>

#include "reference/test_scene.h"

namespace mcdem::reference {
namespace {

constexpr int grains = 2 * PORTION_GRAINS + 808;

struct Sums {
    std::array<Vec3, mcdem::wall_count> wall_force = mcdem::no_wall_forces();
    double deepest = 0, kinetic = 0;
};

Sums sums_of(const Start& start, const mcdem::ReplicaState& state) {
    Sums sums;
    for (const auto& contact : state.contacts) {
        double radii = start.packing.diameter[contact.grain] / 2;
        if (mcdem::is_wall(contact.partner)) {
            for (int w = 0; w < mcdem::wall_count; ++w)
                if (contact.partner == mcdem::wall_partner(static_cast<mcdem::Wall>(w)))
                    sums.wall_force[w] -= contact.force;
        } else {
            radii += start.packing.diameter[contact.partner] / 2;
        }
        sums.deepest = std::max(sums.deepest, contact.overlap / radii);
    }
    for (std::size_t i = 0; i < state.velocity.size(); ++i) {
        const double radius = start.packing.diameter[i] / 2;
        const double mass = start.replica.grains.density * 4 / 3 * M_PI * std::pow(radius, 3);
        sums.kinetic += mass / 2 *
                        (state.velocity[i].squaredNorm() +
                         0.4 * radius * radius * state.angular_velocity[i].squaredNorm());
    }
    return sums;
}

TEST(Reports, SumAllPortions) {
    Replica replica = test_replica();  // without springs, which change within a step
    replica.grains.friction = replica.walls.friction = 0;
    const std::vector<Start> starts{jittered_lattice(replica, 65, 1), jittered_lattice(replica, grains, 2)};
    Batch batch(build(Precision::single_precision), starts);
    const auto results = batch.advance(20);
    std::vector<mcdem::ReplicaState> states;
    for (int r = 0; r < 2; ++r) states.push_back(batch.engine().state(r));
    batch.advance(1);
    for (int r = 0; r < 2; ++r) {
        // Velocities are half a step behind the positions; those at the positions are the means of two steps.
        const auto later = batch.engine().state(r);
        for (std::size_t i = 0; i < later.velocity.size(); ++i) {
            states[r].velocity[i] = (states[r].velocity[i] + later.velocity[i]) / 2;
            states[r].angular_velocity[i] = (states[r].angular_velocity[i] + later.angular_velocity[i]) / 2;
        }
        const Sums sums = sums_of(starts[r], states[r]);
        EXPECT_EQ(results[r].status, 0);
        EXPECT_NEAR(results[r].deepest_overlap, sums.deepest, 1e-5 * sums.deepest);
        EXPECT_NEAR(results[r].kinetic_energy, sums.kinetic, 1e-5 * sums.kinetic);
        double largest = 0;
        for (const Vec3& force : sums.wall_force) largest = std::max(largest, force.norm());
        EXPECT_GT(largest, 0);
        for (int w = 0; w < mcdem::wall_count; ++w)
            EXPECT_LT((results[r].wall_force[w] - sums.wall_force[w]).norm(), 1e-5 * largest) << "wall " << w;
    }
}

TEST(Reports, NameAFailedGrainInTheLastPortion) {
    Start start = jittered_lattice(test_replica(), grains, 2);
    int highest = 0;  // last along the space-filling curve by which grains are stored
    for (int i = 0; i < grains; ++i)
        if (start.packing.position[i].sum() > start.packing.position[highest].sum()) highest = i;
    start.packing.position[highest].z() = 2 * start.replica.plate.start;
    Batch batch(build(Precision::single_precision), start);
    const auto result = batch.engine().advance({{1, start.replica.plate.start, 0, 0}}).front();
    EXPECT_NE(result.status & STATUS_LOST, 0);
    EXPECT_EQ(result.failed_grain, highest);
}

}  // namespace
}  // namespace mcdem::reference
