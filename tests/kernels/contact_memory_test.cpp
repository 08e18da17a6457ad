// The memory of contacts is loaded as it was stored, in the rows that a replica needs.
#include "kernels/test_kernel.h"

namespace reference::contact_memory {
namespace {

constexpr int rows = 9, slots = 16, grains = 48, first = 16, number = 16;

/// Stores 1000 grain + 100 row + slot for grains 16 to 31 and loads it again. Returns spring, radius,
/// deepest, relaxed and rolling of slot 3 of the sixth grain, then the second number of each row of the
/// fourth grain in memory.
std::vector<float> remembered(const mcdem::f32::Replica& replica) {
    const KernelBuild cpu_like = build(Precision::single_precision);
    const cl::Program program = with_kernel(R"(
kernel void store_and_load(global const Replica* replica, global real* memory, global real* out) {
    Moving now = {ZERO3, R(0), ZERO3, R(0), ZERO3, R(0)};
    const Grain at = grain_at(replica, 0, 0, 16, 0, now);
    const int effects = replica->effects;
    const lanes grain = convert_float16(LANE_NUMBERS) * 1000;
    global real* all = memory_of(at, memory);
    for (int v = 0; v < SLOTS; ++v) {
        const lanes number = grain + R(v);
        const Memory stored = {{number + 100, number + 200, number + 300},
                               number + 400,
                               number + 500,
                               number + 600,
                               {number + 700, number + 800, number + 900}};
        remember(replica, effects, stored, all, v);
    }
    const Memory loaded = recall(replica, effects, all, 3);
    out[0] = loaded.spring.x.s5, out[1] = loaded.spring.y.s5, out[2] = loaded.spring.z.s5;
    out[3] = loaded.radius.s5, out[4] = loaded.deepest.s5, out[5] = loaded.relaxed.s5;
    out[6] = loaded.rolling.x.s5, out[7] = loaded.rolling.y.s5, out[8] = loaded.rolling.z.s5;
})",
                                            cpu_like);
    struct Replicas;
    struct Rows;
    struct Out;
    mcdem::Field<Replicas> of(device(), 1, sizeof replica);
    mcdem::Field<Rows> memory(device(), grains * rows * slots, sizeof(float));
    mcdem::Field<Out> out(device(), 9, sizeof(float));
    of.write(&replica);
    std::vector<float> in_memory(grains * rows * slots, -1);
    memory.write(in_memory.data());
    mcdem::Kernel<mcdem::Field<Replicas>, mcdem::Field<Rows>, mcdem::Field<Out>>(
        device(), program, "store_and_load", 1)(1, of, memory, out);
    std::vector<float> found(9);
    out.read(found.data());
    memory.read(in_memory.data());
    for (int row = 0; row < replica.memory_rows; ++row)
        found.push_back(
            in_memory[static_cast<std::size_t>((first * replica.memory_rows + row * 16 + 1) * slots + 3)]);
    const auto written = std::ranges::count_if(in_memory, [](float value) { return value != -1; });
    EXPECT_EQ(written, number * replica.memory_rows * slots) << "another grain's memory was written";
    return found;
}

TEST(ContactMemory, KeepsAllRowsIfAllEffectsAreOn) {
    SKIP_WITHOUT_OTHER_WAY();
    mcdem::f32::Replica replica{};
    replica.mindlin = MINDLIN_FORCE;
    replica.memory_rows = 9;
    replica.radius_row = 3;
    replica.deepest_row = 4;
    replica.relaxed_row = 5;
    replica.rolling_row = 6;
    replica.effects = EFFECT_PLASTICITY | EFFECT_VISCOELASTICITY | EFFECT_ROLLING_RESISTANCE;
    EXPECT_EQ(remembered(replica),
              (std::vector<float>{5103, 5203, 5303, 5403, 5503, 5603, 5703, 5803, 5903, 3101, 3201, 3301,
                                  3401, 3501, 3601, 3701, 3801, 3901}));
}

TEST(ContactMemory, KeepsOnlyTheRowsThatTheReplicaNeeds) {
    SKIP_WITHOUT_OTHER_WAY();
    mcdem::f32::Replica replica{};
    replica.memory_rows = 1;
    replica.relaxed_row = 0;
    replica.effects = EFFECT_VISCOELASTICITY;
    EXPECT_EQ(remembered(replica), (std::vector<float>{0, 0, 0, 0, 0, 5603, 0, 0, 0, 3601}));
}

TEST(ContactMemory, RollingResistanceNeedsTheContactRadius) {
    SKIP_WITHOUT_OTHER_WAY();
    mcdem::f32::Replica replica{};
    replica.memory_rows = 4;
    replica.radius_row = 0;
    replica.rolling_row = 1;
    replica.effects = EFFECT_ROLLING_RESISTANCE;
    EXPECT_EQ(remembered(replica),
              (std::vector<float>{0, 0, 0, 5403, 0, 0, 5703, 5803, 5903, 3401, 3701, 3801, 3901}));
}

}  // namespace
}  // namespace reference::contact_memory
