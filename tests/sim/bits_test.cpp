// Bit-identical results: of a replica alone and in any batch, of two fresh runs, and after a restart.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>

#include "core/errors.h"
#include "core/names.h"
#include "sim/whole_run.h"

namespace mcdem::reference {
namespace {

constexpr int with_species = 7;

/// Replicas of different sizes, models and time steps, all compressed by their plates.
Start squeezed_lattice(int kind) {
    Replica replica = test_replica(all_models[(kind + 4) % 6]);
    replica.contact.friction_law = kind % 2 ? FrictionLaw::saturated : FrictionLaw::mindlin;
    replica.numerics.time_step = kind % 3 ? 0.1 : 0.08;
    replica.protocol.scans_per_stroke = 2;
    const int counts[] = {27, 1, 65, 16, 7, 33, 64, 40};
    Start start = jittered_lattice(replica, counts[kind], 40 + kind);
    shorten(start);
    if (kind == with_species) {
        start.replica.species = {{"a", {23.3e3, 0.45, 1000, 300, 0.3, 0.7}},
                                 {"b", {8e4, 0.3, 2000, 900, 0.6, 0.9}}};
        for (int i = 0; i < counts[kind]; ++i) start.packing.species.push_back(i % 2);
    }
    Uniform uniform(kind);
    if (kind % 3 == 0) start.packing.velocity = uniform.vectors(start.packing.size(), 0.05);
    if (kind % 2 == 0) start.packing.angular_velocity = uniform.vectors(start.packing.size(), 5);
    return start;
}

std::vector<Start> starts(const std::vector<int>& kinds) {
    std::vector<Start> all;
    for (int kind : kinds) all.push_back(squeezed_lattice(kind));
    return all;
}

TEST(Bits, AReplicaIsTheSameAloneAndInAnyBatch) {
    for (Precision precision : {Precision::single_precision, finest()}) {
        WholeRun alone(precision, starts({0})), two(precision, starts({3, 0})),
            seven(precision, starts({1, 2, 3, 0, 4, 5, 6})), twice(precision, starts({0, 2, 0}));
        // If one replica has several species, different kernels are used.
        WholeRun of_species(precision, starts({7})), beside_species(precision, starts({0, 7, 2}));
        for (WholeRun* run : {&alone, &two, &seven, &twice, &of_species, &beside_species}) run->finish();
        if (fuses_alike()) expect_same(alone, 0, beside_species, 0);
        expect_same(of_species, 0, beside_species, 1);
        expect_same(alone, 0, two, 1);
        expect_same(alone, 0, seven, 3);
        expect_same(alone, 0, twice, 0);
        expect_same(alone, 0, twice, 2);
        expect_same(two, 0, seven, 2);
        EXPECT_FALSE(alone.told[0] == two.told[0]) << "others are different";
    }
}

// With several replicas per core a CPU makes all steps of one replica after another, otherwise one step of
// all in turn. Intervals have odd and even numbers of steps, some end early, and some replicas take no part.
TEST(Bits, AReplicaIsTheSameBesideEnoughReplicasForEachCore) {
    const KernelBuild kernels = build(Precision::single_precision);
    if (kernels.lanes == 1) GTEST_SKIP() << "a GPU makes each step for all replicas";
    // One of every kind has at least 1.6 times the grains of the largest active one, so this is enough.
    std::vector<int> kinds;
    for (std::size_t r = 0; r < 7 * mcdem::enough_replicas(device().info(), kernels); ++r)
        kinds.push_back(static_cast<int>(r % 7));
    Batch beside(kernels, starts(kinds));
    std::deque<Batch> alone;
    for (int kind = 0; kind < 7; ++kind) alone.emplace_back(kernels, squeezed_lattice(kind));
    int cut_short = 0;
    for (int round = 0; round < 8; ++round) {
        const auto interval = [&](int kind) {
            return mcdem::StepInterval{(kind + round) % 5 == 0 ? 0 : 7 + (kind + 2 * round) % 4,
                                       alone[kind].start().replica.plate.start};
        };
        std::vector<mcdem::StepInterval> intervals;
        for (const int kind : kinds) intervals.push_back(interval(kind));
        const auto made = beside.engine().advance(intervals);
        for (int kind = 0; kind < 7; ++kind) alone[kind].engine().advance({interval(kind)});
        for (std::size_t r = 0; r < kinds.size(); ++r) {
            EXPECT_TRUE(
                same_bits(alone[kinds[r]].engine().state(0), beside.engine().state(static_cast<int>(r))))
                << r << ", round " << round;
            cut_short += made[r].steps < intervals[r].steps;
        }
    }
    EXPECT_GT(cut_short, 0);
}

// Also while the device is already at work on the next interval.
TEST(Bits, StatesReadTogetherEqualStatesReadOneByOne) {
    Batch batch(build(Precision::single_precision), starts({0, 1, 2, 3, 4, 5, 6}));
    batch.advance(40);
    mcdem::Engine& engine = batch.engine();
    for (const std::vector<int>& replicas :
         {std::vector{0, 1, 2, 3, 4, 5, 6}, std::vector{1, 2, 5}, std::vector{6}, std::vector<int>{}}) {
        std::vector<mcdem::ReplicaState> alone;
        std::vector<mcdem::Scan> found(replicas.size());
        for (const int r : replicas) alone.push_back(engine.state(r));
        std::vector<mcdem::Readings> read;
        const std::size_t readings = engine.begin_reading(replicas, read);
        std::vector<mcdem::StepInterval> next;
        for (int r = 0; r < engine.replicas(); ++r) next.push_back({10, batch.start(r).replica.plate.start});
        engine.begin_interval(next);
        engine.for_each_state(std::span(read).first(readings),
                              [&](std::size_t i, int r, const mcdem::Readings& some) {
                                  EXPECT_EQ(r, replicas[i]);
                                  engine.take_state(r, some, found[i]);
                              });
        engine.finish_interval();
        for (std::size_t i = 0; i < replicas.size(); ++i) {
            const mcdem::ReplicaState together{found[i].position, alone[i].velocity,
                                               alone[i].angular_velocity, found[i].rotation,
                                               found[i].contacts};
            EXPECT_TRUE(same_bits(together, alone[i])) << replicas[i];
            EXPECT_EQ(found[i].contacts.size(), alone[i].contacts.size());
            EXPECT_FALSE(alone[i].contacts.empty());
            EXPECT_FALSE(same_bits(engine.state(replicas[i]), alone[i])) << "nothing moved";
        }
    }
}

// The number of slots may follow the widest sizes in a batch, so it must not affect the other replicas.
TEST(Bits, TheNumberOfSlotsChangesNothing) {
    const auto kinds = starts({0, 2, 5, with_species});
    WholeRun few(Precision::single_precision, kinds, 16), more(Precision::single_precision, kinds, 48);
    few.finish();
    more.finish();
    for (int r = 0; r < 4; ++r) expect_same(few, r, more, r);
}

TEST(Bits, ARestartChangesNothing) { expect_same_after_restarts(starts({0, with_species, 5})); }

TEST(Bits, ACheckpointOfAnotherSceneIsRefused) {
    WholeRun one(Precision::single_precision, starts({0, 1})),
        other(Precision::single_precision, starts({0, 2})),
        three(Precision::single_precision, starts({0, 1, 2}));
    EXPECT_THROW(other.restore(one.save()), mcdem::RunError);
    EXPECT_THROW(three.restore(one.save()), mcdem::RunError);
    auto damaged = one.save();
    damaged.erase("partner");
    EXPECT_THROW(one.restore(damaged), mcdem::RunError);
}

TEST(Bits, ACheckpointWithIndicesOutOfRangeIsRefused) {
    WholeRun run(Precision::single_precision, starts({0, 1}));
    const auto whole = run.save();
    for (const char* field : {"partner", "partner_slot", "steps_made", "protocol"})
        for (const std::int64_t number : {std::int64_t{-9} << 32 | 0xfffffff7, std::int64_t{1} << 30}) {
            const bool is_count = std::string(field) == "steps_made" || std::string(field) == "protocol";
            if (is_count && number > 0) continue;
            auto damaged = whole;
            std::memcpy(damaged.at(field).data(), &number, sizeof number);
            EXPECT_THROW(run.restore(damaged), mcdem::InputError) << field << " " << number;
        }
    EXPECT_NO_THROW(run.restore(whole));
}

}  // namespace
}  // namespace mcdem::reference
