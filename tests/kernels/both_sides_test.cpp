// Pair quantities have the same bits when computed from either grain of a contact.
#include "kernels/test_kernel.h"
#include "sim/device_material.h"
#include "sim/device_replica.h"

namespace reference {
namespace {

constexpr int numbers = 3;

const char* const pair_kernel = R"(
kernel void see_pairs(global const Replica* replicas, global const Material* materials, global const real* radii,
                      global real* out) {
    const int i = get_global_id(0);
    const real here = radii[2 * i], there = radii[2 * i + 1];
    const int species = SPECIES > 1 ? i & 1 : 0; /* of the first; the second of a pair is of the other */
    Moving now = {ZERO3, (lanes)(here), ZERO3, R(0), ZERO3, (lanes)((real)species)};
    const Grain at = grain_at(replicas, materials, 0, 0, 0, now);
    Neighbours neighbour;
    neighbour.wall = AS_MASK((slots)(0));
    neighbour.radius = (lanes)(there);
    neighbour.species = (slots)(1 - species);
    const Reduced pair = reduced(at, neighbour);
    const ComplianceRatio ratio = {R(1), R(1)};
    const SelfConsistent solved = self_consistent(at, neighbour, ratio, (lanes)(R(0.05) * (here + there)), pair.radius,
                                                  OF_PAIRS(at, modulus, neighbour));
    out[3 * i] = LANE(real, pair.radius, i);
    out[3 * i + 1] = LANE(real, pair.mass, i);
    out[3 * i + 2] = LANE(real, solved.overlap, i);
})";

/// R*, m* and the elastic sphere's overlap for each pair of radii.
std::vector<float> pair_quantities(const std::vector<float>& radii, KernelBuild kernels,
                                   const Replica& scene) {
    const Start start = jittered_lattice(scene, 8, 1);
    kernels.species = mcdem::materials_kept({scene});
    const auto constants =
        mcdem::device_replica<mcdem::f32::Replica>(start.replica, start.packing, {0, 8, 0});
    const auto kept = mcdem::device_materials<mcdem::f32::Material>({start.replica}, kernels.species);
    struct Radii;
    struct Quantities;
    mcdem::Field<mcdem::Constants> replica(device(), 1, sizeof constants);
    mcdem::Field<mcdem::Materials> material(device(), kept.size(), sizeof kept[0]);
    mcdem::Field<Radii> in(device(), radii.size(), sizeof(float));
    mcdem::Field<Quantities> out(device(), radii.size() / 2 * numbers, sizeof(float));
    replica.write(&constants);
    material.write(kept.data());
    in.write(radii.data());
    mcdem::Kernel<mcdem::Field<mcdem::Constants>, mcdem::Field<mcdem::Materials>, mcdem::Field<Radii>,
                  mcdem::Field<Quantities>>(device(), with_kernel(pair_kernel, kernels), "see_pairs", 1)(
        radii.size() / 2, replica, material, in, out);
    std::vector<float> found(radii.size() / 2 * numbers);
    out.read(found.data());
    return found;
}

void expect_same_from_both_sides(const Replica& scene, double overlap) {
    Uniform uniform(5);
    std::vector<float> radii, swapped;
    for (int i = 0; i < 500; ++i) {
        const float a = static_cast<float>(uniform(0.005, 0.02)),
                    b = static_cast<float>(uniform(0.005, 0.02));
        radii.insert(radii.end(), {a, b, b, a});
        swapped.insert(swapped.end(), {b, a, a, b});
    }
    const KernelBuild kernels = build(Precision::single_precision);
    for (const KernelBuild& way : all_ways(kernels)) {
        const auto here = pair_quantities(radii, way, scene);
        EXPECT_GT(here[2], overlap * (radii[0] + radii[1]));
        EXPECT_NEAR(here[0], double(radii[0]) * radii[1] / (radii[0] + radii[1]), 1e-6 * radii[0]);
        // With two species, each pair also occurs with the species exchanged.
        const auto there = pair_quantities(swapped, way, scene);
        for (std::size_t pair = 0; pair < radii.size() / 2; ++pair)
            for (int k = 0; k < numbers; ++k)
                EXPECT_EQ(here[pair * numbers + k],
                          scene.species.empty() ? there[pair * numbers + k] : here[(pair ^ 1) * numbers + k]);
    }
}

TEST(BothSides, HaveTheSameBitsForGrainsOfUnequalSize) {
    expect_same_from_both_sides(test_replica(ContactModel::elastic_sphere), 0.01);
}

TEST(BothSides, HaveTheSameBitsForGrainsOfTwoSpecies) {
    Replica scene = test_replica(ContactModel::elastic_sphere);
    scene.species = {{"soft", {1e4, 0.49, 900, 900, 0.1, 0.9}}, {"stiff", {7e5, 0.2, 2500, 2500, 0.4, 0.6}}};
    expect_same_from_both_sides(scene, 0.01);
}

}  // namespace
}  // namespace reference
