// The memory of contacts is loaded as it was stored, in the rows that a replica needs.
#include "kernels/test_kernel.h"

namespace mcdem::reference::contact_memory {
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
    const Buffer memory = uploaded(std::vector<float>(grains * rows * slots, -1)), out = room_for<float>(9);
    launch(program, "store_and_load", 1, 1, uploaded(replica), memory, out);
    auto found = downloaded<float>(out);
    const auto in_memory = downloaded<float>(memory);
    for (int row = 0; row < replica.memory_rows; ++row)
        found.push_back(
            in_memory[static_cast<std::size_t>((first * replica.memory_rows + row * 16 + 1) * slots + 3)]);
    const auto written = std::ranges::count_if(in_memory, [](float value) { return value != -1; });
    EXPECT_EQ(written, number * replica.memory_rows * slots) << "another grain's memory was written";
    return found;
}

/// The rows of a replica whose memory has some of the members, and what is remembered.
struct Rows {
    int effects, mindlin, count, radius, deepest, relaxed, rolling;
    std::vector<float> expected;
};

TEST(ContactMemory, KeepsTheRowsThatTheReplicaNeeds) {
    SKIP_WITHOUT_OTHER_WAY();
    const Rows all[] = {{EFFECT_PLASTICITY | EFFECT_VISCOELASTICITY | EFFECT_ROLLING_RESISTANCE,
                         MINDLIN_FORCE,
                         9,
                         3,
                         4,
                         5,
                         6,
                         {5103, 5203, 5303, 5403, 5503, 5603, 5703, 5803, 5903, 3101, 3201, 3301, 3401, 3501,
                          3601, 3701, 3801, 3901}},
                        {EFFECT_VISCOELASTICITY, 0, 1, 0, 0, 0, 0, {0, 0, 0, 0, 0, 5603, 0, 0, 0, 3601}},
                        {EFFECT_ROLLING_RESISTANCE,
                         0,
                         4,
                         0,
                         0,
                         0,
                         1,
                         {0, 0, 0, 5403, 0, 0, 5703, 5803, 5903, 3401, 3701, 3801, 3901}}};
    for (const Rows& rows : all) {
        mcdem::f32::Replica replica{};
        replica.effects = rows.effects, replica.mindlin = rows.mindlin, replica.memory_rows = rows.count;
        replica.radius_row = rows.radius, replica.deepest_row = rows.deepest;
        replica.relaxed_row = rows.relaxed, replica.rolling_row = rows.rolling;
        EXPECT_EQ(remembered(replica), rows.expected) << rows.count << " rows";
    }
}

}  // namespace
}  // namespace mcdem::reference::contact_memory
