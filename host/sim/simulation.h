// A complete batch, from the initial packings to the last scan. It does not know about files: scans are
// passed to the caller, and the state between two rounds can be saved and restored as bytes.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/compliant_plate.h"
#include "sim/energy_budget.h"
#include "sim/engine.h"
#include "sim/protocol.h"

namespace mcdem::inline sim {

class Simulation {
public:
    /// `packings[r]` is the initial packing of `scene.replicas[r]`.
    Simulation(Device& device, const Scene& scene, std::vector<Packing> packings);

    /// May move from the scan.
    using ScanSink = std::function<void(int replica, Scan& scan)>;
    using FailureSink = std::function<void(int replica, const Failure& failure)>;

    /// Runs one interval of every unfinished replica. While the device works on it, the scans and failures of
    /// the interval before are passed on. Returns false if no replica was left.
    bool advance(const ScanSink& on_scan, const FailureSink& on_failure);

    /// Passes on the scans and failures of the last interval. Call it before save().
    void pass_on(const ScanSink& on_scan, const FailureSink& on_failure);

    /// Ends a replica. `on_scan` may call it; a further interval that the replica has begun does not count.
    void end(int replica) { runners_[static_cast<std::size_t>(replica)].stop(); }

    double progress() const;                           ///< mean over the replicas, 0 to 1
    long grain_steps() const { return grain_steps_; }  ///< made by this object
    const Engine& engine() const { return engine_; }

    /// Throws std::logic_error if scans or failures have not been passed on.
    std::map<std::string, std::vector<std::byte>> save();
    void restore(const std::map<std::string, std::vector<std::byte>>& saved);

private:
    /// What an interval of a replica yielded. A replica with a failure is stopped.
    struct Outcome {
        int replica;
        IntervalResult result;
        EnergyTerms energy;
        std::optional<ProtocolRunner::ScanTag> scan;
        std::optional<Failure> failure;
    };
    std::vector<StepInterval> next_intervals();
    /// Adds to `outcomes_` if there is something to pass on. Returns whether a scan is due.
    bool take_note(int replica, const IntervalResult& result);
    /// Computes the scans among `outcomes_`, in their order.
    void fill_scans();
    void fill_scan(const Outcome& outcome, const Readings& read, Scan& scan) const;
    Failure failure(int replica, const IntervalResult& result, bool relaxes) const;

    Scene scene_;
    std::vector<std::vector<double>> diameter_;  ///< as stated in the scene [m]
    std::vector<PackingScale> scale_;
    Engine engine_;
    std::vector<ProtocolRunner> runners_;
    std::vector<CompliantPlate> plates_;
    std::vector<EnergyBudget> budgets_;
    std::vector<Outcome> outcomes_;   ///< not passed on yet
    std::vector<Readings> readings_;  ///< the states for the scans among them, the first of these
    std::size_t reading_count_ = 0;
    std::vector<Scan> scans_;  ///< these scans, in memory that is used again
    long grain_steps_ = 0;
};

/// The recording of replica `r`, still without scans.
Recording begin_recording(const Replica& replica, const Packing& packing);

}  // namespace mcdem::sim
