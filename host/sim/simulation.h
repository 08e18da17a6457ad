// A complete batch, from the initial packings to the last scan. It does not know about files: scans are
// passed to the caller, and the state between two rounds can be saved and restored as bytes.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/compliant_plate.h"
#include "sim/engine.h"
#include "sim/protocol.h"

namespace mcdem::inline sim {

class Simulation {
public:
    /// `packings[r]` is the initial packing of `scene.replicas[r]`.
    Simulation(Device& device, const Scene& scene, std::vector<Packing> packings);

    using ScanSink = std::function<void(int replica, Scan scan)>;
    using FailureSink = std::function<void(int replica, const Failure& failure)>;

    /// Runs one interval of every unfinished replica. Returns false if none is left.
    bool advance(const ScanSink& on_scan, const FailureSink& on_failure);

    /// Ends a replica. `on_scan` may call it.
    void end(int replica) { runners_[static_cast<std::size_t>(replica)].stop(); }

    double progress() const;                           ///< mean over the replicas, 0 to 1
    long grain_steps() const { return grain_steps_; }  ///< made by this object
    const Engine& engine() const { return engine_; }

    std::map<std::string, std::vector<std::byte>> save();
    void restore(const std::map<std::string, std::vector<std::byte>>& saved);

private:
    /// Takes the scans that are due, by replica.
    std::map<int, Scan> scans(const std::map<int, ProtocolRunner::ScanTag>& due,
                              const std::vector<IntervalResult>& results) const;
    Scan scan(int replica, const ProtocolRunner::ScanTag& tag, const IntervalResult& result,
              ReplicaState state) const;
    Failure failure(int replica, const IntervalResult& result) const;

    Scene scene_;
    std::vector<std::vector<double>> diameter_;  ///< as stated in the scene [m]
    std::vector<PackingScale> scale_;
    Engine engine_;
    std::vector<ProtocolRunner> runners_;
    std::vector<CompliantPlate> plates_;
    long grain_steps_ = 0;
};

/// The recording of replica `r`, still without scans.
Recording begin_recording(const Replica& replica, const Packing& packing);

}  // namespace mcdem::sim
