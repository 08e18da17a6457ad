// Runs a scene in memory, without files, for many short runs.
#pragma once
#include <functional>
#include <vector>

#include "cl/device.h"
#include "core/recording.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One recording per replica. Ends early when every replica has failed or has `scans_needed` scans.
/// `on_progress` receives the completed fraction of the whole protocol.
std::vector<Recording> simulate(
    Device& device, const Scene& scene, const std::vector<Packing>& packings, std::size_t scans_needed,
    const std::function<void(double fraction)>& on_progress = [](double) {});

}  // namespace mcdem::ensemble
