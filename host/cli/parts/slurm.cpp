#include "cli/parts/slurm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <thread>

#include "cli/shell/messages.h"
#include "cli/shell/subprocess.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/replaced.h"
#include "core/sha256.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto look = std::chrono::milliseconds(200);  ///< interval between checks of the folder
constexpr auto ask = std::chrono::seconds(5);          ///< interval between queries of Slurm
constexpr int max_queries = 4;                         ///< of squeue before it counts as not answering
constexpr auto pause = std::chrono::seconds(2);        ///< between these queries
constexpr auto settle = std::chrono::seconds(10);      ///< time until files of a finished job become visible

/// Maximum size of an array: Slurm's default of MaxArraySize.
constexpr std::size_t max_tasks = 1000;

/// Set in the dependent job: number of the array, and its parts.
std::string array_before() {
    const char* const value = std::getenv("MCDEM_SLURM_BEFORE");
    return value && std::getenv("SLURM_JOB_ID") && std::getenv("SLURM_JOB_NAME") ? value : "";
}

/// All jobs of a folder have the same name. On a node of the cluster the folder may have another path.
std::string name_of(const SlurmJob& job) {
    if (is_next_job()) return std::getenv("SLURM_JOB_NAME");
    return "mcdem-" + Sha256().add(fs::weakly_canonical(job.folder).string()).hex().substr(0, 12);
}

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

/// Number of the oldest pending or running job of the folder, other than this process; empty: there is none.
/// Nothing if Slurm does not answer.
std::optional<std::string> queued(const SlurmJob& job) {
    const auto end =
        slurm({"squeue", "--me", "--noheader", "--sort=i", "--name=" + name_of(job), "--format=%F"});
    if (end.exit_code != 0) return std::nullopt;
    std::istringstream lines(end.out);
    std::string number;
    while (std::getline(lines, number))
        if (!is_next_job() || number != std::getenv("SLURM_JOB_ID")) return number;
    return "";
}

/// The same; waits for an answer. Without one, the same parts could be submitted twice.
std::string queued_for_certain(const SlurmJob& job) {
    for (int tries = 0; tries < max_queries; ++tries) {
        if (tries > 0) std::this_thread::sleep_for(pause);
        if (const auto number = queued(job)) return *number;
    }
    throw RunError("squeue does not answer, see what it says above: give the command again later");
}

bool was_cancelled(const std::string& array) {
    const auto end = slurm({"squeue", "--jobs=" + array, "--noheader", "--states=CANCELLED", "--format=%F"});
    return end.exit_code == 0 && !end.out.empty();
}

/// Returns the job number.
std::string submit_script(const SlurmJob& job, const std::vector<std::string>& options,
                          const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"sbatch", "--parsable", "--requeue", "--job-name=" + name_of(job)};
    const SharingOptions& of = job.options;
    if (!of.slurm_partition.empty()) words.push_back("--partition=" + of.slurm_partition);
    if (!of.slurm_time.empty()) words.push_back("--time=" + of.slurm_time);
    words.insert(words.end(), options.begin(), options.end());
    words.push_back((job.folder / "job.sh").string());
    words.insert(words.end(), arguments.begin(), arguments.end());
    const auto end = slurm(words);
    const std::string number = end.out.substr(0, end.out.find_first_of(";\n"));
    if (end.exit_code != 0 || number.empty() || number.find_first_not_of("0123456789") != number.npos)
        throw InputError(
            fmt::format("--slurm: sbatch has refused the job (exit code {}): see what it says above, and {}",
                        end.exit_code, (job.folder / "job.sh").string()));
    return number;
}

}  // namespace

std::string job_script(const SlurmJob& job, const std::vector<std::size_t>& parts) {
    const std::string& file = job.options.slurm_lines;
    return fmt::format(
        "#!/bin/bash\n"
        "# Written by mcdem anew for every job: lines of your own come from the file of --slurm-lines.\n"
        "{}\n"
        "parts=({})\n"
        "if [[ $1 == part ]]; then\n"
        "    unset MCDEM_SLURM_BEFORE\n"
        "    exec {} --part \"${{parts[SLURM_ARRAY_TASK_ID]}}\"\n"
        "fi\n"
        "export MCDEM_SLURM_BEFORE=\"$2 ${{parts[*]}}\"\n"
        "exec {}\n",
        file.empty() ? "" : read_file(file), fmt::join(parts, " "), shell_words(job.words),
        shell_words(job.next));
}

bool is_next_job() { return !array_before().empty(); }

std::string submit(const SlurmJob& job, const std::vector<std::size_t>& all_parts) {
    const std::vector<std::size_t> parts(
        all_parts.begin(),
        all_parts.begin() + static_cast<std::ptrdiff_t>(std::min(max_tasks, all_parts.size())));
    const fs::path script = job.folder / "job.sh";
    expect_replaceable(script, FileKind::job_script);
    if (const auto there = is_there(script) ? queued_for_certain(job) : ""; !there.empty()) {
        spdlog::info("job {} of this work is still pending or running", there);
        return there;
    }
    if (is_next_job()) {
        const std::string before = array_before(), last = before.substr(0, before.find(' '));
        if (was_cancelled(last))
            throw RunError(fmt::format("job {} was cancelled: nothing is submitted again", last));
        if (before == fmt::format("{} {}", last, fmt::join(parts, " ")))
            throw RunError(fmt::format("job {} has finished no part: see {}", last,
                                       (job.folder / (last + "_*.log")).string()));
    }
    make_folder(job.folder);
    replace_own(script, FileKind::job_script, job_script(job, parts));
    const std::string array =
        submit_script(job,
                      {fmt::format("--array=0-{}%{}", parts.size() - 1, job.options.slurm_tasks),
                       "--output=" + log_pattern(job, "%A_%a.log")},
                      {"part"});
    const std::string next = submit_script(
        job, {"--dependency=afterany:" + array, "--output=" + log_pattern(job, "%j.log")}, {"next", array});
    spdlog::info("job {}: {} part{}, {} at a time; job {} follows it", array, parts.size(),
                 parts.size() == 1 ? "" : "s", job.options.slurm_tasks, next);
    return array;
}

void wait_for_jobs(const SlurmJob& job, const std::function<bool()>& is_done) {
    for (auto asked = Clock::now(); !is_done(); std::this_thread::sleep_for(look)) {
        if (Clock::now() - asked < ask) continue;
        asked = Clock::now();
        if (queued(job) != "") continue;
        std::this_thread::sleep_for(settle);
        is_done();
        return;
    }
}

}  // namespace mcdem::cli
