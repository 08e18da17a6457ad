#include "cli/parts/slurm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "cli/shell/messages.h"
#include "cli/shell/subprocess.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/replaced.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto look = std::chrono::milliseconds(200);  ///< interval between checks of the folder
constexpr auto ask = std::chrono::seconds(5);          ///< interval between queries of Slurm
constexpr auto settle = std::chrono::seconds(10);      ///< time until files of a finished job become visible

/// Maximum size of an array: Slurm's default of MaxArraySize.
constexpr std::size_t max_tasks = 1000;

fs::path jobs_file(const SlurmJob& job) { return job.folder / "jobs"; }

/// The last submitted jobs.
struct Jobs {
    std::string array, next;  ///< job numbers; empty: not submitted
    std::string parts;
};

/// Escapes % in the pattern of a log's name.
std::string log_pattern(const SlurmJob& job, const std::string& name) {
    return replaced(fs::absolute(job.folder).string(), {{'%', "%%"}}) + "/" + name;
}

ProgramEnd slurm(const std::vector<std::string>& words) {
    auto end = output_of(words);
    if (!end)
        throw InputError(
            fmt::format("--slurm: the program {} is not there: give the command on a machine of the cluster, "
                        "or install the "
                        "package slurm-client",
                        words.front()));
    return *end;
}

bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

Jobs submitted_last(const SlurmJob& job) {
    Jobs jobs;
    std::ifstream in(jobs_file(job));
    if (!std::getline(in, jobs.array) || !std::getline(in, jobs.next) || !std::getline(in, jobs.parts) ||
        !is_number(jobs.array) || !is_number(jobs.next))
        return {};
    return jobs;
}

/// Whether any task of the jobs is pending or running. True if Slurm does not answer.
bool are_in_queue(const Jobs& jobs) {
    const auto end = slurm({"squeue", "--me", "--noheader", "--array", "--format=%F"});
    if (end.exit_code != 0) return true;
    const std::string all = "\n" + end.out;
    return all.find("\n" + jobs.array + "\n") != all.npos || all.find("\n" + jobs.next + "\n") != all.npos;
}

bool was_cancelled(const Jobs& jobs) {
    const auto end =
        slurm({"squeue", "--jobs=" + jobs.array, "--noheader", "--states=CANCELLED", "--format=%F"});
    return end.exit_code == 0 && !end.out.empty();
}

/// `words`, with the command-line options of the job.
std::vector<std::string> next_words(const SlurmJob& job) {
    std::vector<std::string> words = job.words;
    words.insert(words.end(), {"--slurm", "--no-wait", "--slurm-tasks", std::to_string(job.tasks)});
    for (const auto& [option, value] : {std::pair{"--slurm-partition", job.partition},
                                        {"--slurm-time", job.time},
                                        {"--slurm-lines", job.lines_file}})
        if (!value.empty()) words.insert(words.end(), {option, value});
    return words;
}

/// Returns the job number.
std::string submit_script(const SlurmJob& job, const std::vector<std::string>& options,
                          const std::string& argument) {
    std::vector<std::string> words{"sbatch", "--parsable", "--requeue", "--job-name=mcdem"};
    if (!job.partition.empty()) words.push_back("--partition=" + job.partition);
    if (!job.time.empty()) words.push_back("--time=" + job.time);
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {(job.folder / "job.sh").string(), argument});
    const auto end = slurm(words);
    const std::string number = end.out.substr(0, end.out.find_first_of(";\n"));
    if (end.exit_code != 0 || !is_number(number))
        throw InputError(
            fmt::format("--slurm: sbatch has refused the job (exit code {}): see what it says above, and {}",
                        end.exit_code, (job.folder / "job.sh").string()));
    return number;
}

}  // namespace

std::string job_script(const SlurmJob& job, const std::vector<std::size_t>& parts) {
    std::string lines = job.lines_file.empty() ? "" : read_file(job.lines_file);
    if (!lines.empty() && lines.back() != '\n') lines += '\n';
    return fmt::format(
        "#!/bin/bash\n"
        "# Written by mcdem anew for every job: lines of your own come from the file of --slurm-lines.\n"
        "{}"
        "parts=({})\n"
        "if [[ $1 == part ]]; then\n"
        "    exec {} --part \"${{parts[SLURM_ARRAY_TASK_ID]}}\"\n"
        "fi\n"
        "exec {}\n",
        lines, fmt::join(parts, " "), shell_words(job.words), shell_words(next_words(job)));
}

bool is_next_job(const SlurmJob& job) {
    const char* const me = std::getenv("SLURM_JOB_ID");
    return me && submitted_last(job).next == me;
}

std::string submit(const SlurmJob& job, const std::vector<std::size_t>& all_parts) {
    const std::vector<std::size_t> parts(
        all_parts.begin(),
        all_parts.begin() + static_cast<std::ptrdiff_t>(std::min(max_tasks, all_parts.size())));
    const std::string list = fmt::format("{}", fmt::join(parts, " "));
    const Jobs before = submitted_last(job);
    if (is_next_job(job)) {
        if (was_cancelled(before))
            throw RunError(fmt::format("job {} was cancelled: nothing is submitted again", before.array));
        if (before.parts == list)
            throw RunError(fmt::format("job {} has finished no part: see {}", before.array,
                                       (job.folder / (before.array + "_*.log")).string()));
    } else if (!before.array.empty() && are_in_queue(before)) {
        spdlog::info("job {} of this work is still there", before.array);
        return before.array;
    }
    make_folder(job.folder);
    replace_own(job.folder / "job.sh", FileKind::job_script, job_script(job, parts));
    Jobs jobs;
    jobs.array = submit_script(job,
                               {fmt::format("--array=0-{}%{}", parts.size() - 1, job.tasks),
                                "--output=" + log_pattern(job, "%A_%a.log")},
                               "part");
    jobs.next = submit_script(
        job, {"--dependency=afterany:" + jobs.array, "--output=" + log_pattern(job, "%j.log")}, "next");
    replace_file(jobs_file(job), fmt::format("{}\n{}\n{}\n", jobs.array, jobs.next, list));
    spdlog::info("job {}: {} part{}, {} at a time; job {} follows it", jobs.array, parts.size(),
                 parts.size() == 1 ? "" : "s", job.tasks, jobs.next);
    return jobs.array;
}

void wait_for_jobs(const SlurmJob& job, const std::function<bool()>& is_done) {
    auto last_asked = Clock::now();
    auto gone = Clock::time_point::max();  // since then it is not in the queue
    while (!is_done()) {
        const auto now = Clock::now();
        if (now - last_asked > ask) {
            last_asked = now;
            gone = are_in_queue(submitted_last(job)) ? Clock::time_point::max() : std::min(gone, now);
        }
        if (gone < now - settle) return;
        std::this_thread::sleep_for(look);
    }
}

}  // namespace mcdem::cli
