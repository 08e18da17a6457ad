// Bit-identical results of all kinds of programmes, effects and containers: of a replica alone and in any
// batch, and after a restart at any point.
#include <functional>

#include "core/errors.h"
#include "sim/whole_run.h"

namespace mcdem::reference::family_bits {
namespace {

mcdem::Stage force_of(double force, double speed) {
    mcdem::Stage stage;
    stage.force = force;
    stage.speed = speed;
    return stage;
}

/// A programme with all kinds of stages of a plate.
Start programmed_lattice(int kind) {
    Replica replica = test_replica(all_models[(kind + 4) % 6]);
    replica.contact.friction_law = FrictionLaw::mindlin;
    replica.effects.viscoelasticity = kind == 1 ? 0.3 : 0;
    const int counts[] = {27, 8, 18};
    const double forces[] = {1.5, 1, 1.2};
    Start start = jittered_lattice(replica, counts[kind], 40 + kind);
    shorten(start);
    auto& programme = start.replica.programme;
    programme.resize(4);
    programme[0] = force_of(forces[kind], start.replica.plate.speed);
    programme[1].kind = mcdem::StageKind::hold;
    programme[1].keep = mcdem::Controlled::force;
    programme[1].time = 0.005;
    programme[2].kind = mcdem::StageKind::cycle;
    programme[2].position = 0.95 * start.replica.plate.start;
    programme[2].back = 0.97 * start.replica.plate.start;
    programme[2].scans = 0;
    programme[3].kind = mcdem::StageKind::repeat;
    start.replica.plate.end = 0.7 * start.replica.plate.start;
    return start;
}

/// A move to a pressure, then a triaxial path with a shear stress, then a hold of its stresses.
void set_stresses(std::vector<mcdem::Stage>& programme) {
    programme[0].strain = mcdem::not_given;
    programme[0].pressure = 250;
    programme[1] = {};
    programme[1].stress_x = programme[1].stress_y = 200;
    programme[1].strain_z = 0.05;
    programme[1].stress_xz = -20;
    programme[1].scan_at = {0.04};
    programme[2].keep = mcdem::Controlled::stress;
}

Start programmed_cell(int kind) {
    Replica replica = test_replica(all_models[(kind + 4) % 6]);
    replica.contact.friction_law = FrictionLaw::mindlin;
    replica.effects.viscoelasticity = kind == 1 ? 0.3 : 0;
    Start start = cell_lattice(replica, 3 + kind % 2, 40 + kind);
    shorten(start);
    auto& programme = start.replica.programme;
    programme.resize(4);
    programme[0].strain = 0.01;
    programme[1].shear_xy = 0.1 + 0.02 * kind;
    programme[1].strain_z = 0.02;
    programme[2].kind = mcdem::StageKind::hold;
    programme[2].time = 0.005;
    programme[3].kind = mcdem::StageKind::repeat;
    if (kind >= 3) set_stresses(programme);
    for (auto& stage : programme) stage.rate = 5;
    return start;
}

/// A different set of effects for each kind, with and without memory.
mcdem::Effects effects_of(int kind) {
    mcdem::Effects effects;
    switch (kind) {
        case 1:
            effects.viscoelasticity = 0.4, effects.relaxation_time = 0.01;
            break;
        case 2:
            effects.plasticity = 0.3, effects.stiffening = 0.5, effects.law_exponent = 0.2;
            break;
        case 3:
            effects.adhesion = 0.03, effects.rolling_resistance = 0.1, effects.friction_history = 0.5;
            break;
        case 4:
            effects.modulus_scatter = 0.3, effects.bulge_contacts = 0.3, effects.polydispersity = 1e-4;
            break;
        case 5:
            effects.width_error_x = 1e-3, effects.width_error_y = -5e-4, effects.law_exponent = -0.2;
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

/// Kind 0 is without effects.
Start with_effects(int kind) {
    Replica replica = test_replica(ContactModel::mc_dem);
    replica.protocol.scans_per_stroke = 2;
    Start start = jittered_lattice(replica, kind % 2 ? 27 : 17, 70 + kind);
    shorten(start);
    for (auto& diameter : start.packing.diameter) diameter *= 0.97;
    start.replica.effects = effects_of(kind);
    return start;
}

/// Boxes, cylinders and periodic containers.
Start contained(int kind) {
    Replica replica = test_replica(ContactModel::mc_dem);
    replica.contact.friction_law = FrictionLaw::mindlin;
    Start start = kind == 0   ? rings_in_a_cylinder(replica, 2, 1)
                  : kind == 1 ? jittered_lattice(replica, 27, 2)
                              : periodic_lattice(replica, 3, 2, 3);
    shorten(start);
    start.replica.protocol.scans_per_stroke = 2;
    return start;
}

struct Family {
    const char* name;
    std::function<Start(int)> start;
    std::vector<int> together, restarted;  ///< kinds
    int scans = 4;
    bool in_double = false;  ///< too
};

const Family families[] = {
    {"Programmes", programmed_lattice, {1, 2, 0}, {0, 1}, 2},
    {"Cells", programmed_cell, {1, 3, 2, 0}, {0, 1, 3}},
    {"Effects", with_effects, {0, 1, 2, 3, 4, 5, 6}, {1, 2, 5, 6}, 4, true},
    {"Containers", contained, {0, 1, 2}, {0, 1, 2}},
};

class FamilyBits : public testing::TestWithParam<Family> {
protected:
    std::vector<Start> starts(const std::vector<int>& kinds) const {
        std::vector<Start> all;
        for (const int kind : kinds) all.push_back(GetParam().start(kind));
        return all;
    }
};

TEST_P(FamilyBits, AreTheSameAloneAndInABatch) {
    const auto together = starts(GetParam().together);
    expect_same_alone(Precision::single_precision, together, GetParam().scans);
    if (GetParam().in_double) expect_same_alone(finest(), together, GetParam().scans);
}

TEST_P(FamilyBits, AreTheSameAfterARestart) {
    expect_same_after_restarts(starts(GetParam().restarted), GetParam().scans);
}

INSTANTIATE_TEST_SUITE_P(All, FamilyBits, testing::ValuesIn(families),
                         [](const auto& family) { return std::string(family.param.name); });

TEST(EffectBits, ACheckpointWithoutThisMemoryIsRefused) {
    WholeRun with(Precision::single_precision, {with_effects(1)}),
        without(Precision::single_precision, {with_effects(3)});
    EXPECT_THROW(with.restore(without.save()), mcdem::RunError);
    auto damaged = with.save();
    damaged.erase("plates");
    EXPECT_THROW(with.restore(damaged), mcdem::RunError);
}

// Effects given at their default values change nothing; each of the effects above changes the results.
TEST(EffectBits, DefaultValuesChangeNothing) {
    std::vector<Start> plain{with_effects(0)}, defaults = plain;
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
}  // namespace mcdem::reference::family_bits
