// A programme with all kinds of stages: bit-identical alone, in a batch, and after a restart at any point.
#include "sim/whole_run.h"

namespace reference::programme_bits {
namespace {

mcdem::Stage force_of(double force, double speed) {
    mcdem::Stage stage;
    stage.force = force;
    stage.speed = speed;
    return stage;
}

Start programmed_lattice(int kind) {
    Replica replica = test_replica(all_models[(kind + 4) % 6]);
    replica.contact.friction_law = FrictionLaw::mindlin;
    replica.effects.viscoelasticity = kind == 1 ? 0.3 : 0;
    auto& protocol = replica.protocol;
    protocol.relax_time = protocol.settle_time = 0.03;
    const int counts[] = {27, 8, 18};
    const double forces[] = {1.5, 1, 1.2};
    Start start = jittered_lattice(replica, counts[kind], 40 + kind);
    auto& programme = start.replica.programme;
    programme.resize(4);
    programme[0] = force_of(forces[kind], 0.2);
    programme[1].kind = mcdem::StageKind::hold;
    programme[1].keep = mcdem::Controlled::force;
    programme[1].time = 0.02;
    programme[2].kind = mcdem::StageKind::cycle;
    programme[2].position = 0.95 * start.replica.plate.start;
    programme[2].back = 0.97 * start.replica.plate.start;
    programme[2].scans = 0;
    programme[3].kind = mcdem::StageKind::repeat;
    start.replica.plate.end = 0.7 * start.replica.plate.start;
    return start;
}

std::vector<Start> starts(const std::vector<int>& kinds) {
    std::vector<Start> all;
    for (const int kind : kinds) all.push_back(programmed_lattice(kind));
    return all;
}

TEST(ProgrammeBits, AreTheSameAloneAndInABatch) {
    WholeRun alone(Precision::single_precision, starts({0})),
        three(Precision::single_precision, starts({1, 2, 0}));
    alone.finish();
    three.finish();
    expect_same(alone, 0, three, 2, 2);
}

TEST(ProgrammeBits, ARestartChangesNothing) {
    const auto kinds = starts({0, 1});
    WholeRun whole(Precision::single_precision, kinds);
    int rounds = 0;
    while (whole.advance()) ++rounds;
    for (const int stop : {1, rounds / 7, rounds / 4, rounds / 2, 3 * rounds / 4}) {
        WholeRun first(Precision::single_precision, kinds), second(Precision::single_precision, kinds);
        first.advance(stop);
        second.restore(first.save());
        second.told = first.told;
        second.finish();
        for (int r = 0; r < 2; ++r) expect_same(whole, r, second, r, 2, first.told[r].scans < 2);
    }
}

}  // namespace
}  // namespace reference::programme_bits
