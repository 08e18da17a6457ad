#include "cli/slurm.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include "cli/messages.h"
#include "cli/shell_word.h"
#include "cli/subprocess.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/make_folder.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto look = std::chrono::milliseconds(200);  ///< at the folder
constexpr auto ask = std::chrono::seconds(5);          ///< Slurm
constexpr auto settle = std::chrono::seconds(10);      ///< for files of a job that ended to be seen here

fs::path number_file(const SlurmJob& job) { return job.folder / "job"; }

std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    if (!in) throw InputError(file.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

/// In the pattern of a log's name, % begins a replacement.
std::string log_pattern(const SlurmJob& job) {
    std::string pattern;
    for (const char c : fs::absolute(job.folder).string()) pattern += c == '%' ? "%%" : std::string(1, c);
    return pattern + "/%A_%a.log";
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

/// Whether any task of the job waits or runs. Where Slurm does not answer, it may.
bool is_in_queue(const std::string& number) {
    const auto end = slurm({"squeue", "--me", "--noheader", "--array", "--format=%F"});
    if (end.exit_code != 0) return true;
    return ("\n" + end.out).find("\n" + number + "\n") != std::string::npos;
}

}  // namespace

std::string job_script(const SlurmJob& job) {
    std::string lines = job.lines_file.empty() ? "" : text_of(job.lines_file);
    if (!lines.empty() && lines.back() != '\n') lines += '\n';
    return "#!/bin/bash\n" + lines + "exec " + shell_words(job.words) + "\n";
}

std::string submit(const SlurmJob& job) {
    if (fs::exists(number_file(job))) {
        std::string before = text_of(number_file(job));
        before = before.substr(0, before.find('\n'));
        if (is_number(before) && is_in_queue(before)) {
            spdlog::info("job {} of this work is still there", before);
            return before;
        }
    }
    make_folder(job.folder);
    replace_file(job.folder / "job.sh", job_script(job));
    std::vector<std::string> words{"sbatch",
                                   "--parsable",
                                   "--requeue",
                                   "--job-name=mcdem",
                                   fmt::format("--array=1-{}", job.tasks),
                                   "--output=" + log_pattern(job)};
    if (!job.partition.empty()) words.push_back("--partition=" + job.partition);
    if (!job.time.empty()) words.push_back("--time=" + job.time);
    words.push_back((job.folder / "job.sh").string());
    const auto end = slurm(words);
    const std::string number = end.out.substr(0, end.out.find_first_of(";\n"));
    if (end.exit_code != 0 || !is_number(number))
        throw InputError(
            fmt::format("--slurm: sbatch has refused the job (exit code {}): see what it says above, and {}",
                        end.exit_code, (job.folder / "job.sh").string()));
    replace_file(number_file(job), number + "\n");
    spdlog::info("job {}: {} worker{}", number, job.tasks, job.tasks == 1 ? "" : "s");
    return number;
}

bool wait_for_job(const std::string& number, const std::function<bool()>& done,
                  const std::function<bool()>& go_on) {
    auto last_asked = Clock::now();
    std::optional<Clock::time_point> gone;
    while (!done()) {
        if (!go_on()) return false;
        const auto now = Clock::now();
        if (!gone && now - last_asked > ask) {
            last_asked = now;
            if (!is_in_queue(number)) gone = now;
        }
        if (gone && now - *gone > settle) return true;
        std::this_thread::sleep_for(look);
    }
    return true;
}

}  // namespace mcdem
