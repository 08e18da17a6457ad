// At rest, without weight and wall friction, the stress from contacts equals the wall forces over the areas
// of the walls.
#include "core/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/simulated.h"

namespace mcdem {
namespace {

using reference::Start;

Start compressed(ContactModel model) {
    Start start = reference::jittered_lattice(reference::test_replica(model), 64, 5);
    Replica& replica = start.replica;
    replica.grains.excess_density = 0;
    replica.walls.friction = 0;
    replica.contact.friction_law = FrictionLaw::mindlin;
    replica.plate.end = 0.87 * replica.plate.start;
    replica.protocol.scans_per_stroke = 1;
    replica.protocol.stop_at_scans = true;
    replica.protocol.settle_unbalanced_force = 1e-6;
    replica.protocol.settle_drag = 20;  // about critical: with larger drag, relaxation takes longer
    replica.protocol.settle_time = 20;
    return start;
}

/// The scan at the end of loading.
Scan strongest(const Start& start) {
    Scene scene;
    scene.precision = Precision::double_precision;
    scene.replicas = {start.replica};
    return reference::simulated(scene, start.packing).scans[0].at(0);
}

class StressAtRest : public ::testing::TestWithParam<ContactModel> {};

TEST_P(StressAtRest, EqualsTheWallForcesOverTheAreas) {
    if (!reference::has_double()) GTEST_SKIP() << "the device has no double precision";
    const Start start = compressed(GetParam());
    const Scan scan = strongest(start);
    const auto on = [&](Wall wall) { return scan.wall_force[static_cast<std::size_t>(wall)]; };
    const Box& box = start.replica.box;
    const Vec3 pressure(on(Wall::x_max).x() / (box.size_y * scan.plate_z),
                        on(Wall::y_max).y() / (box.size_x * scan.plate_z),
                        on(Wall::plate).z() / (box.size_x * box.size_y));
    ASSERT_GT(pressure.minCoeff(), 10) << "pressed from all sides";
    // Grains still creep along the walls: a net force of 1e-6 of the pressure force on a grain remains.
    const double tolerance = 1e-5 * pressure.maxCoeff();
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(scan.stress(axis, axis), pressure[axis], tolerance);
    EXPECT_LT((scan.stress - scan.stress.transpose()).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_NEAR(scan.fabric.trace(), 1, 1e-12);
    double volume = 0;
    Mat3 of_grains = Mat3::Zero();
    const auto stress = grain_stress(box, start.packing.diameter, scan);
    for (std::size_t i = 0; i < stress.size(); ++i) {
        const double own = std::numbers::pi / 6 * std::pow(start.packing.diameter[i], 3);
        of_grains += own * stress[i];
        volume += own;
    }
    EXPECT_LT(volume, box.size_x * box.size_y * scan.plate_z);
    EXPECT_TRUE(scan.stress.isApprox(of_grains / (box.size_x * box.size_y * scan.plate_z), 1e-12));
}

INSTANTIATE_TEST_SUITE_P(Models, StressAtRest,
                         ::testing::Values(ContactModel::independent, ContactModel::mc_dem,
                                           ContactModel::elastic_sphere),
                         [](const auto& model) { return std::string(name(model.param)); });

}  // namespace
}  // namespace mcdem
