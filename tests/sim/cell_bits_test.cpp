// Cells with a programme: bit-identical alone, in a batch, and after a restart at any point.
#include "sim/whole_run.h"

namespace reference {
namespace {

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

Start programmed(int kind) {
    Replica replica = test_replica(all_models[(kind + 4) % 6]);
    replica.contact.friction_law = FrictionLaw::mindlin;
    replica.effects.viscoelasticity = kind == 1 ? 0.3 : 0;
    replica.protocol.relax_time = replica.protocol.settle_time = 0.03;
    Start start = cell_lattice(replica, 3 + kind % 2, 40 + kind);
    auto& programme = start.replica.programme;
    programme.resize(4);
    programme[0].strain = 0.01;
    programme[1].shear_xy = 0.1 + 0.02 * kind;
    programme[1].strain_z = 0.02;
    programme[2].kind = mcdem::StageKind::hold;
    programme[2].time = 0.02;
    programme[3].kind = mcdem::StageKind::repeat;
    if (kind >= 3) set_stresses(programme);
    for (auto& stage : programme) stage.rate = 2;
    return start;
}

std::vector<Start> programmes(const std::vector<int>& kinds) {
    std::vector<Start> all;
    for (const int kind : kinds) all.push_back(programmed(kind));
    return all;
}

TEST(CellBits, AreTheSameAloneAndInABatch) {
    WholeRun alone(Precision::single_precision, programmes({0})),
        four(Precision::single_precision, programmes({1, 3, 2, 0})),
        stress(Precision::single_precision, programmes({3}));
    for (WholeRun* run : {&alone, &four, &stress}) run->finish();
    expect_same(alone, 0, four, 3);
    expect_same(stress, 0, four, 1);
}

TEST(CellBits, AreTheSameAfterARestart) {
    for (const auto& kinds : {std::vector{0, 1}, std::vector{3}}) {
        const auto starts = programmes(kinds);
        WholeRun whole(Precision::single_precision, starts);
        int rounds = 0;
        while (whole.advance()) ++rounds;
        for (const int stop : {1, rounds / 4, rounds / 2, 3 * rounds / 4}) {
            WholeRun first(Precision::single_precision, starts), second(Precision::single_precision, starts);
            first.advance(stop);
            second.restore(first.save());
            second.told = first.told;
            second.finish();
            for (int r = 0; r < static_cast<int>(kinds.size()); ++r)
                expect_same(whole, r, second, r, 4, first.told[r].scans < 4);
        }
    }
}

}  // namespace
}  // namespace reference
