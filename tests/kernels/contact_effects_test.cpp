// Steps with effects against the double-precision reference: each effect alone, replicas with different
// effects in one batch, all effects together; every contact model, both precisions, 16 and 32 slots, both
// layouts.
#include "kernels/steps_as_reference.h"

namespace reference {
namespace {

using mcdem::Effects;

/// Amplitudes at which each effect changes forces by some per cent or more within a step.
Effects all_effects() {
    Effects effects;
    effects.adhesion = 0.02;
    effects.cohesion = 2e3;
    effects.net_force_friction = 0.6;
    effects.viscoelasticity = 0.3;
    effects.relaxation_time = 2e-3;  // a few steps
    effects.stiffening = 0.8;
    effects.plasticity = 0.2;
    effects.bulge_contacts = 0.4;
    effects.friction_history = 0.3;
    effects.rolling_resistance = 0.2;
    effects.modulus_scatter = 0.2;
    effects.plate_tilt_x = 0.02;
    effects.plate_tilt_y = -0.01;
    return effects;
}

/// One replica per effect, and one without effects.
std::vector<Effects> one_by_one() {
    const Effects all = all_effects();
    std::vector<Effects> each(13);
    each[0].adhesion = all.adhesion;
    each[1].viscoelasticity = all.viscoelasticity;
    each[1].relaxation_time = all.relaxation_time;
    each[2].stiffening = all.stiffening;
    each[3].plasticity = all.plasticity;
    each[4].bulge_contacts = all.bulge_contacts;
    each[5].friction_history = all.friction_history;
    each[6].rolling_resistance = all.rolling_resistance;
    each[7].modulus_scatter = all.modulus_scatter;
    each[8].plate_tilt_x = all.plate_tilt_x;
    each[8].plate_tilt_y = all.plate_tilt_y;
    each[9].stiffening = -all.stiffening;
    each[10].cohesion = all.cohesion;
    each[11].adhesion = all.adhesion;
    each[11].net_force_friction = all.net_force_friction;
    return each;
}

/// Overlaps are a third of those in advance_test.cpp, so rounding errors of positions weigh more. Adhesion
/// in a gap is also steeper than any contact.
constexpr double slack = 5;

/// Smaller grains: half of the neighbours have a gap, some of them within the range of adhesion.
Start with_effects(const Effects& effects, ContactModel model, FrictionLaw law, int count, unsigned seed) {
    Start start = start_of(model, law, count, seed);
    for (auto& diameter : start.packing.diameter) diameter *= 0.96;
    start.replica.effects = effects;
    return start;
}

TEST(EffectSteps, EachAloneFollowsTheReferenceInOneBatch) {
    for (Precision precision : precisions())
        for (FrictionLaw law :
             {FrictionLaw::saturated, FrictionLaw::mindlin, FrictionLaw::mindlin_displacement}) {
            std::vector<Start> starts;
            for (const Effects& effects : one_by_one())
                starts.push_back(with_effects(effects, ContactModel::mc_dem, law, 64, 31));
            expect_steps_as_reference(build(precision), starts, 32, slack);
        }
}

TEST(EffectSteps, AllTogetherFollowTheReferenceForEveryModel) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : all_models)
            starts.push_back(with_effects(all_effects(), model, FrictionLaw::saturated, 65, 33));
        starts.push_back(with_effects({}, ContactModel::mc_dem, FrictionLaw::mindlin, 17, 34));
        expect_steps_as_reference(build(precision), starts, 35, slack);
    }
}

TEST(EffectSteps, AllTogetherFollowTheReferenceInTheOtherLayout) {
    SKIP_WITHOUT_OTHER_WAY();
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : all_models)
            starts.push_back(with_effects(all_effects(), model, FrictionLaw::mindlin, 17, 36));
        expect_steps_as_reference(other_way(build(precision)), starts, 37, slack);
        for (Start& start : starts) start.replica.numerics.probe_gap = 0.85;  // 18 or more neighbours
        expect_steps_as_reference(build(precision, 32), starts, 38, slack);
        expect_steps_as_reference(other_way(build(precision, 32)), starts, 38, slack);
    }
}

// Checks the comparison itself: it detects each effect if the reference lacks it.
TEST(EffectSteps, ComparisonDetectsEachMissingEffect) {
    auto each = one_by_one();
    each.pop_back();
    for (std::size_t k = 0; k < each.size(); ++k) {
        const Start start = with_effects(each[k], ContactModel::mc_dem, FrictionLaw::saturated, 64, 31);
        Start plain = start;
        plain.replica.effects = {};
        Batch batch(build(Precision::single_precision), start);
        Uniform uniform(39);
        batch.engine().set_velocities(0, uniform.vectors(64, 0.05), uniform.vectors(64, 5));
        StepReference same = reference_of(batch.engine(), 0, start),
                      other = reference_of(batch.engine(), 0, plain);
        mcdem::IntervalResult result;
        for (int step = 0; step < 3; ++step) {
            for (StepReference* reference : {&same, &other}) {
                reference->set_time_step(batch.engine().time_step(0));
                reference->step();
            }
            result = batch.advance(1).front();
        }
        EXPECT_LT(compare(batch.engine(), 0, result, same, 5e-5).worst(), slack * 5e-5) << "effect " << k;
        EXPECT_GT(compare(batch.engine(), 0, result, other, 5e-5).worst(), 1e-3) << "effect " << k;
    }
}

}  // namespace
}  // namespace reference
