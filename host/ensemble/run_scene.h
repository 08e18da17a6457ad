// Takes a scene through the simulation into a result folder, so that nothing but the time since the last
// checkpoint is lost, whatever happens, and the result does not show that anything did.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "cl/device.h"
#include "core/recording.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

enum class Start { fresh, resume };

struct RunOptions {
    std::filesystem::path folder;
    Start start = Start::fresh;
    std::string program;  ///< version and commit, for the results
    /// Called after every round; `fraction` of the whole run is done.
    std::function<void(double fraction)> on_progress = [](double) {};
    /// A replica stopped; the others go on.
    std::function<void(const Replica& replica, const Failure& failure)> on_failure = [](const Replica&,
                                                                                        const Failure&) {};
    /// Something that the user should know and that does not stop the run.
    std::function<void(const std::string& message)> on_warning = [](const std::string&) {};
    /// Asked after every round, and by several threads while packings are made: true ends the run in good
    /// order, to be resumed.
    std::function<bool()> stop_wanted = [] { return false; };
};

enum class RunEnd {
    done,         ///< run.h5 is there
    was_done,     ///< .. and was so before
    interrupted,  ///< stop_wanted; a later resume goes on
};

struct RunSummary {
    RunEnd end = RunEnd::done;
    long grain_steps = 0;  ///< made now; a resumed run's earlier ones do not count
    double seconds = 0;    ///< spent on them, without kernels and packings being made ready
};

/// Throws InputError for a folder, checkpoint or packing that does not suit, RunError where the work
/// cannot be done. Replicas that fail are recorded and end nothing.
RunSummary run_scene(Device& device, const Scene& scene, const RunOptions& options);

}  // namespace mcdem::ensemble
