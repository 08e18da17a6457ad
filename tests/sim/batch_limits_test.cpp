// Memory of a batch: the estimate equals the allocation; batches that are too large are refused.
#include "sim/batch_limits.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "reference/test_scene.h"
#include "sim/device_replica.h"

namespace mcdem::reference {
namespace {

using mcdem::PackingSize;

mcdem::DeviceInfo large_device() {
    mcdem::DeviceInfo info;
    info.name = "abacus";
    info.memory = info.largest_allocation = std::size_t{1} << 40;
    info.largest_work_group = 4096;
    return info;
}

std::vector<Start> some_starts() {
    Replica springs = test_replica(ContactModel::independent);
    springs.contact.friction_law = FrictionLaw::mindlin;
    Replica plastic = test_replica(ContactModel::elastic_sphere);
    plastic.effects.plasticity = 0.1;
    plastic.effects.viscoelasticity = 0.2;
    return {jittered_lattice(test_replica(), 65, 1), jittered_lattice(springs, 1000, 2),
            jittered_lattice(plastic, 1, 3)};
}

std::string refusal(const mcdem::DeviceInfo& device, const KernelBuild& build,
                    const std::vector<Replica>& replicas, const std::vector<PackingSize>& sizes) {
    try {
        expect_within_limits(device, build, replicas, sizes);
    } catch (const mcdem::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(BatchLimits, EstimateEqualsTheEnginesAllocation) {
    const auto all = some_starts();
    for (const std::vector<Start>& starts :
         {std::vector{all[0]}, std::vector{all[1]}, std::vector{all[2]}, all})
        for (int slots : {16, 48})
            for (Precision precision : {Precision::single_precision, finest()}) {
                std::vector<Replica> replicas;
                std::vector<PackingSize> sizes;
                for (const Start& start : starts) {
                    replicas.push_back(start.replica);
                    sizes.push_back(size_of(start.packing));
                }
                const KernelBuild kernels = build(precision, slots);
                Batch batch(kernels, starts);
                std::uint64_t cells = 0;
                for (const PackingSize& size : sizes) cells += mcdem::max_cells(size.grains);
                const auto estimate =
                    mcdem::Fields::memory_of(mcdem::field_extents(kernels, replicas, sizes, cells));
                EXPECT_GE(mcdem::memory_needed(precision, slots, replicas, sizes).all,
                          batch.engine().memory().all);
                const auto taken = batch.engine().memory();
                const std::size_t grid =
                    4 * 9 * (65 + 1000 + 1 + 64);  // the cell list may have fewer cells than allowed
                EXPECT_GE(estimate.all, taken.all);
                EXPECT_LE(estimate.all, taken.all + grid);
                EXPECT_GE(estimate.largest_field, taken.largest_field);
            }
}

TEST(BatchLimits, MoreThanTheDevicesMemoryIsRefusedWithTheNumberOfReplicasThatFit) {
    const std::vector<Replica> replicas(100, test_replica());
    const std::vector<PackingSize> sizes(100, {1000, 0.02});
    const KernelBuild kernels;
    const auto needed = mcdem::memory_needed(kernels.precision, kernels.slots, replicas, sizes);
    mcdem::DeviceInfo device = large_device();
    device.memory = needed.all;
    device.largest_allocation = needed.largest_field;
    EXPECT_EQ(refusal(device, kernels, replicas, sizes), "");
    device.memory = needed.all - 1;
    EXPECT_THAT(
        refusal(device, kernels, replicas, sizes),
        testing::AllOf(testing::HasSubstr("memory on abacus"), testing::HasSubstr("--part-replicas 99")));
    device.memory = needed.all;
    device.largest_allocation = needed.largest_field / 2;
    EXPECT_THAT(
        refusal(device, kernels, replicas, sizes),
        testing::AllOf(testing::HasSubstr("largest piece"), testing::HasSubstr("--part-replicas 50")));
    EXPECT_THAT(refusal(device, kernels, {test_replica()}, {{1'000'000, 0.02}}),
                testing::HasSubstr("fewer grains"));
}

TEST(BatchLimits, SizesThatOverflowAreRefused) {
    const KernelBuild kernels{.slots = 64};
    const std::vector<Replica> four(4, test_replica());
    EXPECT_EQ(refusal(large_device(), kernels, four, std::vector<PackingSize>(4, {8'000'000, 0.02})), "");
    EXPECT_THAT(refusal(large_device(), kernels, four, std::vector<PackingSize>(4, {9'000'000, 0.02})),
                testing::HasSubstr("slots"));
    EXPECT_THAT(
        refusal(large_device(), kernels, four, std::vector<PackingSize>(4, {std::size_t{1} << 31, 0.02})),
        testing::HasSubstr("slots"));
    mcdem::DeviceInfo small_groups = large_device();
    small_groups.largest_work_group = 40;
    const auto refused = [&](int slots) {
        return refusal(small_groups, {.slots = slots, .lanes = 1, .group = 40}, four,
                       std::vector<PackingSize>(4, {8, 0.02}));
    };
    EXPECT_THAT(refused(32), "");
    EXPECT_THAT(refused(48), testing::HasSubstr("numerics.slots must be at most 32 on abacus"));
}

TEST(BatchLimits, TooManyStepsAreRefused) {
    Replica replica = test_replica();
    EXPECT_NO_THROW(mcdem::expect_countable_steps(replica, 1e-6));
    EXPECT_THROW(mcdem::expect_countable_steps(replica, 0), mcdem::InputError);
    EXPECT_THROW(mcdem::expect_countable_steps(replica, 1e-31), mcdem::InputError);
    replica.plate.speed = 1e-300;
    EXPECT_THROW(mcdem::expect_countable_steps(replica, 1e-6), mcdem::InputError);
    replica.plate.speed = 0.1;
    replica.protocol.relax_time = 1e6;
    EXPECT_THROW(mcdem::expect_countable_steps(replica, 1e-6), mcdem::InputError);
    replica.protocol.relax_time = 1;
    replica.protocol.cycles = replica.protocol.scans_per_stroke = 1000;
    replica.protocol.settle_time = 1;
    replica.protocol.stop_at_scans = true;
    EXPECT_THROW(mcdem::expect_countable_steps(replica, 1e-6), mcdem::InputError);
    replica.protocol.stop_at_scans = false;
    EXPECT_NO_THROW(mcdem::expect_countable_steps(replica, 1e-6));
}

TEST(BatchLimits, NumberOfCellsIsLimitedForAnyBox) {
    for (const auto& [x, y, z] : std::vector<std::array<double, 3>>{
             {1, 1, 1}, {1000, 1000, 1000}, {1000, 1e-3, 1e-3}, {1000, 1000, 1e-3}, {1e-3, 1e-3, 1000}}) {
        Replica replica = test_replica();
        replica.box = {x, y};
        replica.plate.start = z;
        for (std::size_t grains : {1, 2, 100, 100'000}) {
            const mcdem::Packing packing{std::vector<Vec3>(grains, Vec3::Zero()),
                                         std::vector<double>(grains, 1e-3)};
            const auto coarse = mcdem::device_replica<mcdem::f32::Replica>(replica, packing, {});
            const auto fine = mcdem::device_replica<mcdem::f64::Replica>(replica, packing, {});
            EXPECT_LE(mcdem::cell_count(coarse), mcdem::max_cells(grains));
            EXPECT_LE(mcdem::cell_count(fine), mcdem::max_cells(grains));
            EXPECT_GT(fine.cell_size[0], 1e-3);
            EXPECT_GE(fine.span_x, x / fine.cell_size[0] - 1.001);
        }
    }
}

}  // namespace
}  // namespace mcdem::reference
