// Grains of several species: whole steps against the double-precision reference; identical species give the
// same bits as a single material; pair constants have the same bits from either grain of a contact.
#include "kernels/steps_as_reference.h"
#include "kernels/test_kernel.h"
#include "sim/device_material.h"
#include "sim/device_replica.h"

namespace mcdem::reference {
namespace {

using mcdem::GrainMaterial;

/// Three species that differ in all properties; a pair and a wall contact with constants of their own.
void give_species(Start& start) {
    start.replica.species = {{"a", {23.3e3, 0.45, 1000, 300, 0.3, 0.7}},
                             {"b", {9e3, 0.3, 2500, 1500, 0.1, 0.9}},
                             {"c", {8e4, 0.5, 700, -100, 0.6, 0.5}}};
    start.replica.pairs = {{"c", "a", 0.45, 0.65}, {"b", "walls", 0.05, mcdem::not_given}};
    for (std::size_t i = 0; i < start.packing.size(); ++i)
        start.packing.species.push_back(static_cast<int>((i * i + i / 7) % 3));
}

Start of_species(ContactModel model, FrictionLaw law, int count, unsigned seed) {
    Start start = start_of(model, law, count, seed);
    give_species(start);
    return start;
}

TEST(Species, FollowTheReferenceForEveryModelAndLayout) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : all_models)
            for (FrictionLaw law : {FrictionLaw::saturated, FrictionLaw::mindlin})
                starts.push_back(of_species(model, law, 33, 41));
        starts.push_back(start_of(ContactModel::mc_dem, FrictionLaw::mindlin, 17, 42));
        for (const KernelBuild& way : all_ways(build(precision)))
            expect_steps_as_reference(way, starts, 43, 2);
    }
}

TEST(Species, FollowTheReferenceWithEffects) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : {ContactModel::mc_dem, ContactModel::elastic_sphere}) {
            Start start = of_species(model, FrictionLaw::mindlin, 33, 44);
            for (double& diameter : start.packing.diameter) diameter *= 0.97;
            auto& effects = start.replica.effects;
            effects.adhesion = 0.02;
            effects.viscoelasticity = 0.3;
            effects.relaxation_time = 2e-3;
            effects.stiffening = 0.8;
            effects.plasticity = 0.2;
            effects.rolling_resistance = 0.2;
            effects.modulus_scatter = 0.2;
            starts.push_back(start);
        }
        expect_steps_as_reference(build(precision), starts, 45, 5);
    }
}

/// All contacts and motions after some steps of grains of `species`, which may be empty.
mcdem::ReplicaState moved(Start start, const std::vector<mcdem::Species>& species, const KernelBuild& way) {
    start.replica.species = species;
    if (!species.empty())
        for (std::size_t i = 0; i < start.packing.size(); ++i)
            start.packing.species.push_back(static_cast<int>(i % species.size()));
    Batch batch(way, start);
    Uniform uniform(46);
    const std::size_t count = start.packing.size();
    batch.engine().set_velocities(0, uniform.vectors(count, 0.05), uniform.vectors(count, 5));
    EXPECT_EQ(batch.advance(20)[0].status, 0);
    return batch.engine().state(0);
}

TEST(Species, IdenticalSpeciesGiveTheBitsOfOneMaterial) {
    if (!fuses_alike()) GTEST_SKIP() << "the compiler fuses products and sums differently in the two builds";
    for (Precision precision : precisions())
        for (const KernelBuild& way : all_ways(build(precision)))
            for (ContactModel model : all_models) {
                Start start = start_of(model, FrictionLaw::mindlin, 40, 47);
                start.replica.effects.rolling_resistance = model == ContactModel::mc_dem ? 0.2 : 0;
                GrainMaterial material = start.replica.grains;
                material.drag = 0;  // belongs to [grains]
                const mcdem::Species one{"one", material}, other{"other", material};
                const auto plain = moved(start, {}, way);
                EXPECT_TRUE(same_bits(moved(start, {one, other, other}, way), plain)) << name(model);
                const mcdem::Species softer{"softer",
                                            {0.9 * material.youngs_modulus, 0.45, 1000, 300, 0.3, 0.7}};
                EXPECT_FALSE(same_bits(moved(start, {one, softer}, way), plain)) << name(model);
            }
}

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
    const Buffer out = room_for<float>(radii.size() / 2 * numbers);
    launch(with_kernel(pair_kernel, kernels), "see_pairs", 1, radii.size() / 2, uploaded(constants),
           uploaded(kept), uploaded(radii), out);
    return downloaded<float>(out);
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

TEST(Species, PairConstantsHaveTheSameBitsFromBothSidesForUnequalSizes) {
    expect_same_from_both_sides(test_replica(ContactModel::elastic_sphere), 0.01);
}

TEST(Species, PairConstantsHaveTheSameBitsFromBothSidesForTwoSpecies) {
    Replica scene = test_replica(ContactModel::elastic_sphere);
    scene.species = {{"soft", {1e4, 0.49, 900, 900, 0.1, 0.9}}, {"stiff", {7e5, 0.2, 2500, 2500, 0.4, 0.6}}};
    expect_same_from_both_sides(scene, 0.01);
}

}  // namespace
}  // namespace mcdem::reference
