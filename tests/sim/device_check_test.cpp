// The comparison of a device with the host notices results that are wrong by more than rounding errors.
#include "sim/device_check.h"

#include <functional>
#include <limits>

#include "reference/test_scene.h"

namespace mcdem::reference {
namespace {

TEST(DeviceCheck, ThisDevicePasses) {
    for (const Precision precision : {Precision::single_precision, finest()}) {
        const DeviceCheck check = check_device(device(), precision);
        EXPECT_TRUE(check.passed()) << check.text();
        EXPECT_GT(check.difference(), 0) << "compared with itself";
    }
}

/// What a faulty device could return after a step.
struct Fault {
    const char* name;
    std::function<void(ReplicaState&, IntervalResult&)> make;
};

Contact& strongest(ReplicaState& state) {
    return *std::ranges::max_element(state.contacts, {}, [](const Contact& c) { return c.force.norm(); });
}

TEST(DeviceCheck, WrongResultsFail) {
    constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
    const Fault faults[] = {
        {"none", [](auto&, auto&) {}},
        {"one force", [](auto& state, auto&) { strongest(state).force *= 1 + 1e-3; }},
        {"not a number", [](auto& state, auto&) { state.velocity[5].y() = not_a_number; }},
        {"a spin", [](auto& state, auto&) { state.angular_velocity[7] *= -1; }},
        {"a lost contact", [](auto& state, auto&) { strongest(state).partner = strongest(state).grain; }},
        {"a lost grain", [](auto& state, auto&) { state.position.pop_back(); }},
        {"a wall's force", [](auto&, auto& result) { result.wall_force[5] *= 1.001; }},
        {"an energy", [](auto&, auto& result) { result.elastic_energy *= 1.001; }},
        {"a status", [](auto&, auto& result) { result.status = 1; }},
    };
    const Start start = jittered_lattice(test_replica(), 100, 1);
    Batch batch(build(Precision::single_precision), start);
    Uniform uniform(3);
    batch.engine().set_velocities(0, uniform.vectors(100, 0.05), uniform.vectors(100, 5));
    StepReference step = reference_of(batch.engine(), 0, start);
    const auto results = batch.advance(1);
    step.step();
    for (const Fault& fault : faults) {
        ReplicaState state = batch.engine().state(0);
        IntervalResult result = results[0];
        fault.make(state, result);
        DeviceCheck check(Precision::single_precision);
        check.add(ContactModel::mc_dem, result, compare(state, result, step, 5e-5));
        EXPECT_EQ(check.passed(), &fault == faults) << fault.name << " " << check.text();
    }
}

}  // namespace
}  // namespace mcdem::reference
