// Sums over the slots of a grain in the GPU layout, with one work-item per slot. (On a CPU they need no
// kernel code.)
#include "kernels/test_kernel.h"

namespace reference::sums {
namespace {

constexpr int quantities = 7, sums = quantities + 2, slots = 16;

const char* const sum_kernel = R"(
WORK_GROUP(STEP_ITEMS) kernel void sum_rows(global const Block* blocks, global const real* values, global real* out) {
    MEMORY_OF_WORK_ITEM
    (void)table;
    const int first = FIRST_GRAIN(blocks[get_group_id(0)]);
    global const real* row = values + first * 7 * SLOTS;
    lanes v[7];
    for (int q = 0; q < 7; ++q) v[q] = load_slot(row, q * SLOTS, 0);
    const GrainSums slot = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
    share_sums(slot, scratch);
    SYNCHRONISE();
    const GrainSums total = add_up(slot, scratch);
    SYNCHRONISE();
    share(v[0], 0, scratch);
    share(v[1], 1, scratch);
    SYNCHRONISE();
    if (!IS_LEADER) return;
    global real* sum = out + first * 9;
    sum[0] = total.force.x, sum[1] = total.force.y, sum[2] = total.force.z;
    sum[3] = total.torque.x, sum[4] = total.torque.y, sum[5] = total.torque.z, sum[6] = total.trouble;
    sum[7] = sum_slots(v[0], 0, scratch), sum[8] = max_slots(v[1], 1, scratch);
})";

std::vector<float> summed(const std::vector<float>& values, KernelBuild kernels) {
    const int grains = static_cast<int>(values.size()) / (quantities * slots);
    const cl::Program program = with_kernel(sum_kernel, kernels);
    struct Blocks;
    struct Values;
    struct Sums;
    std::vector<mcdem::Block> all;
    for (int first = 0; first < grains; first += kernels.block()) all.push_back({0, first});
    mcdem::Field<Blocks> blocks(device(), all.size(), sizeof(mcdem::Block));
    mcdem::Field<Values> in(device(), values.size(), sizeof(float));
    mcdem::Field<Sums> out(device(), std::size_t(grains) * sums, sizeof(float));
    blocks.write(all.data());
    in.write(values.data());
    mcdem::Kernel<mcdem::Field<Blocks>, mcdem::Field<Values>, mcdem::Field<Sums>>(
        device(), program, "sum_rows", kernels.work_items())(all.size(), blocks, in, out);
    std::vector<float> found(std::size_t(grains) * sums);
    out.read(found.data());
    return found;
}

TEST(SlotSums, EqualTheSumsAndMaximaOfEachGrain) {
    Uniform uniform(3);
    std::vector<float> values;
    for (int i = 0; i < 64 * quantities * slots; ++i)
        values.push_back(static_cast<float>(uniform(-1, 1) * std::exp(uniform(-9, 9))));
    const KernelBuild kernels = build(Precision::single_precision);
    const auto found = summed(values, kernels.lanes == 1 ? kernels : other_way(kernels));
    for (int grain = 0; grain < 64; ++grain) {
        const float* row = &values[std::size_t(grain) * quantities * slots];
        for (int q = 0; q < quantities; ++q) {
            double sum = 0, size = 0;
            for (int slot = 0; slot < slots; ++slot)
                sum += row[q * slots + slot], size += std::abs(row[q * slots + slot]);
            EXPECT_NEAR(found[grain * sums + q], sum, 1e-6 * size);
        }
        EXPECT_EQ(found[grain * sums + 7], found[grain * sums]);
        EXPECT_EQ(found[grain * sums + 8], *std::max_element(row + slots, row + 2 * slots));
    }
}

}  // namespace
}  // namespace reference::sums
