// Kernel cell_stress: the stress of a sheared cell, with contacts across its periodic boundaries.
#include "kernels/test_kernel.h"

namespace mcdem::reference {
namespace {

constexpr int slots = 16;

struct Contact {
    int grain, partner;
    Vec3 force;  ///< on `grain` [N]
};

/// Sums of force times branch [N m] for grains at these stored positions, with one slot per contact.
Eigen::Matrix3d moments(const mcdem::f32::Replica& replica, const std::vector<Vec3>& position,
                        const std::vector<Contact>& contacts) {
    const KernelBuild kernels = build(Precision::single_precision);
    const std::size_t rows = (position.size() + 15) / 16 * 16 * slots;
    std::vector<float> motion(position.size() * 12, 0);
    for (std::size_t i = 0; i < position.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            motion[12 * i + static_cast<std::size_t>(axis)] = static_cast<float>(position[i][axis]);
    std::vector<int> partner(rows, NO_PARTNER), used(position.size(), 0);
    std::vector<float> force(3 * rows, 0);
    for (const Contact& c : contacts) {
        const auto grain = static_cast<std::size_t>(c.grain);
        const auto slot = static_cast<std::size_t>(used[grain]++);
        partner[kernels.place_of_slot(grain, slot)] = c.partner;
        for (int axis = 0; axis < 3; ++axis)
            force[kernels.place_of_slot(grain, slot, axis, 3)] = static_cast<float>(c.force[axis]);
    }
    const Buffer out = room_for<float>(9);
    launch(with_kernel("", kernels), "cell_stress", 64, 1, uploaded(replica), uploaded(mcdem::Portion{0, 0}),
           uploaded(0), uploaded(motion), uploaded(partner), uploaded(force), out);
    Eigen::Matrix<float, 3, 3, Eigen::RowMajor> sums;
    out.read(sums.data());
    return sums.cast<double>();
}

mcdem::f32::Replica leaning_cell(int grains) {
    mcdem::f32::Replica replica{};
    replica.container = CONTAINER_CELL;
    replica.grain_count = grains;
    const float f[] = {0.8F, 1.1F, 0.7F, 0.4F, -0.3F, 0.2F};
    std::copy_n(f, 6, replica.deformation);
    replica.wall_position[1] = replica.wall_position[3] = replica.wall_position[5] = 1;
    return replica;
}
const Eigen::Matrix3d leaning = (Eigen::Matrix3d() << 0.8, 0.4, -0.3, 0, 1.1, 0.2, 0, 0, 0.7).finished();

TEST(CellStress, IsForceTimesBranchAcrossPeriodicBoundaries) {
    const Vec3 here(0.95, 0.1, 0.5), there(0.05, 0.95, 0.55), force(1, -2, 3);
    const Vec3 branch = leaning * Vec3(0.1, -0.15, 0.05);
    const auto found = moments(leaning_cell(2), {here, there}, {{0, 1, -force}, {1, 0, force}});
    EXPECT_LT((found - branch * force.transpose()).norm(), 1e-6);
}

TEST(CellStress, SumsAllGrains) {
    Uniform uniform(9);
    std::vector<Vec3> position;
    std::vector<Contact> contacts;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 301; ++i) position.push_back(Vec3::Constant(0.5) + uniform.vector(0.1));
    for (int i = 0; i < 300; ++i) {
        const Vec3 force = uniform.vector(1);
        contacts.push_back({i, i + 1, -force});
        contacts.push_back({i + 1, i, force});
        sum += leaning * (position[static_cast<std::size_t>(i) + 1] - position[static_cast<std::size_t>(i)]) *
               force.transpose();
    }
    EXPECT_LT((moments(leaning_cell(301), position, contacts) - sum).norm(), 1e-5 * sum.norm() + 1e-5);
}

TEST(CellStress, IsZeroInOtherContainers) {
    auto replica = leaning_cell(2);
    replica.container = CONTAINER_PERIODIC;
    EXPECT_EQ(moments(replica, {Vec3::Zero(), Vec3::Constant(0.1)}, {{0, 1, Vec3::Ones()}}).norm(), 0);
}

}  // namespace
}  // namespace mcdem::reference
