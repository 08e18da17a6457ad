// Command-line options for work in parts (ensemble/parts/parted_work.h). Parts are computed by this process,
// the devices of this machine, MPI ranks, or a Slurm job array (host/ensemble/README.md).
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
    const CLI::App* command = nullptr;  ///< to which they were added
    std::optional<std::size_t> part, workers;
    bool missing = false, merge = false, mpi = false, slurm = false, no_wait = false;
    int slurm_tasks = 4;
    std::string slurm_partition, slurm_time;
    std::string slurm_lines;  ///< file with lines for the job script
};

/// Adds --device, which may be `all` here, --part, --missing, --merge and --workers.
void add_part_options(CLI::App& command, SharingOptions& options, std::string& device);

/// The same, plus the options of MPI and Slurm.
void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device);

/// The words of the command line ("run", scene, ..) without `--resume`, and, unless `all`, without options
/// that determine where and how it runs.
std::vector<std::string> words_of(const SharingOptions& options, bool all = false);

/// Whether the command line requests work in parts.
bool is_shared(const SharingOptions& options, const std::string& device);

struct SharedWork {
    std::filesystem::path out;  ///< the shared folder
    /// Starts or continues the work; `workers`: number of expected workers. Throws InputError if the content
    /// of the folder, or another program that uses it, is incompatible.
    std::function<std::unique_ptr<PartedWork>(std::size_t workers)> begin;
    /// Called after the merge, when the lock on the parts is released: reports to the user, returns the exit
    /// code.
    std::function<int()> report;
};

/// Returns the exit code.
int share(const SharedWork& work, const SharingOptions& options, const std::string& device);

}  // namespace mcdem::cli
