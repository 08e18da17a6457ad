// What contacts remember comes back as it was stored, in the rows that a replica keeps.
#include "kernels/test_kernel.h"

namespace reference {
namespace {

constexpr int rows = 5, slots = 16;

/// Stores 1, 2, .. into all rows, loads them again, and returns springs, deepest and relaxed of slot 3 of
/// grain 1, then the first number of each of its rows in memory.
std::vector<float> remembered(const mcdem::f32::Replica& replica) {
    const KernelBuild cpu_like = [] {
        const KernelBuild kernels = build(Precision::single_precision);
        return kernels.lanes == 16 ? kernels : other_way(kernels);
    }();
    const cl::Program program = with_kernel(R"(
kernel void remember(global const Replica* replica, global real* memory, global real* out) {
    global real* own = memory_of(replica, memory, 1 * SLOTS);
    const int effects = replica->effects;
    const lanes numbers = convert_float16(SLOT_NUMBERS(0));
    const Memory stored = {{numbers + 100, numbers + 200, numbers + 300}, numbers + 400, numbers + 500};
    store_memory(replica, effects, stored, own, 0);
    const Memory loaded = load_memory(replica, effects, own, 0);
    out[0] = loaded.spring.x.s3, out[1] = loaded.spring.y.s3, out[2] = loaded.spring.z.s3;
    out[3] = loaded.deepest.s3, out[4] = loaded.relaxed.s3;
})",
                                            cpu_like);
    struct Replicas;
    struct Rows;
    struct Out;
    mcdem::Field<Replicas> of(device(), 1, sizeof replica);
    mcdem::Field<Rows> memory(device(), 2 * rows * slots, sizeof(float));
    mcdem::Field<Out> out(device(), 5, sizeof(float));
    of.write(&replica);
    std::vector<float> in_memory(2 * rows * slots, -1);
    memory.write(in_memory.data());
    mcdem::Kernel<mcdem::Field<Replicas>, mcdem::Field<Rows>, mcdem::Field<Out>>(
        device(), program, "remember", 1)(1, of, memory, out);
    std::vector<float> found(5);
    out.read(found.data());
    memory.read(in_memory.data());
    for (int row = 0; row < replica.memory_rows; ++row)
        found.push_back(in_memory[static_cast<std::size_t>((replica.memory_rows + row) * slots)]);
    const auto others = static_cast<std::size_t>(replica.memory_rows * slots);
    EXPECT_EQ(std::vector<float>(in_memory.begin(), in_memory.begin() + static_cast<std::ptrdiff_t>(others)),
              std::vector<float>(others, -1))
        << "another grain's memory was written";
    return found;
}

TEST(ContactMemory, KeepsEverythingWhereAllEffectsAreOn) {
    mcdem::f32::Replica replica{};
    replica.mindlin = 1;
    replica.memory_rows = 5;
    replica.deepest_row = 3;
    replica.relaxed_row = 4;
    replica.effects = EFFECT_PLASTICITY | EFFECT_VISCOELASTICITY;
    EXPECT_EQ(remembered(replica), (std::vector<float>{103, 203, 303, 403, 503, 100, 200, 300, 400, 500}));
}

TEST(ContactMemory, KeepsOnlyWhatTheReplicaNeeds) {
    mcdem::f32::Replica replica{};
    replica.memory_rows = 1;
    replica.relaxed_row = 0;
    replica.effects = EFFECT_VISCOELASTICITY;
    EXPECT_EQ(remembered(replica), (std::vector<float>{0, 0, 0, 0, 503, 500}));
}

}  // namespace
}  // namespace reference
