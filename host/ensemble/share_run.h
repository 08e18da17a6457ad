// A run shared by several programs, on one machine or many, that have nothing in common but the result folder
// (README.md beside this file).
#pragma once
#include "ensemble/run_scene.h"

namespace mcdem {

struct ShareOptions {
    std::filesystem::path folder;
    std::size_t part_replicas =
        0;                    ///< replicas of a part; 0: enough to fill a device, few enough for all workers
    std::size_t workers = 1;  ///< that are known to come; others may join
    std::string program;      ///< version and commit, for the results
    /// Called often, also while waiting for others.
    std::function<void()> on_tick = [] {};
    /// As of RunOptions.
    std::function<void(const Replica& replica, const Failure& failure)> on_failure = [](const Replica&,
                                                                                        const Failure&) {};
    std::function<void(const std::string& message)> on_warning = [](const std::string&) {};
    std::function<bool()> stop_wanted = [] { return false; };
};

/// Joins the run in the folder, or begins it: computes parts that nobody computes, until all are done, and
/// merges them where nobody does. The folder then holds what run_scene leaves in it, bit for bit. Throws
/// InputError where another run lies there or is written there by one program, or where this device, program
/// or scene is not the one it was begun with; RunError.
RunEnd share_run(Device& device, const Scene& scene, const ShareOptions& options);

/// For those who only start others: throws InputError where share_run would because of what lies in the
/// folder or is written there.
void expect_sharable(const std::filesystem::path& folder, const Scene& scene);

/// Whether a run is shared in this folder and not yet merged.
bool is_shared_run(const std::filesystem::path& folder);

struct SharedState {
    bool done = false;  ///< merged
    std::size_t parts = 0, parts_done = 0;
    double fraction = 0;  ///< of all the work
};
SharedState shared_state(const std::filesystem::path& folder);

}  // namespace mcdem
