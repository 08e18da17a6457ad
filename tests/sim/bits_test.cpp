// The same bits: a replica alone, in batches and anywhere in them; again in a fresh run; and after a restart.
#include <cmath>

#include "core/errors.h"
#include "core/names.h"
#include "reference/test_scene.h"
#include "sim/simulation.h"

namespace reference {
namespace {

/// Replicas of different sizes, models and time steps, all compressed by their plates.
Start squeezed_lattice(int kind) {
    Replica replica = test_replica(all_models[(kind + 4) % 6]);
    replica.contact.friction_law = kind % 2 ? FrictionLaw::saturated : FrictionLaw::mindlin;
    replica.numerics.time_step = kind % 3 ? 0.1 : 0.08;
    replica.plate.speed = 0.2;
    auto& protocol = replica.protocol;
    protocol.scans_per_stroke = 2;
    protocol.relax_time = protocol.settle_time = 0.03;
    const int counts[] = {27, 1, 65, 16, 7, 33, 64};
    return jittered_lattice(replica, counts[kind], 40 + kind);
}

/// Everything that a simulation tells of one replica.
struct Told {
    std::vector<double> numbers;
    int scans = 0;
    void add(const mcdem::Scan& scan) {
        ++scans;
        for (const auto& x : scan.position) add(x);
        for (const auto& f : scan.wall_force) add(f);
        for (const auto& c : scan.contacts) {
            add(c.force);
            add(c.point);
            numbers.push_back(c.overlap);
        }
        for (double value :
             {scan.time, scan.plate_z, scan.kinetic_energy, scan.elastic_energy, scan.mean_force})
            numbers.push_back(value);
    }
    void add(const Vec3& v) { numbers.insert(numbers.end(), {v.x(), v.y(), v.z()}); }
    bool operator==(const Told& other) const {
        return numbers.size() == other.numbers.size() &&
               std::memcmp(numbers.data(), other.numbers.data(), numbers.size() * sizeof(double)) == 0;
    }
};

class WholeRun {
public:
    WholeRun(Precision precision, const std::vector<int>& kinds)
        : told(kinds.size()), simulation_(device(), scene(precision, kinds), packings(kinds)) {}

    bool advance() {
        return simulation_.advance([this](int r, const mcdem::Scan& scan) { told[r].add(scan); },
                                   [](int r, const mcdem::Failure& failure) {
                                       ADD_FAILURE() << "replica " << r << ": " << failure.cause;
                                   });
    }
    void advance(int rounds) {
        for (int round = 0; round < rounds && advance(); ++round) {
        }
    }
    void finish() {
        while (advance()) {
        }
    }
    mcdem::ReplicaState state(int r) { return simulation_.engine().state(r); }
    auto save() { return simulation_.save(); }
    void restore(const std::map<std::string, std::vector<std::byte>>& saved) { simulation_.restore(saved); }

    std::vector<Told> told;

private:
    static mcdem::Scene scene(Precision precision, const std::vector<int>& kinds) {
        mcdem::Scene scene;
        scene.precision = precision;
        for (int kind : kinds) scene.replicas.push_back(squeezed_lattice(kind).replica);
        return scene;
    }
    static std::vector<Packing> packings(const std::vector<int>& kinds) {
        std::vector<Packing> all;
        for (int kind : kinds) all.push_back(squeezed_lattice(kind).packing);
        return all;
    }
    mcdem::Simulation simulation_;
};

void expect_same(WholeRun& one, int r, WholeRun& other, int s) {
    EXPECT_TRUE(one.told[r] == other.told[s]);
    EXPECT_TRUE(same_bits(one.state(r), other.state(s)));
    EXPECT_EQ(one.told[r].scans, 4);
    EXPECT_GT(one.told[r].numbers.size(), 50u);
}

TEST(Bits, AReplicaIsTheSameAloneAndInAnyBatch) {
    for (Precision precision : {Precision::single_precision, finest()}) {
        WholeRun alone(precision, {0}), two(precision, {3, 0}), seven(precision, {1, 2, 3, 0, 4, 5, 6}),
            twice(precision, {0, 2, 0});
        for (WholeRun* run : {&alone, &two, &seven, &twice}) run->finish();
        expect_same(alone, 0, two, 1);
        expect_same(alone, 0, seven, 3);
        expect_same(alone, 0, twice, 0);
        expect_same(alone, 0, twice, 2);
        expect_same(two, 0, seven, 2);
        EXPECT_FALSE(alone.told[0] == two.told[0]) << "others are different";
    }
}

TEST(Bits, TwoFreshRunsAreTheSame) {
    WholeRun one(Precision::single_precision, {0, 1, 2, 3}), other(Precision::single_precision, {0, 1, 2, 3});
    one.finish();
    other.finish();
    for (int r = 0; r < 4; ++r) expect_same(one, r, other, r);
}

// Taken out at several moments, put into a fresh simulation, run to the end.
TEST(Bits, ARestartChangesNothing) {
    const std::vector<int> kinds{0, 2, 5};
    WholeRun whole(Precision::single_precision, kinds);
    whole.finish();
    for (int rounds : {0, 1, 2, 7, 25}) {
        WholeRun first(Precision::single_precision, kinds), second(Precision::single_precision, kinds);
        first.advance(rounds);
        const auto saved = first.save();
        second.restore(saved);
        second.told = first.told;
        EXPECT_TRUE(second.save() == first.save()) << "after " << rounds << " rounds";
        second.finish();
        for (int r = 0; r < 3; ++r) expect_same(whole, r, second, r);
    }
}

TEST(Bits, ACheckpointOfAnotherSceneIsRefused) {
    WholeRun one(Precision::single_precision, {0, 1}), other(Precision::single_precision, {0, 2}),
        three(Precision::single_precision, {0, 1, 2});
    EXPECT_THROW(other.restore(one.save()), mcdem::RunError);
    EXPECT_THROW(three.restore(one.save()), mcdem::RunError);
    auto damaged = one.save();
    damaged.erase("partner");
    EXPECT_THROW(one.restore(damaged), mcdem::RunError);
}

}  // namespace
}  // namespace reference
