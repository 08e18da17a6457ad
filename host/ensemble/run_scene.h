// Runs a scene into a result folder. After an interruption only the time since the last checkpoint is lost,
// and the result is the same as that of an uninterrupted run.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "cl/device.h"
#include "core/recording.h"
#include "core/stop.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

enum class Start { fresh, resume };

struct RunOptions {
    std::filesystem::path folder;
    Start start = Start::fresh;
    std::string program;  ///< version and commit, recorded in the results
    /// Called after every round with the completed fraction of the run.
    std::function<void(double fraction)> on_progress = [](double) {};
    /// Called when a replica stops; the others continue.
    std::function<void(const Replica& replica, const Failure& failure)> on_failure = [](const Replica&,
                                                                                        const Failure&) {};
    /// Receives warnings that do not stop the run.
    std::function<void(const std::string& message)> on_warning = [](const std::string&) {};
    /// Called after every round, and from several threads while packings are made. True ends the run cleanly,
    /// so that it can be resumed.
    StopWanted stop_wanted = never_stop;
};

enum class RunEnd {
    done,         ///< run.h5 is complete
    was_done,     ///< run.h5 was complete before
    interrupted,  ///< by stop_wanted; the run can be resumed
};

struct RunSummary {
    RunEnd end = RunEnd::done;
    long grain_steps = 0;  ///< in this call, without those before a resume
    double seconds = 0;    ///< for these steps, without compilation of kernels and generation of packings
};

/// Throws InputError for an unsuitable folder, checkpoint or packing, RunError for other failures. Replicas
/// that fail are recorded and do not end the run.
RunSummary run_scene(Device& device, const Scene& scene, const RunOptions& options);

}  // namespace mcdem::ensemble
