// Neighbours and walls in the slots of a grain, against geometry in double precision.
#include "kernels/test_kernel.h"

namespace mcdem::reference::contact_geometry {
namespace {

constexpr int slots = 16, written = 10;  // direction, distance, radius, wall, velocity, occupied

struct NeighbourGeometry {
    Vec3 normal, velocity;
    double distance, radius;
    bool wall, occupied;
};

/// Evaluates grain 0 of `motion` (position, radius, velocity, excess compliance, spin, species), with the
/// partners in its slots.
std::vector<NeighbourGeometry> neighbours_of(const mcdem::f32::Replica& replica, std::vector<float> motion,
                                             std::vector<int> partner, const KernelBuild& kernels) {
    const cl::Program program = with_kernel(R"(
kernel void see(global const Replica* replica, global const Motion* motion, global const int* partner,
                global real* out) {
    const Grain at = grain_at(replica, 0, 0, 0, 0, load_motion(motion, (slots)(0)));
    for (int v = 0; v < SLOTS_HERE; ++v) {
        const int slot = SLOT(v);
        const Neighbours neighbour = gather_neighbours(at, replica->effects, motion, (slots)(partner[slot]));
        const lanes wall = WHERE(neighbour.wall, R(1), R(0)), occupied = WHERE(neighbour.occupied, R(1), R(0));
        const lanes all[] = {neighbour.normal.x, neighbour.normal.y, neighbour.normal.z, neighbour.distance, neighbour.radius, wall,
                             neighbour.velocity.x, neighbour.velocity.y, neighbour.velocity.z, occupied};
        for (int k = 0; k < 10; ++k) out[k * SLOTS + slot] = LANE(real, all[k], slot);
    }
})",
                                            kernels);
    partner.resize(slots, NO_PARTNER);
    motion.resize(16 * 12);  // a CPU work-item has 16 grains
    const Buffer out = room_for<float>(slots * written);
    launch(program, "see", kernels.lanes > 1 ? 1 : slots, 1, uploaded(replica), uploaded(motion),
           uploaded(partner), out);
    Eigen::Matrix<float, slots, written> numbers;
    out.read(numbers.data());
    std::vector<NeighbourGeometry> all;
    for (int slot = 0; slot < slots; ++slot) {
        const Eigen::Matrix<double, 1, written> n = numbers.row(slot).cast<double>();
        all.push_back({{n[0], n[1], n[2]}, {n[6], n[7], n[8]}, n[3], n[4], n[5] == 1, n[9] == 1});
    }
    return all;
}

void add_grain(std::vector<float>& motion, const Vec3& position, double radius, const Vec3& velocity) {
    for (const double number : {position.x(), position.y(), position.z(), radius, velocity.x(), velocity.y(),
                                velocity.z(), 0.0, 0.0, 0.0, 0.0, 0.0})
        motion.push_back(static_cast<float>(number));
}

class ContactGeometry : public InBothLayouts {
protected:
    ContactGeometry() {
        replica.wall_position[1] = 0.2F;
        replica.wall_position[3] = 0.1F;
        replica.wall_position[5] = 0.15F;
        replica.plate_velocity = -0.5F;
        Uniform uniform(11);
        for (int i = 0; i < 8; ++i) {
            position.push_back(Vec3(uniform(0, 0.2), uniform(0, 0.1), uniform(0, 0.15)));
            velocity.push_back(uniform.vector(1));
            add_grain(motion, position.back(), 0.01 + 0.001 * i, velocity.back());
        }
    }
    static void expect(const NeighbourGeometry& found, const Vec3& apart, const Vec3& velocity, double radius,
                       bool wall) {
        EXPECT_TRUE(found.occupied);
        EXPECT_EQ(found.wall, wall);
        EXPECT_NEAR(found.distance, apart.norm(), 1e-7);
        EXPECT_LT((found.normal - apart.normalized()).norm(), 2e-6);
        EXPECT_LT((found.velocity - velocity).norm(), 1e-6);
        EXPECT_NEAR(found.radius, radius, 1e-8);
    }
    mcdem::f32::Replica replica{};
    std::vector<Vec3> position, velocity;
    std::vector<float> motion;
};

TEST_P(ContactGeometry, IsCorrectForGrainsAndWallsOfABox) {
    const auto found = neighbours_of(
        replica, motion, {3, WALL_PARTNER(0), WALL_PARTNER(3), 5, WALL_PARTNER(4), WALL_PARTNER(5)}, kernels);
    const Vec3 at = position[0], still = -velocity[0];
    expect(found[0], position[3] - at, velocity[3] - velocity[0], 0.013, false);
    expect(found[1], Vec3(-at.x(), 0, 0), still, 0, true);
    expect(found[2], Vec3(0, 0.1 - at.y(), 0), still, 0, true);
    expect(found[3], position[5] - at, velocity[5] - velocity[0], 0.015, false);
    expect(found[4], Vec3(0, 0, -at.z()), still, 0, true);
    expect(found[5], Vec3(0, 0, 0.15 - at.z()), still + Vec3(0, 0, -0.5), 0, true);
    EXPECT_FALSE(found[6].occupied);
    EXPECT_EQ(found[6].distance, 1) << "nothing is divided by zero";
}

TEST_P(ContactGeometry, UsesNearestImagesInAPeriodicContainer) {
    replica.container = CONTAINER_PERIODIC;
    const auto found = neighbours_of(replica, motion, {1, 2, 3, 4, 5, 6, 7}, kernels);
    for (std::size_t j = 1; j < 8; ++j) {
        Vec3 apart = position[j] - position[0];
        apart.x() -= 0.2 * std::round(apart.x() / 0.2);
        apart.y() -= 0.1 * std::round(apart.y() / 0.1);
        expect(found[j - 1], apart, velocity[j] - velocity[0], 0.01 + 0.001 * static_cast<double>(j), false);
    }
}

TEST_P(ContactGeometry, IsCorrectForTheWallOfACylinder) {
    replica.container = CONTAINER_CYLINDER;
    replica.wall_position[3] = 0.2F;
    const auto found = neighbours_of(replica, motion, {WALL_PARTNER(0), WALL_PARTNER(4)}, kernels);
    const Vec3 axis(0.1, 0.1, position[0].z()), out = position[0] - axis;
    expect(found[0], axis + 0.1 * out.normalized() - position[0], -velocity[0], 0, true);
    expect(found[1], Vec3(0, 0, -position[0].z()), -velocity[0], 0, true);
}

TEST_P(ContactGeometry, IncludesTheMotionOfADeformedCell) {
    replica.container = CONTAINER_CELL;
    const Eigen::Matrix3d f = (Eigen::Matrix3d() << 0.9, 0.2, 0.1, 0, 1.1, -0.1, 0, 0, 0.8).finished();
    const float rate = 0.5F;
    const double numbers[] = {f(0, 0), f(1, 1), f(2, 2), f(0, 1), f(0, 2), f(1, 2)};
    for (int k = 0; k < 6; ++k) {
        replica.deformation[k] = static_cast<float>(numbers[k]);
        replica.deformation_rate[k] = rate * static_cast<float>(numbers[k]);
    }
    replica.wall_position[1] = replica.wall_position[3] = replica.wall_position[5] = 4;
    const auto found = neighbours_of(replica, motion, {1, 2, 3}, kernels);
    for (std::size_t j = 1; j < 4; ++j) {
        const Vec3 apart = f * (position[j] - position[0]);
        expect(found[j - 1], apart, velocity[j] - velocity[0] + rate * apart,
               0.01 + 0.001 * static_cast<double>(j), false);
    }
}

INSTANTIATE_TEST_SUITE_P(BothLayouts, ContactGeometry, testing::Bool());

}  // namespace
}  // namespace mcdem::reference::contact_geometry
