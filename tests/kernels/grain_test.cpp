// Work of one grain's slots: sums over them in the GPU layout, the number of slots in use, status bits, and
// the way since the neighbour list was built.
#include <bit>

#include "kernels/test_kernel.h"

namespace mcdem::reference::grains {
namespace {

constexpr int slots = 16, grains = 64;

/// The layouts that the device runs.
std::vector<KernelBuild> ways() { return all_ways(build(Precision::single_precision)); }

// With one work-item per slot. (A work-item of a CPU has already combined all slots.)
TEST(GrainSums, EqualTheSumsAndMaximaOfEachGrain) {
    constexpr int quantities = 7, sums = quantities + 2;
    Uniform uniform(3);
    std::vector<float> values;
    for (int i = 0; i < grains * slots * quantities; ++i)
        values.push_back(static_cast<float>(uniform(-1, 1) * std::exp(uniform(-9, 9))));
    const KernelBuild kernels = build(Precision::single_precision);
    const auto found =
        mapped_slots(R"(
        lanes v[7];
        for (int q = 0; q < 7; ++q) v[q] = READ(0, q);
        const GrainSums slot = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
        share_sums(slot, scratch);
        SYNCHRONISE();
        const GrainSums total = add_up(slot, scratch);
        SYNCHRONISE();
        share(v[0], 0, scratch);
        share(v[1], 1, scratch);
        SYNCHRONISE();
        if (!IS_LEADER) return;
        const lanes sums[9] = {total.force.x,  total.force.y,  total.force.z,
                               total.torque.x, total.torque.y, total.torque.z, total.trouble,
                               sum_slots(v[0], 0, scratch), max_slots(v[1], 1, scratch)};
        for (int q = 0; q < 9; ++q) WRITE(0, q, sums[q]);)",
                     {}, values, quantities, sums, kernels.lanes == 1 ? kernels : other_way(kernels));
    for (std::size_t grain = 0; grain < grains; ++grain) {
        const float *row = &values[grain * slots * quantities], *sum = &found[grain * slots * sums];
        double largest = -HUGE_VAL;
        for (int q = 0; q < quantities; ++q) {
            double expected = 0, size = 0;
            for (int slot = 0; slot < slots; ++slot) {
                const double value = row[slot * quantities + q];
                expected += value, size += std::abs(value);
                if (q == 1) largest = std::max(largest, value);
            }
            EXPECT_NEAR(sum[q], expected, 1e-6 * size);
        }
        EXPECT_EQ(sum[7], sum[0]);
        EXPECT_EQ(sum[8], largest);
    }
}

// The slots of a grain are filled from the start. A vector of grains ends with the last slot that any of them
// uses; a work-item of a GPU has one slot.
TEST(LoadPartners, ReadsAllSlotsInUse) {
    std::vector<float> partners(grains * slots, NO_PARTNER);
    const auto used = [](int grain) { return (grain * 5 + 3) % 13 + grain / 16; };
    for (int grain = 0; grain < grains; ++grain)
        for (int slot = 0; slot < used(grain); ++slot) partners[grain * slots + slot] = grain + 100.0F * slot;
    for (const KernelBuild& way : ways()) {
        const auto found = mapped_slots(R"(
            global int* field = (global int*)out; /* the first half of the result */
            const size_t row = FIRST_SLOT(first);
            for (int v = 0; v < SLOTS_HERE; ++v) STORE_LANES(AS_SLOTS(READ(v, 0)), field + SLOT_PLACE(row, SLOT(v)));
            slots partner[SLOTS_HERE];
            const int count = load_partners(field, row, partner);
            const int results = (int)get_num_groups(0) * BLOCK * SLOTS;
            for (int v = 0; v < SLOTS_HERE; ++v)
                for (int lane = 0; lane < LANES; ++lane)
                    out[results + (first + lane) * SLOTS + SLOT(v)] = v < count ? LANE(int, partner[v], lane) : R(-2);)",
                                        {}, partners, 1, 2, way);
        for (int grain = 0; grain < grains; ++grain) {
            int last = slots;
            if (way.lanes > 1) {
                last = 0;
                for (int other = grain / 16 * 16; other < grain / 16 * 16 + 16; ++other)
                    last = std::max(last, used(other));
            }
            for (int slot = 0; slot < slots; ++slot)
                EXPECT_EQ(found[(grains + grain) * slots + slot],
                          slot < last ? partners[grain * slots + slot] : -2)
                    << grain << ' ' << slot;
        }
    }
}

TEST(ReportStatus, AddsTheBitsOfEachGrain) {
    std::vector<float> bits(grains * slots, 0);
    for (int grain = 0; grain < grains; ++grain)
        bits[grain * slots] = grain % 3 == 0 ? STATUS_LOST : grain % 3 == 1 ? 0 : STATUS_SLOTS;
    for (const KernelBuild& way : ways()) {
        const auto found = mapped_slots(R"(
            global int* status = (global int*)out;
            if (!IS_LEADER) return;
            for (int lane = 0; lane < LANES; ++lane) status[first + lane] = STATUS_OVERLAP;
            report_status(first, AS_SLOTS(READ(0, 0)), status);)",
                                        {}, bits, 1, 1, way);
        for (int grain = 0; grain < grains; ++grain)
            EXPECT_EQ(std::bit_cast<int>(found[grain]),
                      STATUS_OVERLAP | static_cast<int>(bits[grain * slots]));
    }
}

// In a deformed cell the way is F (X - X_listed), with F at the current time of the interval.
TEST(WaySinceListed, IsThatInTheDeformedCell) {
    mcdem::f32::Replica replica{};
    const float start[] = {1.1F, 0.9F, 0.8F, 0.2F, -0.1F, 0.3F},
                rate[] = {0.5F, -0.4F, 0.3F, 0.2F, 0.1F, -0.6F};
    std::copy(std::begin(start), std::end(start), replica.deformation);
    std::copy(std::begin(rate), std::end(rate), replica.deformation_rate);
    Uniform uniform(6);
    std::vector<float> tracks;  // of each grain 48 numbers: its track of 12, its position, others
    for (int i = 0; i < 3 * grains * slots; ++i) tracks.push_back(static_cast<float>(uniform(-1, 1)));
    for (const int container : {CONTAINER_BOX, CONTAINER_CELL})
        for (const KernelBuild& way : ways()) {
            replica.container = container;
            const auto found = mapped_slots(R"(
                const slots grain = first + LANE_NUMBERS;
                const Grain at = {.replica = replica, .first = first, .elapsed = R(0.25)};
                const lanes3 position = {gather(in, grain * 48 + 12), gather(in, grain * 48 + 13),
                                         gather(in, grain * 48 + 14)};
                const lanes3 way = way_since_listed(at, (global const Track*)in, 4 * grain, position);
                if (!IS_LEADER) return;
                WRITE(0, 0, way.x);
                WRITE(0, 1, way.y);
                WRITE(0, 2, way.z);)",
                                            replica, tracks, 3, 3, way);
            double f[6];
            for (int k = 0; k < 6; ++k) f[k] = start[k] + 0.25 * rate[k];
            Eigen::Matrix3d deformation = Eigen::Matrix3d::Identity();
            if (container == CONTAINER_CELL) deformation << f[0], f[3], f[4], 0, f[1], f[5], 0, 0, f[2];
            for (int grain = 0; grain < grains; ++grain) {
                const auto vector = [](const float* x) { return Vec3(x[0], x[1], x[2]); };
                const float* row = &tracks[grain * slots * 3];
                const Vec3 expected = deformation * (vector(row + 12) - vector(row));
                EXPECT_LT((vector(&found[grain * slots * 3]) - expected).norm(), 1e-6);
            }
        }
}

}  // namespace
}  // namespace mcdem::reference::grains
