// Initial packings of all replicas of a scene, and runs in memory.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "cl/device.h"
#include "core/recording.h"
#include "core/stop.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One packing per replica, in order, computed on all cores; replicas with the same initial packing share the
/// work. Throws InputError with all problems, Interrupted.
std::vector<Packing> make_packings(const Scene& scene, const StopWanted& stop_wanted = never_stop);

/// When a simulation without files ends before its protocol does, and whom it tells.
struct SimulateOptions {
    /// Ends when every replica has failed or has this many scans.
    std::size_t scans_needed = SIZE_MAX;
    /// By replica, or empty: a replica ends where on its last way back the displacement of the plate is less
    /// [m].
    std::vector<double> end_below = {};
    /// Receives the completed fraction of the whole protocol; may throw.
    std::function<void(double fraction)> on_progress = [](double) {};
};

/// Runs a scene without files: one recording per replica.
std::vector<Recording> simulate(Device& device, const Scene& scene, const std::vector<Packing>& packings,
                                const SimulateOptions& options);

}  // namespace mcdem::ensemble
