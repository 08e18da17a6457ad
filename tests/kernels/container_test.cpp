// Walls and periodic boundaries of the four containers, against geometry in double precision.
#include "kernels/test_kernel.h"

namespace mcdem::reference::container {
namespace {

using Matrix = Eigen::Matrix3d;

/// A cell of these lengths with an upper triangular F.
mcdem::f32::Replica deformed_cell(const Vec3& lengths, const Matrix& f) {
    mcdem::f32::Replica replica{};
    replica.container = CONTAINER_CELL;
    const double numbers[] = {f(0, 0), f(1, 1), f(2, 2), f(0, 1), f(0, 2), f(1, 2)};
    for (int k = 0; k < 6; ++k) replica.deformation[k] = static_cast<float>(numbers[k]);
    for (int axis = 0; axis < 3; ++axis)
        replica.wall_position[2 * axis + 1] = static_cast<float>(lengths[axis]);
    return replica;
}

std::vector<float> points(unsigned seed, std::size_t count, double size) {
    std::vector<float> numbers;
    for (const Vec3& point : Uniform(seed).vectors(count, size))
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<float>(point[axis]));
    return numbers;
}

Vec3 row(const std::vector<float>& numbers, std::size_t i) {
    return Eigen::Map<const Eigen::Vector3f>(&numbers[3 * i]).cast<double>();
}

const Matrix leaning = (Matrix() << 0.8, 0.4, -0.7, 0, 1.1, 0.2, 0, 0, 0.7).finished();

TEST(Container, DeformedAndUndeformedAreInverse) {
    const auto replica = deformed_cell(Vec3::Ones(), leaning);
    const auto in = points(1, 50, 1);
    const auto out = mapped_rows(
        "const Deformation f = deformation(replica, R(0));"
        "vstore3(deformed(f, vload3(0, in)), 0, out);",
        replica, in, 3, 3);
    const auto back = mapped_rows(
        "const Deformation f = deformation(replica, R(0));"
        "const lanes3 a = undeformed(f, (lanes3){in[0], in[1], in[2]});"
        "out[0] = LANE(real, a.x, 0), out[1] = LANE(real, a.y, 1), out[2] = LANE(real, a.z, 2);",
        replica, out, 3, 3);
    for (std::size_t i = 0; i < 50; ++i) {
        EXPECT_LT((row(out, i) - leaning * row(in, i)).norm(), 1e-6);
        EXPECT_LT((row(back, i) - row(in, i)).norm(), 1e-6);
    }
}

TEST(Container, DeformationIsLinearInTime) {
    auto replica = deformed_cell(Vec3::Ones(), Matrix::Identity());
    for (int k = 0; k < 6; ++k) replica.deformation_rate[k] = 0.25F * static_cast<float>(k);
    const auto found = mapped_rows(
        "const Deformation f = deformation(replica, in[0]);"
        "out[0] = f.xx, out[1] = f.yy, out[2] = f.zz,"
        "out[3] = f.xy, out[4] = f.xz, out[5] = f.yz;",
        replica, {2}, 1, 6);
    EXPECT_EQ(found, (std::vector<float>{1, 1.5F, 2, 1.5F, 2, 2.5F}));
}

// Correct for distances below half of each of the cell's lengths, at any shear: none of 11 x 11 x 11 images
// is nearer.
TEST(Container, NearestImageInADeformedCellIsTheNearest) {
    const Vec3 lengths(0.06, 0.05, 0.07);
    const auto replica = deformed_cell(lengths, leaning);
    const auto in = points(2, 4000, 0.1);
    const auto out = mapped_rows(
        "const Deformation f = deformation(replica, R(0));"
        "vstore3(deformed(f, nearest_in_cell(replica, f, vload3(0, in))), 0, out);",
        replica, in, 3, 3);
    const double half = 0.5 * (leaning.diagonal().cwiseProduct(lengths)).minCoeff();
    int compared = 0;
    for (std::size_t i = 0; i < 4000; ++i) {
        Vec3 nearest = Vec3::Constant(1);
        for (int k = 0; k < 11 * 11 * 11; ++k) {
            const Vec3 image(k % 11 - 5, k / 11 % 11 - 5, k / 121 - 5);
            const Vec3 tried = leaning * (row(in, i) + image.cwiseProduct(lengths));
            if (tried.norm() < nearest.norm()) nearest = tried;
        }
        if (nearest.norm() > half) continue;
        ++compared;
        EXPECT_LT((row(out, i) - nearest).norm(), 1e-7);
    }
    EXPECT_GT(compared, 300);
}

TEST(Container, SidesOfABoxAreItsWalls) {
    mcdem::f32::Replica replica{};
    replica.container = CONTAINER_BOX;
    replica.wall_position[1] = 2;
    replica.wall_position[3] = 1;
    const std::string text = R"(
        const lanes3 point = {in[0], in[1], R(0)};
        for (int wall = 0; wall < 4; ++wall) {
            const lanes distance = side_distance(replica, wall, point);
            out[wall] = LANE(real, distance, wall);
        }
        const mask within = within_sides(replica, point);
        const lanes inside = WHERE(within, R(1), R(0));
        out[4] = LANE(real, inside, 6);)";
    EXPECT_EQ(mapped_rows(text, replica, {0.5F, 0.25F, 2.5F, 0.75F}, 2, 5),
              (std::vector<float>{0.5F, 1.5F, 0.25F, 0.75F, 1, 2.5F, -0.5F, 0.75F, 0.25F, 0}));
}

TEST(Container, SideOfACylinderIsOneCurvedWall) {
    mcdem::f32::Replica replica{};
    replica.container = CONTAINER_CYLINDER;
    replica.wall_position[1] = replica.wall_position[3] = 2;
    const std::string text = R"(
        const lanes3 points = {in[0], in[1], R(0.5)}, foot = side_foot(replica, points);
        const mask within = within_sides(replica, points);
        const lanes inside = WHERE(within, R(1), R(0)), curved = curved_radius(replica, R(0.75));
        out[0] = LANE(real, foot.x, 0), out[1] = LANE(real, foot.y, 1), out[2] = LANE(real, foot.z, 2);
        const lanes curved_wall = side_distance(replica, 0, points), none = side_distance(replica, 1, points);
        out[3] = LANE(real, curved_wall, 3), out[4] = isinf(LANE(real, none, 4));
        out[5] = LANE(real, inside, 3), out[6] = LANE(real, curved, 4);)";
    const auto found = mapped_rows(text, replica, {1.3F, 1.4F, 1, 1, 2, 2}, 2, 7);
    const float expected[] = {1.6F,
                              1.8F,
                              0.5F,
                              0.5F,
                              1,
                              1,
                              1.5F,  // 0.5 from the axis, direction 3:4
                              2,
                              1,
                              0.5F,
                              1,
                              1,
                              1,
                              1.5F,  // on the axis: any foot is correct
                              1 + std::sqrt(0.5F),
                              1 + std::sqrt(0.5F),
                              0.5F,
                              1 - std::sqrt(2.0F),
                              1,
                              0,
                              1.5F};
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(Container, PeriodicCoordinatesAreWrappedIntoTheCell) {
    const std::string text =
        "const lanes image = nearest_image((lanes)(in[0]), R(2));\n"
        "out[0] = into_cell(in[0], R(2)), out[1] = LANE(real, image, 5);";
    EXPECT_EQ(mapped_rows(text, {}, {-0.5F, 0.5F, 1.5F, 4.25F, -3.25F}, 1, 2),
              (std::vector<float>{1.5F, -0.5F, 0.5F, 0.5F, 1.5F, -0.5F, 0.25F, 0.25F, 0.75F, 0.75F}));
}

}  // namespace
}  // namespace mcdem::reference::container
