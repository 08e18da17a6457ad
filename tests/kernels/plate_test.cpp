// Position of a tilted plate, against plane geometry in double precision.
#include "kernels/test_kernel.h"

namespace mcdem::reference {
namespace {

TEST(Plate, FootAndDistanceAgreeWithPlaneGeometry) {
    mcdem::f32::Replica replica{};
    replica.wall_position[1] = 0.2F;
    replica.wall_position[3] = 0.1F;
    replica.plate_tilt_x = 0.03F;
    replica.plate_tilt_y = -0.05F;
    replica.effects = EFFECT_PLATE_TILT;
    constexpr double plate_z = 0.15;
    Uniform uniform(4);
    std::vector<float> points;
    for (int i = 0; i < 50; ++i)
        for (const double high : {0.2, 0.1, 0.14}) points.push_back(static_cast<float>(uniform(0, high)));
    const auto found = mapped_rows(R"(
        const lanes3 point = {in[0], in[1], in[2]}, foot = plate_foot(replica, R(0.15), point);
        const lanes distance = plate_distance(replica, R(0.15), point);
        out[0] = LANE(real, foot.x, 0), out[1] = LANE(real, foot.y, 1), out[2] = LANE(real, foot.z, 2);
        out[3] = LANE(real, distance, 3);)",
                                   replica, points, 3, 4);
    const Vec3 up = Vec3(-0.03, 0.05, 1).normalized(), middle(0.1, 0.05, plate_z);
    for (std::size_t i = 0; i < 50; ++i) {
        const Vec3 point = Eigen::Map<const Eigen::Vector3f>(&points[3 * i]).cast<double>();
        const double distance = (middle - point).dot(up);
        const Vec3 foot = Eigen::Map<const Eigen::Vector3f>(&found[4 * i]).cast<double>();
        EXPECT_NEAR(found[4 * i + 3], distance, 1e-7);
        EXPECT_LT((foot - (point + distance * up)).norm(), 1e-7);
    }
}

TEST(Plate, MovesAtItsVelocityAndIsLevelWithoutTheEffect) {
    mcdem::f32::Replica replica{};
    replica.wall_position[5] = 0.5F;
    replica.plate_velocity = -0.25F;
    replica.time_step = 0.125F;
    replica.plate_tilt_x = 1;
    const auto found = mapped_rows(R"(
        out[0] = plate_position(replica, 8);
        const lanes height = plate_heights(replica, out[0], (lanes3){in[0], in[0], in[0]});
        out[1] = LANE(real, height, 0);)",
                                   replica, {3}, 1, 2);
    EXPECT_EQ(found, (std::vector<float>{0.25F, 0.25F}));
}

}  // namespace
}  // namespace mcdem::reference
