// Workers as a Slurm job array.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace mcdem {

struct SlurmJob {
    std::filesystem::path folder;    ///< for the script, the number of the job, and what its tasks say
    std::vector<std::string> words;  ///< what a task runs
    int tasks = 1;
    std::string partition, time;  ///< empty: Slurm's own
    std::string lines_file;       ///< of lines that come first in the script; empty: none
};

/// The job script.
std::string job_script(const SlurmJob& job);

/// Submits the job, unless the one submitted from this folder before still runs or waits; the number of
/// either. Throws InputError where Slurm is not there or refuses, or the file of lines cannot be read.
std::string submit(const SlurmJob& job);

/// Waits until `done`, or until Slurm has no such job any more: true. False once `go_on`, asked often, says
/// so.
bool wait_for_job(const std::string& number, const std::function<bool()>& done,
                  const std::function<bool()>& go_on);

}  // namespace mcdem
