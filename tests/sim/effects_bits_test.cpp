// Effects of a replica do not change other replicas: bit-identical results alone, beside any effects, and
// after a restart.
#include "core/errors.h"
#include "sim/whole_run.h"

namespace reference::effects_bits {
namespace {

using mcdem::Effects;

/// A different set of effects for each kind, with and without memory.
Effects effects_of(int kind) {
    Effects effects;
    switch (kind) {
        case 1:
            effects.viscoelasticity = 0.4, effects.relaxation_time = 0.01;
            break;
        case 2:
            effects.plasticity = 0.3, effects.stiffening = 0.5;
            break;
        case 3:
            effects.adhesion = 0.03, effects.rolling_resistance = 0.1, effects.friction_history = 0.5;
            break;
        case 4:
            effects.modulus_scatter = 0.3, effects.bulge_contacts = 0.3, effects.polydispersity = 1e-4;
            break;
        case 5:
            effects.plate_compliance = 0.02, effects.plate_tilt_x = 0.02, effects.viscoelasticity = 0.2;
            break;
        case 6:
            effects.plate_compliance = 0.01, effects.plasticity = 0.2, effects.viscoelasticity = 0.3;
            effects.adhesion = 0.01, effects.cohesion = 300, effects.net_force_friction = 0.5;
            effects.modulus_scatter = 0.2, effects.diameter_error = 5e-5;
            break;
        default:
            break;
    }
    return effects;
}

std::vector<Start> starts(const std::vector<int>& kinds) {
    std::vector<Start> all;
    for (int kind : kinds) {
        Replica replica = test_replica(ContactModel::mc_dem);
        replica.plate.speed = 0.2;
        replica.protocol.scans_per_stroke = 2;
        replica.protocol.relax_time = replica.protocol.settle_time = 0.03;
        Start start = jittered_lattice(replica, kind % 2 ? 27 : 17, 70 + kind);
        for (auto& diameter : start.packing.diameter) diameter *= 0.97;
        start.replica.effects = effects_of(kind);
        all.push_back(start);
    }
    return all;
}

TEST(EffectBits, AReplicaIsTheSameAloneAndBesideAnyEffects) {
    for (Precision precision : {Precision::single_precision, finest()}) {
        WholeRun all(precision, starts({0, 1, 2, 3, 4, 5, 6}));
        all.finish();
        for (int kind = 0; kind < 7; ++kind) {
            WholeRun alone(precision, starts({kind}));
            alone.finish();
            expect_same(alone, 0, all, kind);
        }
    }
}

TEST(EffectBits, ARestartRestoresTheMemoryOfEffects) {
    const auto kinds = starts({1, 2, 5, 6});
    WholeRun whole(Precision::single_precision, kinds);
    whole.finish();
    for (int rounds : {0, 1, 5, 15}) {
        WholeRun first(Precision::single_precision, kinds), second(Precision::single_precision, kinds);
        first.advance(rounds);
        const auto saved = first.save();
        second.restore(saved);
        second.told = first.told;
        EXPECT_TRUE(second.save() == saved) << "after " << rounds << " rounds";
        second.finish();
        for (int r = 0; r < 4; ++r) expect_same(whole, r, second, r);
    }
}

TEST(EffectBits, ACheckpointWithoutThisMemoryIsRefused) {
    WholeRun with(Precision::single_precision, starts({1})),
        without(Precision::single_precision, starts({3}));
    EXPECT_THROW(with.restore(without.save()), mcdem::RunError);
    auto damaged = with.save();
    damaged.erase("plates");
    EXPECT_THROW(with.restore(damaged), mcdem::RunError);
}

// Effects given at their default values change nothing; each of the effects above changes the results.
TEST(EffectBits, DefaultValuesChangeNothing) {
    auto plain = starts({0}), defaults = plain;
    defaults[0].replica.effects.relaxation_time = 7;  // unused
    WholeRun one(Precision::single_precision, plain), other(Precision::single_precision, defaults);
    one.finish();
    other.finish();
    expect_same(one, 0, other, 0);
    for (int kind = 1; kind < 7; ++kind) {
        auto changed = plain;
        changed[0].replica.effects = effects_of(kind);
        WholeRun with(Precision::single_precision, changed);
        with.finish();
        EXPECT_FALSE(with.told[0] == one.told[0]) << kind;
    }
}

}  // namespace
}  // namespace reference::effects_bits
