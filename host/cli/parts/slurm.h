// Runs parts as a Slurm job array, with a dependent job that submits missing parts again.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/parts/sharing.h"

namespace mcdem::inline cli {

struct SlurmJob {
    std::filesystem::path folder;    ///< for the script and the output of the tasks
    std::vector<std::string> words;  ///< the command of a task, without --part
    std::vector<std::string> next;   ///< the command of the dependent job
    const SharingOptions& options;
};

/// The script of both jobs: `job.sh part` is a task of the array, `job.sh next ARRAY` the dependent job of
/// this array.
std::string job_script(const SlurmJob& job, const std::vector<std::size_t>& parts);

/// Whether this process is a dependent job.
bool is_next_job();

/// Submits an array of these parts (at most the first thousand) and its dependent job, unless jobs of the
/// same folder are running or pending. Returns a job number. Throws InputError if Slurm is missing or
/// refuses, or the file of lines cannot be read; RunError in the dependent job of an array that was cancelled
/// or finished no part.
std::string submit(const SlurmJob& job, const std::vector<std::size_t>& parts);

/// Waits until `is_done`, which is called often, or until Slurm has finished all jobs of the folder.
void wait_for_jobs(const SlurmJob& job, const std::function<bool()>& is_done);

}  // namespace mcdem::cli
