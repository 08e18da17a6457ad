// Work in parts (ensemble/parts/parted_work.h): the options, and who computes the parts: this process, the
// devices of this machine, MPI ranks, or a Slurm job array (host/ensemble/README.md).
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/parts/parted_work.h"

namespace mcdem::inline cli {

struct SharingOptions {
    std::optional<std::size_t> part;
    bool missing = false, merge = false, mpi = false, slurm = false, no_wait = false;
    std::size_t workers = 0;  ///< 0: not said
    int slurm_tasks = 4;
    std::string slurm_partition, slurm_time;
    std::string slurm_lines;  ///< file of lines for the job script
};

/// Adds --device, which here may also be `all`, --part, --missing, --merge and --workers.
void add_part_options(CLI::App& command, SharingOptions& options, std::string& device);

/// The same, and the options of MPI and Slurm.
void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device);

/// Whether the command line asks for work in parts.
bool is_shared(const SharingOptions& options, const std::string& device);

/// A command's work.
struct SharedWork {
    std::vector<std::string> words;  ///< the command line without the options above: "run", scene, ..
    std::filesystem::path out;       ///< the folder that all share
    /// Begins the work or takes it up; `workers`: how many are known to come. Throws InputError where what
    /// lies in the folder, or another program that writes there, does not go with it.
    std::function<std::unique_ptr<PartedWork>(std::size_t workers)> begin;
    /// Once it is merged, and the parts' lock is free: tells the user, returns the exit code.
    std::function<int()> report;
};

/// Returns the exit code.
int share(const SharedWork& work, const SharingOptions& options, const std::string& device);

}  // namespace mcdem::cli
