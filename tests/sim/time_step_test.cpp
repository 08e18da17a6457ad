// The time step is shortened when contacts stiffen: packings are compressed until the grains fill the box,
// with the default step.
#include <cmath>
#include <numbers>

#include "reference/test_scene.h"
#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
#include "sim/simulation.h"

namespace mcdem::reference {
namespace {

using mcdem::Scan;
using mcdem::Scene;
using mcdem::Simulation;

/// Eighty grains compressed from a packing fraction of 0.59 to 0.85; the last scan of loading is the tenth.
Scene filled(const std::string& models) {
    return mcdem::parse_scene(R"(
[box]
size_x = 0.09
size_y = 0.09
[packing]
count = 80
[plate]
start = 0.087
end = 0.0605
[contact]
friction_law = "mindlin"
[numerics]
slots = 32
probe_gap = 0.3
overlap_limit = 1
[protocol]
scans_per_stroke = 10
rate_tolerance = 0.2
stop_at_scans = false
[batch.vary]
"contact.model" = [)" + models + "]\n",
                              "filled.toml", {});
}

std::vector<Packing> packings_of(const Scene& scene) {
    std::vector<Packing> all;
    for (const auto& replica : scene.replicas) all.push_back(mcdem::make_packing(replica));
    return all;
}

struct Course {
    explicit Course(const Scene& scene) : simulation(device(), scene, packings_of(scene)) {
        scans.resize(scene.replicas.size());
    }
    /// Runs until every replica has at least `wanted` scans or has stopped.
    void run(std::size_t wanted) {
        const auto take = [&](int r, Scan scan) { scans[r].push_back(std::move(scan)); };
        const auto fail = [&](int r, const mcdem::Failure& failure) {
            ADD_FAILURE() << "replica " << r << ": " << failure.cause;
        };
        const auto is_short = [&](const auto& list) { return list.size() < wanted; };
        while (std::ranges::any_of(scans, is_short) && simulation.advance(take, fail)) {
        }
        simulation.pass_on(take, fail);
    }
    Simulation simulation;
    std::vector<std::vector<Scan>> scans;
};

TEST(TimeStep, PackingsFillTheBoxWithTheDefaultStep) {
    Course course(filled(R"("elastic_sphere", "hyperelastic_sphere")"));
    course.run(10);
    for (const auto& scans : course.scans) {
        ASSERT_GE(scans.size(), 10u);
        for (std::size_t i = 6; i < 10; ++i) {
            EXPECT_LT(scans[i].kinetic_energy, 1e-2 * scans[i].elastic_energy) << i;
            EXPECT_GT(scans[i].top_force(), scans[i - 1].top_force()) << i;
        }
    }
}

// A checkpoint contains the step; a replica in a batch has the same bits as alone.
TEST(TimeStep, IsTheSameAfterARestartAndInABatch) {
    const Scene scene = filled(R"("elastic_sphere", "hyperelastic_sphere")");
    Course whole(scene), begun(scene), resumed(scene), alone(filled(R"("hyperelastic_sphere")"));
    whole.run(10);
    begun.run(8);
    const auto saved = begun.simulation.save();
    ASSERT_GT(*reinterpret_cast<const int*>(saved.at("shortening").data()), 0) << "nothing was shortened";
    resumed.simulation.restore(saved);
    resumed.run(1);
    alone.run(9);
    for (std::size_t r = 0; r < 2; ++r) {
        const Scan& expected = whole.scans[r].at(begun.scans[r].size());  // one replica may have been ahead
        const Scan& scan = resumed.scans[r].at(0);
        EXPECT_EQ(scan.time, expected.time);
        EXPECT_EQ(scan.position, expected.position);
        EXPECT_EQ(scan.top_force(), expected.top_force());
    }
    EXPECT_EQ(alone.scans[0].at(8).position, whole.scans[1].at(8).position);
    EXPECT_EQ(alone.scans[0].at(8).time, whole.scans[1].at(8).time);
}

// Models without displacements, and small loads, use the scene's step.
TEST(TimeStep, IsShortenedOnlyIfNecessary) {
    const auto after_a_step = [](ContactModel model, double overlap) {
        Replica replica = test_replica(model);
        replica.grains = {23.3e3, 0.45, 1000, 0, 0, 0.95, 0};
        Batch batch(build(finest()), caged_cluster(replica, overlap, 0, 3));
        const double before = batch.engine().time_step(0);
        batch.advance(10);
        return batch.engine().time_step(0) / before;
    };
    EXPECT_EQ(after_a_step(ContactModel::independent, 0.2), 1);
    EXPECT_EQ(after_a_step(ContactModel::elastic_sphere, 0.005), 1);
    EXPECT_LT(after_a_step(ContactModel::elastic_sphere, 0.1), 1);
    EXPECT_GT(after_a_step(ContactModel::elastic_sphere, 0.1), 0.1);
}

}  // namespace
}  // namespace mcdem::reference
