// Runs parts as a Slurm job array, with a dependent job that submits missing parts again.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace mcdem::inline cli {

struct SlurmJob {
    std::filesystem::path folder;    ///< for the script, the job numbers, and the output of the tasks
    std::vector<std::string> words;  ///< the command, without --part and the options below
    int tasks = 1;                   ///< number of tasks of the array that run at the same time
    std::string partition, time;     ///< empty: Slurm's defaults
    std::string lines_file;          ///< file with lines for the head of the script; empty: none
};

/// The script of both jobs: with the argument `part` a task of the array, otherwise the dependent job.
std::string job_script(const SlurmJob& job, const std::vector<std::size_t>& parts);

/// Whether this process is the dependent job of the last submitted array.
bool is_next_job(const SlurmJob& job);

/// Submits an array of these parts (at most the first thousand) and its dependent job, unless earlier ones
/// are still running or pending. Returns the job number of the array. Throws InputError if Slurm is missing
/// or refuses, or the file of lines cannot be read; RunError in the dependent job of an array that was
/// cancelled or finished no part.
std::string submit(const SlurmJob& job, const std::vector<std::size_t>& parts);

/// Waits until `is_done`, which is called often, or until Slurm has finished both jobs.
void wait_for_jobs(const SlurmJob& job, const std::function<bool()>& is_done);

}  // namespace mcdem::cli
