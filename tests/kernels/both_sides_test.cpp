// What a contact takes from both of its grains has the same bits seen from either, however unequal they are.
#include "kernels/test_kernel.h"
#include "sim/device_replica.h"

namespace reference {
namespace {

constexpr int numbers = 3, row_size = 16;

const char* const pair_kernel = R"(
kernel void see_pairs(global const Replica* replicas, global const real* radii, global real* out) {
    const int i = get_global_id(0);
    const real here = radii[2 * i], there = radii[2 * i + 1];
    const mask no_wall = AS_MASK((slots)(0));
    const Reduced pair = reduced(replicas, here, (lanes)(there), no_wall);
    const ComplianceRatio ratio = {R(1), (lanes)(R(1))};
    const SelfConsistent solved = self_consistent(replicas, ratio, (lanes)(R(0.05) * (here + there)), pair.radius,
                                                  (lanes)(replicas->modulus_grain), here, (lanes)(there), no_wall);
    global real* row = out + (size_t)i * 3 * 16;
    STORE_LANES(pair.radius, row, 0);
    STORE_LANES(pair.mass, row + 16, 0);
    STORE_LANES(solved.overlap, row + 32, 0);
})";

/// R*, m* and the elastic sphere's overlap of each pair of radii.
std::vector<float> seen(const std::vector<float>& radii, const KernelBuild& kernels) {
    const Start start = jittered_lattice(test_replica(ContactModel::elastic_sphere), 8, 1);
    const auto constants =
        mcdem::device_replica<mcdem::f32::Replica>(start.replica, start.packing, {0, 8, 0});
    struct Radii;
    struct Seen;
    mcdem::Field<mcdem::Constants> replica(device(), 1, sizeof constants);
    mcdem::Field<Radii> in(device(), radii.size(), sizeof(float));
    mcdem::Field<Seen> out(device(), radii.size() / 2 * numbers * row_size, sizeof(float));
    replica.write(&constants);
    in.write(radii.data());
    mcdem::Kernel<mcdem::Field<mcdem::Constants>, mcdem::Field<Radii>, mcdem::Field<Seen>>(
        device(), with_kernel(pair_kernel, kernels), "see_pairs", 1)(radii.size() / 2, replica, in, out);
    std::vector<float> rows(radii.size() / 2 * numbers * row_size), found;
    out.read(rows.data());
    for (std::size_t place = 0; place < rows.size(); place += row_size) found.push_back(rows[place]);
    return found;
}

TEST(BothSides, OfAPairOfUnequalGrainsHaveTheSameBits) {
    Uniform uniform(5);
    std::vector<float> radii, swapped;
    for (int i = 0; i < 500; ++i) {
        radii.push_back(static_cast<float>(uniform(0.005, 0.02)));
        radii.push_back(static_cast<float>(uniform(0.005, 0.02)));
        swapped.insert(swapped.end(), {radii[2 * i + 1], radii[2 * i]});
    }
    const KernelBuild kernels = build(Precision::single_precision);
    for (const KernelBuild& way : {kernels, other_way(kernels)}) {
        const auto here = seen(radii, way);
        EXPECT_EQ(here, seen(swapped, way));
        const double a = radii[0], b = radii[1];
        EXPECT_NEAR(here[0], a * b / (a + b), 1e-6 * a);
        EXPECT_GT(here[2], 0.01 * (a + b));
    }
}

}  // namespace
}  // namespace reference
