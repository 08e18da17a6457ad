// Parts of a work as a Slurm job array, and the job after it, which submits what is missing again.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace mcdem::inline cli {

struct SlurmJob {
    std::filesystem::path folder;    ///< for the script, the numbers of the jobs, and what their tasks say
    std::vector<std::string> words;  ///< the command, without --part and the options below
    int tasks = 1;                   ///< of the array that run at a time
    std::string partition, time;     ///< empty: Slurm's own
    std::string lines_file;          ///< of lines that come first in the script; empty: none
};

/// The script of both jobs: with the argument `part` a task of the array, else the job after it.
std::string job_script(const SlurmJob& job, const std::vector<std::size_t>& parts);

/// Whether this process is the job after the array that was submitted last.
bool is_next_job(const SlurmJob& job);

/// Submits an array of these parts (of the first thousand, where there are more) and the job after it, unless
/// those submitted before still run or wait; the number of either's array. Throws InputError where Slurm is
/// not there or refuses, or the file of lines cannot be read; RunError in the job after an array that was
/// cancelled or finished no part.
std::string submit(const SlurmJob& job, const std::vector<std::size_t>& parts);

/// Waits until `is_done`, asked often, or until Slurm has neither of the jobs any more.
void wait_for_jobs(const SlurmJob& job, const std::function<bool()>& is_done);

}  // namespace mcdem::cli
