// Grains of several species: whole steps against the double-precision reference; identical species give the
// same bits as a single material.
#include "kernels/steps_as_reference.h"

namespace reference {
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

}  // namespace
}  // namespace reference
