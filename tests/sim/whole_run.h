// Runs a simulation from the packing to the last scan and records all of its output, for bitwise comparison.
#pragma once
#include "reference/test_scene.h"
#include "sim/simulation.h"

namespace mcdem::reference {

/// Of every contact [N].
inline std::vector<Vec3> forces_of(const mcdem::ReplicaState& state) {
    std::vector<Vec3> forces;
    for (const auto& contact : state.contacts) forces.push_back(contact.force);
    return forces;
}

/// A short run: bits differ after few steps if they ever do.
inline void shorten(Start& start) {
    auto& plate = start.replica.plate;
    auto& protocol = start.replica.protocol;
    plate.speed = 1;
    plate.end = start.replica.box.shape == mcdem::ContainerShape::cell ? 0 : 0.95 * plate.start;
    protocol.rate_tolerance = 0.05;
    protocol.relax_time = protocol.settle_time = 0.003;
}

/// All output of one replica.
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
    WholeRun(Precision precision, const std::vector<Start>& starts, int slots = 16)
        : told(starts.size()), simulation_(device(), scene(precision, starts, slots), packings(starts)) {}

    bool advance() { return simulation_.advance(tell_, fail_); }
    void advance(int rounds) {
        for (int round = 0; round < rounds && advance(); ++round) {
        }
    }
    void finish() {
        while (advance()) {
        }
    }
    mcdem::ReplicaState state(int r) { return simulation_.engine().state(r); }
    auto save() {
        simulation_.pass_on(tell_, fail_);
        return simulation_.save();
    }
    void restore(const std::map<std::string, std::vector<std::byte>>& saved) { simulation_.restore(saved); }

    std::vector<Told> told;

private:
    const mcdem::Simulation::ScanSink tell_ = [this](int r, const mcdem::Scan& scan) { told[r].add(scan); };
    const mcdem::Simulation::FailureSink fail_ = [](int r, const mcdem::Failure& failure) {
        ADD_FAILURE() << "replica " << r << ": " << failure.cause;
    };
    static mcdem::Scene scene(Precision precision, const std::vector<Start>& starts, int slots) {
        mcdem::Scene scene;
        scene.slots = slots;
        scene.precision = precision;
        for (const Start& start : starts) scene.replicas.push_back(start.replica);
        return scene;
    }
    static std::vector<Packing> packings(const std::vector<Start>& starts) {
        std::vector<Packing> all;
        for (const Start& start : starts) all.push_back(start.packing);
        return all;
    }
    mcdem::Simulation simulation_;
};

/// Compares the output and the last state bit for bit. Without `has_contacts` it leaves out the contacts of
/// the state: a replica that had finished before a restart makes no further step, in which they would be
/// computed.
inline void expect_same(WholeRun& one, int r, WholeRun& other, int s, int scans = 4,
                        bool has_contacts = true) {
    EXPECT_TRUE(one.told[r] == other.told[s]);
    auto state = one.state(r), after = other.state(s);
    if (!has_contacts) {
        state.contacts.clear();
        after.contacts.clear();
    }
    EXPECT_TRUE(same_bits(state, after));
    EXPECT_EQ(one.told[r].scans, scans);
    EXPECT_GT(one.told[r].numbers.size(), 50u);
}

/// Replica r of the batch gives the same bits alone.
inline void expect_same_alone(Precision precision, const std::vector<Start>& starts, int scans = 4) {
    WholeRun batch(precision, starts);
    batch.finish();
    for (std::size_t r = 0; r < starts.size(); ++r) {
        SCOPED_TRACE(r);
        WholeRun alone(precision, {starts[r]});
        alone.finish();
        expect_same(alone, 0, batch, static_cast<int>(r), scans);
    }
}

/// Saves at several moments, restores into a new simulation, runs to the end.
inline void expect_same_after_restarts(const std::vector<Start>& starts, int scans = 4) {
    WholeRun whole(Precision::single_precision, starts);
    int rounds = 0;
    while (whole.advance()) ++rounds;
    for (const int stop : {0, 1, rounds / 7, rounds / 2, 3 * rounds / 4}) {
        SCOPED_TRACE(stop);
        WholeRun first(Precision::single_precision, starts), second(Precision::single_precision, starts);
        first.advance(stop);
        const auto saved = first.save();
        second.restore(saved);
        second.told = first.told;
        EXPECT_TRUE(second.save() == saved);
        second.finish();
        for (int r = 0; r < static_cast<int>(starts.size()); ++r)
            expect_same(whole, r, second, r, scans, first.told[r].scans < scans);
    }
}

}  // namespace mcdem::reference
