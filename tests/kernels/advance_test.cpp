// Whole steps of the engine against the double-precision reference: every contact model and friction law,
// various numbers of grains, batches, both precisions, every allowed number of slots, the CPU and the GPU
// layout.
#include "kernels/steps_as_reference.h"

namespace mcdem::reference {
namespace {

/// A large probed gap gives grains 18 or more neighbours.
Start with_many_neighbours(Start start) {
    start.replica.numerics.probe_gap = 0.85;
    return start;
}

TEST(Step, FollowsTheReferenceForEveryModelAndSize) {
    for (Precision precision : precisions())
        for (int count : {1, 63, 64, 65}) {
            std::vector<Start> starts;
            for (ContactModel model : all_models)
                starts.push_back(start_of(model, FrictionLaw::saturated, count, count));
            expect_steps_as_reference(build(precision), starts, 7);
        }
}

TEST(Step, FollowsTheReferenceWithMindlinFriction) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : all_models) starts.push_back(start_of(model, FrictionLaw::mindlin, 65, 3));
        expect_steps_as_reference(build(precision), starts, 8);
    }
}

TEST(Step, FollowsTheReferenceWithAThousandGrains) {
    for (Precision precision : precisions())
        expect_steps_as_reference(build(precision),
                                  {start_of(ContactModel::mc_dem, FrictionLaw::mindlin, 1000, 5),
                                   start_of(ContactModel::elastic_sphere, FrictionLaw::saturated, 1000, 6)},
                                  9);
}

TEST(Step, FollowsTheReferenceInEveryContainer) {
    std::vector<Start> starts;
    for (ContactModel model : all_models)
        for (FrictionLaw law : {FrictionLaw::saturated, FrictionLaw::mindlin}) {
            Replica replica = test_replica(model);
            replica.contact.friction_law = law;
            starts.push_back(rings_in_a_cylinder(replica, 2, 21));
            starts.push_back(periodic_lattice(replica, 3, 2, 22));
        }
    starts[0].replica.effects.rolling_resistance = starts[1].replica.effects.rolling_resistance = 0.1;
    starts[0].replica.effects.adhesion = starts[1].replica.effects.adhesion = 0.02;
    starts[0].replica.effects.plate_tilt_x = 0.1;
    for (Precision precision : precisions()) expect_steps_as_reference(build(precision), starts, 23);
    starts.resize(8);
    if (has_other_way()) expect_steps_as_reference(other_way(build(finest())), starts, 24);
}

TEST(Step, FollowsTheReferenceInABatchOfDifferentReplicas) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        const int counts[] = {1, 64, 7, 65, 17, 16, 63};
        for (int r = 0; r < 7; ++r)
            starts.push_back(start_of(
                all_models[r % 6], r % 2 ? FrictionLaw::mindlin : FrictionLaw::saturated, counts[r], 20 + r));
        starts[3].replica.grains.youngs_modulus *= 2;
        starts[4].replica.grains.poisson_ratio = 0.3;
        starts[5].replica.grains.poisson_ratio = 0.5;
        starts[6].replica.numerics.time_step = 0.05;
        expect_steps_as_reference(build(precision), starts, 10);
    }
}

class Slots : public testing::TestWithParam<int> {};

TEST_P(Slots, FollowTheReference) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : {ContactModel::mc_dem, ContactModel::elastic_sphere})
            for (int count : {1, 17, 64}) {
                const Start start = start_of(model, FrictionLaw::mindlin, count, 31);
                starts.push_back(GetParam() > 16 ? with_many_neighbours(start) : start);
            }
        expect_steps_as_reference(build(precision, GetParam()), starts, 17);
    }
}

INSTANTIATE_TEST_SUITE_P(, Slots, testing::Values(16, 32, 48, 64));

TEST(Step, FollowsTheReferenceInBothLayouts) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : all_models) starts.push_back(start_of(model, FrictionLaw::mindlin, 17, 13));
        starts.push_back(start_of(ContactModel::mc_dem, FrictionLaw::saturated, 65, 14));
        for (const KernelBuild& way : all_ways(build(precision))) expect_steps_as_reference(way, starts, 15);
        for (Start& start : starts) start = with_many_neighbours(start);
        for (const KernelBuild& way : all_ways(build(precision, 32)))
            expect_steps_as_reference(way, starts, 16);
    }
}

// Checks the comparison itself: it detects a Young's modulus that is wrong by a thousandth.
TEST(Step, ComparisonDetectsAWrongModulus) {
    const Start start = start_of(ContactModel::mc_dem, FrictionLaw::saturated, 63, 1);
    Batch batch(build(Precision::single_precision), start);
    Start excess_compliance = start;
    excess_compliance.replica.grains.youngs_modulus *= 0.999;
    StepReference same = reference_of(batch.engine(), 0, start),
                  other = reference_of(batch.engine(), 0, excess_compliance);
    same.step();
    other.step();
    const auto result = batch.advance(1).front();
    EXPECT_LT(compare(batch.engine().state(0), result, same, 2e-5).worst(), 2e-5);
    const Differences d = compare(batch.engine().state(0), result, other, 2e-5);
    EXPECT_GT(d.force, 5e-4);
    EXPECT_GT(d.velocity, 2e-4);
    EXPECT_GT(d.wall_force, 5e-4);
}

}  // namespace
}  // namespace mcdem::reference
