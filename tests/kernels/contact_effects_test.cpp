// Steps with effects against the double-precision reference: each effect alone, replicas with different
// effects in one batch, all effects together; every contact model, both precisions, 16 and 32 slots, both
// layouts.
#include "kernels/steps_as_reference.h"

namespace mcdem::reference {
namespace {

using mcdem::Effects;

/// Amplitudes at which each effect changes forces by some per cent or more within a step.
const std::pair<double Effects::*, double> amplitudes[] = {
    {&Effects::adhesion, 0.02},          {&Effects::viscoelasticity, 0.3},
    {&Effects::stiffening, 0.8},         {&Effects::plasticity, 0.2},
    {&Effects::bulge_contacts, 0.4},     {&Effects::friction_history, 0.3},
    {&Effects::rolling_resistance, 0.2}, {&Effects::modulus_scatter, 0.2},
    {&Effects::plate_tilt_x, 0.02},      {&Effects::plate_tilt_y, -0.01},
    {&Effects::cohesion, 2e3},           {&Effects::net_force_friction, 0.6},
    {&Effects::law_exponent, 0.2},
};
constexpr double relaxation_time = 2e-3;  ///< a few steps

Effects all_effects() {
    Effects effects;
    effects.relaxation_time = relaxation_time;
    for (const auto& [effect, amplitude] : amplitudes) effects.*effect = amplitude;
    return effects;
}

/// One replica per effect, one with softening, and one without effects.
std::vector<Effects> one_by_one() {
    std::vector<Effects> each;
    for (const auto& [effect, amplitude] : amplitudes) {
        each.emplace_back().relaxation_time = relaxation_time;
        each.back().*effect = amplitude;
        if (effect == &Effects::net_force_friction) each.back().adhesion = 0.02;  // what it subtracts
    }
    each.emplace_back().stiffening = -0.8;
    each.emplace_back().law_exponent = -0.3;
    each.emplace_back();
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

TEST(EffectSteps, AllTogetherFollowTheReferenceInBothLayouts) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : all_models)
            starts.push_back(with_effects(all_effects(), model, FrictionLaw::mindlin, 17, 36));
        for (const KernelBuild& way : all_ways(build(precision)))
            expect_steps_as_reference(way, starts, 37, slack);
        for (Start& start : starts) start.replica.numerics.probe_gap = 0.85;  // 18 or more neighbours
        for (const KernelBuild& way : all_ways(build(precision, 32)))
            expect_steps_as_reference(way, starts, 38, slack);
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
        EXPECT_LT(compare(batch.engine().state(0), result, same, 5e-5).worst(), slack * 5e-5)
            << "effect " << k;
        EXPECT_GT(compare(batch.engine().state(0), result, other, 5e-5).worst(), 1e-3) << "effect " << k;
    }
}

}  // namespace
}  // namespace mcdem::reference
