// Whether the answers of a scene are converged: what its plate speed, inertia, time step, settling, precision
// and neighbour lists do to every observable.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "cl/device.h"
#include "diagnose/infer/convergence.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

struct ConvergeOptions {
    std::filesystem::path folder;  ///< every simulation is kept below it and not made twice
    int replicas = 32;
    double jitter =
        0;  ///< sd of a random displacement that sets replicas apart [m]; 0: half a per cent of a diameter
    std::uint64_t seed = 1;
    ConvergenceLimits limits;
    std::string program;  ///< version and commit
    std::function<void(const std::string& cause, double fraction)> on_progress = [](const std::string&,
                                                                                    double) {};
    std::function<bool()> stop_wanted = [] { return false; };
};

/// Of the scene's first replica: jittered copies of its packing or, where those hardly differ, packings drawn
/// anew. Throws InputError where its runs stop, Interrupted when stop_wanted says so.
Convergence converge_scene(Device& device, const Scene& scene, const ConvergeOptions& options);

}  // namespace mcdem::ensemble
