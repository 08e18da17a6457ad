// Work that several programs share through its result folder: the options, and how it is spread over the
// devices of this machine, MPI ranks, or a Slurm job array (host/ensemble/README.md).
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cl/device.h"

namespace mcdem {

struct SharingOptions {
    bool mpi = false, worker = false, slurm = false, no_wait = false;
    int slurm_tasks = 4;
    std::string slurm_partition, slurm_time;
    std::string slurm_lines;  ///< file of lines for the job script
};

/// Adds --device, which here may also be `all`, and the options above.
void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device);

/// Whether the command line asks for the work to be shared.
bool is_shared(const SharingOptions& options, const std::string& device);

/// A command's work, as those need it who spread it.
struct SharedWork {
    std::vector<std::string> words;  ///< the command line without the options above: "run", scene, ..
    std::filesystem::path out;       ///< the folder that all share
    /// Joins the work on a device until all of it is done, no matter by whom; calls `tick` often. `workers`:
    /// how many are known to come. Returns false where it was interrupted.
    std::function<bool(Device& device, std::size_t workers, const std::function<void()>& tick)> join;
    /// Throws InputError where the folder holds, or another program writes there, what cannot be joined.
    std::function<void()> check = [] {};
    std::function<bool()> done;        ///< all of it
    std::function<double()> fraction;  ///< of all of it
    std::function<int()> report;       ///< once it is done: tells the user, returns the exit code
};

/// Returns the exit code.
int share(const SharedWork& work, const SharingOptions& options, const std::string& device);

}  // namespace mcdem
