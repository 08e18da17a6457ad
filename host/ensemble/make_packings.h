// Initial packings of all replicas of a scene, and runs in memory.
#pragma once
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

/// Runs a scene without files: one recording per replica. Ends early when every replica has failed or has
/// `scans_needed` scans. `on_progress` receives the completed fraction of the whole protocol.
std::vector<Recording> simulate(
    Device& device, const Scene& scene, const std::vector<Packing>& packings, std::size_t scans_needed,
    const std::function<void(double fraction)>& on_progress = [](double) {});

}  // namespace mcdem::ensemble
