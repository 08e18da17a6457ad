// Convergence of a scene: influence of plate speed, inertia, time step, settling, precision and neighbour
// lists on every observable.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "cl/device.h"
#include "core/stop.h"
#include "diagnose/convergence.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

struct ConvergeOptions {
    std::filesystem::path folder;  ///< stores every simulation, so that none is repeated
    int replicas = 32;
    double jitter =
        0;  ///< standard deviation of the jitter between replicas [m]; 0: half a per cent of a diameter
    std::uint64_t seed = 1;
    ConvergenceLimits limits;
    std::string program;  ///< version and commit
    std::function<void(const std::string& cause, double fraction)> on_progress = [](const std::string&,
                                                                                    double) {};
    StopWanted stop_wanted = never_stop;
};

/// For the scene's first replica. Uses jittered copies of its packing or, if those hardly differ, new
/// packings. Throws InputError if its runs stop, Interrupted if stop_wanted returns true.
Convergence converge_scene(Device& device, const Scene& scene, const ConvergeOptions& options);

}  // namespace mcdem::ensemble
