// A scene taken through the simulation in memory, without files: for what needs many short runs.
#pragma once
#include <functional>
#include <vector>

#include "cl/device.h"
#include "core/recording.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One recording a replica. Ends before its time once every replica has failed or has `scans_needed`
/// scans. `on_progress` gets the part of the whole protocol that is done.
std::vector<Recording> simulate(
    Device& device, const Scene& scene, const std::vector<Packing>& packings, std::size_t scans_needed,
    const std::function<void(double fraction)>& on_progress = [](double) {});

}  // namespace mcdem::ensemble
