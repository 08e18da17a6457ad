// Tilted plate, compliant plate, container of another width.
#include <algorithm>
#include <numbers>

#include "sim/compliant_plate.h"
#include "sim/simulated.h"
#include "sim/squeezed_grain.h"

namespace mcdem::reference::effects_plate {
namespace {

constexpr double radius = SqueezedGrain::radius, tilt_x = 0.1, tilt_y = -0.05, width = 6 * radius;
constexpr int plate_wall = static_cast<int>(mcdem::Wall::plate);

Replica single_grain() {
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {SqueezedGrain::youngs_modulus, SqueezedGrain::poisson_ratio, 1000, 0, 0, 0.5, 0};
    replica.walls = {SqueezedGrain::wall_modulus, SqueezedGrain::poisson_ratio, 0, 0.5};
    replica.box = {width, width};
    return replica;
}

/// Distance of a point from the tilted face, from a plane through three of its points.
double distance_to_face(const Vec3& point, double plate_z) {
    const Vec3 middle(width / 2, width / 2, plate_z), along_x(1, 0, tilt_x), along_y(0, 1, tilt_y);
    return along_x.cross(along_y).normalized().dot(middle - point);
}

Start under_leaning_plate(const Vec3& position, double plate_z) {
    Replica replica = single_grain();
    replica.effects.plate_tilt_x = tilt_x;
    replica.effects.plate_tilt_y = tilt_y;
    replica.plate.start = plate_z;
    replica.grains.restitution = replica.walls.restitution = 1;
    replica.numerics.overlap_limit = 1;
    return {replica, {{position}, {2 * radius}}};
}

// The force is the Hertz force for the distance from the plane, along its normal, at the foot of the
// perpendicular. The plate receives the opposite force and its moment about the middle.
TEST(PlateTilt, ForceIsAlongTheNormalOfTheFace) {
    for (const Vec3& position : {Vec3(0.02, 0.02, 0.05), Vec3(0.045, 0.03, 0.05)}) {
        constexpr double overlap = 3e-4;
        const double plate_z = 0.05 + (radius - overlap) * std::sqrt(1 + tilt_x * tilt_x + tilt_y * tilt_y) -
                               tilt_x * (position.x() - width / 2) - tilt_y * (position.y() - width / 2);
        Batch batch(build(finest()), under_leaning_plate(position, plate_z));
        const auto result = batch.advance(1).front();
        const auto state = batch.engine().state(0);
        const Vec3 normal = Vec3(-tilt_x, -tilt_y, 1).normalized();
        const double distance = distance_to_face(state.position[0], plate_z);
        const double hertz = SqueezedGrain::hertz(radius - distance);
        ASSERT_GT(hertz, 0);
        EXPECT_LT((result.wall_force[plate_wall] / hertz - normal).norm(), 10 * SqueezedGrain::rounding());
        const Vec3& force = result.wall_force[plate_wall];
        EXPECT_LT(force.cross(normal).norm() / force.norm(), SqueezedGrain::rounding());
        ASSERT_EQ(state.contacts.size(), 1u);
        const auto& contact = state.contacts.front();
        EXPECT_LT((contact.force + force).norm() / force.norm(), SqueezedGrain::rounding());
        const Vec3 foot = state.position[0] + distance * normal;
        EXPECT_LT((contact.point - foot).norm(), SqueezedGrain::rounding() * radius);
        EXPECT_NEAR(contact.overlap / (radius - distance), 1, 100 * SqueezedGrain::rounding());
        const Vec3 middle(width / 2, width / 2, plate_z);
        const Vec3 couple = (contact.point - middle).cross(-contact.force);
        EXPECT_LT((couple - (foot - middle).cross(hertz * normal)).norm(),
                  10 * SqueezedGrain::rounding() * couple.norm());
    }
}

// A grain is lost if its centre is above the face at its own x and y.
TEST(PlateTilt, GrainsAreLostOnlyAboveTheFace) {
    const double plate_z = 0.05;
    std::vector<Start> starts;
    for (double x : {0.015, 0.045})
        starts.push_back(under_leaning_plate({x, 0.03, plate_z}, plate_z + (x < 0.03 ? 0.0016 : -0.0014)));
    for (Start& start : starts) start.packing.diameter = {1e-3};
    Batch batch(build(finest()), starts);
    const auto results = batch.advance(1);
    EXPECT_EQ(results[0].status, 0) << "1.6 mm below the middle of the face, which is 1.5 mm lower here";
    EXPECT_EQ(results[1].status, 0) << "1.4 mm above the middle of the face, which is 1.5 mm higher here";
    for (Start& start : starts) start.replica.plate.start -= 0.0002;
    Batch lower(build(finest()), starts);
    for (const auto& result : lower.advance(1)) EXPECT_NE(result.status & STATUS_LOST, 0);
}

/// Scans of one grain between the floor and a plate that moves down by `stroke`.
std::vector<mcdem::Scan> scans(const Replica& replica, int count = 1) {
    mcdem::Scene scene;
    scene.precision = finest();
    scene.replicas = {replica};
    scene.replicas[0].protocol.scans_per_stroke = count;
    scene.replicas[0].protocol.stop_at_scans = true;
    scene.replicas[0].protocol.settle_unbalanced_force = 1e-6;
    scene.replicas[0].box = {2.2 * radius, 2.2 * radius};
    const Packing packing{{{1.1 * radius, 1.1 * radius, replica.plate.start / 2}}, {2 * radius}};
    return simulated(scene, packing).scans[0];
}

/// One grain and six around it, three of them in a row along x.
Packing seven_grains(const Vec3& middle) {
    Packing packing{{middle}, {2 * radius}};
    for (int k = 0; k < 6; ++k) {
        const double angle = k * std::numbers::pi / 3;
        packing.position.push_back(middle + 2 * radius * Vec3(std::cos(angle), std::sin(angle), 0));
        packing.diameter.push_back(2 * radius);
    }
    return packing;
}

// The same grains in a container that is stated as wide as the other one is: the same bits.
TEST(WidthError, IsThatOfAContainerOfTheTrueWidth) {
    constexpr double x = 4e-4, y = -3e-4;
    for (ContainerShape shape : {ContainerShape::box, ContainerShape::cylinder}) {
        Replica wrong = single_grain(), right = wrong;
        for (Replica* one : {&wrong, &right}) {
            one->plate = {2.2 * radius, 1.9 * radius, 0.1};
            one->protocol.scans_per_stroke = 2;
            one->protocol.rate_tolerance = 0;  // the speed would follow the stated area
            one->box = {5.9 * radius, 5.9 * radius};
            one->box.shape = shape;
        }
        wrong.effects.width_error_x = x;
        wrong.effects.width_error_y = y;
        right.box.size_x += x;
        right.box.size_y += shape == ContainerShape::cylinder ? x : y;
        const Packing wedged = seven_grains({2.95 * radius, 2.95 * radius, radius});
        Scene scene;
        scene.precision = finest();
        scene.replicas = {wrong, right};
        const auto all = simulated(scene, {wedged, wedged}).scans;
        ASSERT_EQ(all[0].size(), 4u);
        for (std::size_t k = 0; k < all[0].size(); ++k) {
            ASSERT_EQ(all[0][k].contacts.size(), all[1][k].contacts.size());
            for (std::size_t c = 0; c < all[0][k].contacts.size(); ++c) {
                EXPECT_EQ(all[0][k].contacts[c].force, all[1][k].contacts[c].force);
                EXPECT_EQ(all[0][k].contacts[c].point, all[1][k].contacts[c].point);
            }
        }
        const auto& compressed = all[0][1].contacts;
        EXPECT_TRUE(std::ranges::any_of(compressed, [](const auto& contact) {
            return contact.partner != mcdem::wall_partner(mcdem::Wall::plate) &&
                   contact.partner != mcdem::wall_partner(mcdem::Wall::floor);
        })) << "the side wall carries";
    }
}

// At rest, force and position solve z = commanded z + C F, F = F_H(R - z/2); C dF/dz is up to 12. A scan
// waits for the plate, to a thousandth of its deflection or of its largest move per interval.
TEST(PlateCompliance, ForceAndPositionAreConsistent) {
    for (double compliance : {1e-3, 1e-2, 5e-2}) {
        Replica replica = single_grain();
        replica.effects.plate_compliance = compliance;
        replica.plate = {2 * radius, 2 * radius * 0.95, 0.05};
        replica.protocol.settle_time = 5;
        const auto all = scans(replica, 3);
        ASSERT_EQ(all.size(), 6u);
        for (const auto& scan : all) {
            if (scan.plate_z == replica.plate.start) continue;  // unloaded: nothing to compare
            double low = scan.plate_z, high = std::max(scan.plate_z, 2 * radius);
            for (int k = 0; k < 100; ++k) {
                const double z = (low + high) / 2;
                (scan.plate_z + compliance * SqueezedGrain::hertz(radius - z / 2) > z ? low : high) = z;
            }
            const double expected = SqueezedGrain::hertz(radius - low / 2);
            EXPECT_TRUE(scan.settled);
            EXPECT_NEAR(compliance * scan.top_force(), compliance * expected,
                        1e-3 * std::max(2e-4, low - scan.plate_z))
                << compliance << " at " << scan.plate_z;
            for (const auto& contact : scan.contacts)
                if (contact.partner == mcdem::wall_partner(mcdem::Wall::plate)) {
                    EXPECT_NEAR(contact.point.z() - scan.plate_z, compliance * scan.top_force(),
                                1e-3 * std::max(2e-4, low - scan.plate_z));
                }
        }
        EXPECT_EQ(all[2].plate_z, replica.plate.end) << "the recorded position is the commanded one";
    }
}

/// A spring instead of a packing, to test the controller on its own.
class Spring {
public:
    Spring(const Replica& replica, double stiffness) : plate_(replica), stiffness_(stiffness) {}

    /// One interval in which the commanded position changes by `move`; the spring is unloaded above zero.
    void interval(double move, int steps) {
        mcdem::StepInterval interval{steps, commanded_, move / (steps * time_step), 0};
        plate_.deflect(interval, time_step, farthest);
        EXPECT_NEAR(interval.plate_z, true_z_, 1e-13) << "the plate does not jump";
        const double went = interval.plate_velocity * steps * time_step;
        EXPECT_LE(std::abs(went), std::max(farthest, std::abs(move)) * (1 + 1e-12));
        true_z_ += went;
        commanded_ += move;
        mcdem::IntervalResult result;
        result.steps = steps;
        result.wall_force[plate_wall] = {0, 0, force()};
        plate_.on_interval_done(result);
    }
    bool arrived() const { return plate_.arrived(farthest); }
    double force() const { return stiffness_ * std::max(0.0, -true_z_); }
    /// Error of the deflection: C F minus (true minus commanded position).
    double lag(double compliance) const { return compliance * force() - (true_z_ - commanded_); }

private:
    static constexpr double time_step = 1e-4, farthest = 2e-4;
    mcdem::CompliantPlate plate_;
    double stiffness_, commanded_ = 0, true_z_ = 0;
};

TEST(PlateCompliance, FollowsAMovingPlateWithoutLag) {
    constexpr double stiffness = 1000, move = 1e-4;
    for (double compliance : {1e-4, 5e-4, 2e-3}) {
        Replica replica = single_grain();
        replica.effects.plate_compliance = compliance;
        replica.plate.start = 2 * radius;
        replica.box = {2.2 * radius, 2.2 * radius};
        Spring spring(replica, stiffness);
        for (int k = 0; k < 1000; ++k) spring.interval(-move, 10);
        EXPECT_NEAR(spring.lag(compliance), 0, 1e-2 * move) << compliance;
        const double gain = compliance * stiffness, depth = 1000 * move;
        EXPECT_NEAR(spring.force() / (stiffness * depth / (1 + gain)), 1, 1e-4);
        for (int k = 0; k < 100; ++k) spring.interval(0, 60);
        EXPECT_NEAR(spring.lag(compliance), 0, 1e-9) << compliance << ": at rest nothing is left";
    }
}

TEST(PlateCompliance, ArrivesAtTheDeflectionOfTheForce) {
    constexpr double compliance = 5e-4;
    Replica replica = single_grain();
    replica.effects.plate_compliance = compliance;
    replica.plate.start = 2 * radius;
    Spring spring(replica, 1000);
    EXPECT_TRUE(spring.arrived()) << "nothing to give";
    for (int k = 0; k < 20; ++k) {
        spring.interval(-1e-4, 10);
        EXPECT_FALSE(spring.arrived()) << k << ": the force has grown";
    }
    for (int k = 0; k < 200; ++k) spring.interval(0, 60);
    EXPECT_TRUE(spring.arrived());
    EXPECT_LT(std::abs(spring.lag(compliance)), 1e-3 * compliance * spring.force());
}

TEST(PlateCompliance, NoScanBeforeThePlateArrives) {
    mcdem::ProtocolRunner runner(
        single_grain(), 1e-4, {.diameter = 2 * radius, .count = 1, .density = single_grain().grains.density});
    mcdem::IntervalResult still;
    still.steps = 60;
    still.elastic_energy = 1;
    for (int k = 0; k < 5; ++k) runner.on_interval_done(still, false);
    EXPECT_EQ(runner.state().activity, mcdem::Activity::relax);
    for (int k = 0; k < 2; ++k) runner.on_interval_done(still, true);
    EXPECT_EQ(runner.state().activity, mcdem::Activity::move);
}

TEST(PlateCompliance, RigidPlateIsUnchanged) {
    mcdem::CompliantPlate plate(single_grain());
    mcdem::StepInterval interval{17, 0.1, -0.03, 2};
    mcdem::IntervalResult result;
    result.steps = 17;
    result.wall_force[plate_wall] = {0, 0, 5};
    plate.on_interval_done(result);
    plate.deflect(interval, 1e-4, 1e-4);
    EXPECT_EQ(interval.plate_z, 0.1);
    EXPECT_EQ(interval.plate_velocity, -0.03);
}

}  // namespace
}  // namespace mcdem::reference::effects_plate
