#include "cli/parts/sharing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <csignal>
#include <deque>
#include <list>
#include <thread>

#include "cli/parts/ranks.h"
#include "cli/parts/slurm.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "cli/shell/subprocess.h"
#include "core/errors.h"

namespace mcdem::inline cli {
namespace {

using Numbers = std::vector<std::size_t>;

const char* const all_devices = "all";
const char* const group = "Many devices and nodes";
constexpr int max_tries = 3;       ///< passes in which no part is finished
constexpr int all_is_merged = -1;  ///< instead of an exit code: everything is merged and must be reported

std::string choice_of(const std::string& device) { return device == all_devices ? "" : device; }

int interrupted(const SharedWork& work) {
    spdlog::warn("interrupted; results are kept in {}; run the same command again to continue",
                 work.out.string());
    return exit_interrupted;
}

/// Reports a failure of the device or the disk.
int failed(const SharedWork& work, const std::exception& error) {
    const int code = report_error(error);
    spdlog::warn("results are kept in {}; run the same command again to continue", work.out.string());
    return code;
}

/// The missing parts. If none is missing they are merged; the result is empty after the merge. A damaged
/// part counts as missing.
Numbers left_to_compute(PartedWork& parts) {
    Numbers left = parts.missing();
    while (left.empty() && !parts.merge()) left = parts.missing();
    return left;
}

[[noreturn]] void refuse_to_repeat(const SharedWork& work) {
    throw RunError(work.out.string() + ": no part could be finished: fix the errors above first");
}

/// Calls `compute`, which returns an exit code, with the missing parts until all are merged.
int until_merged(const SharedWork& work, PartedWork& parts,
                 const std::function<int(const Numbers&)>& compute) {
    int tries = 0;
    for (Numbers before, left; !(left = left_to_compute(parts)).empty(); before = left) {
        tries = left == before ? tries + 1 : 0;
        if (tries == max_tries) refuse_to_repeat(work);
        if (const int code = compute(left); code != exit_done) return code;
    }
    return all_is_merged;
}

int compute_one(PartedWork& parts, std::size_t part, const std::string& device) {
    Device chosen(device);
    parts.compute(chosen, part);
    return exit_done;
}

int compute_here(const SharedWork& work, PartedWork& parts, const std::string& device) try {
    Device chosen(device);
    return until_merged(work, parts, [&](const Numbers& left) {
        Progress progress(stderr, progress_style(stderr));
        double done = 0;
        const auto all = static_cast<double>(left.size());
        parts.on_progress = [&](double fraction) { progress.show((done + fraction) / all); };
        for (const std::size_t part : left) {
            parts.compute(chosen, part);
            ++done;
        }
        return exit_done;
    });
} catch (const cl::Error& error) {
    return failed(work, error);
}

std::vector<std::string> program_and(std::vector<std::string> words) {
    words.insert(words.begin(), this_program().string());
    return words;
}

struct Running {
    std::size_t part;
    int device;
    Subprocess process;
};

/// Distributes parts to the devices of this machine, one process per device: runs `words --part K --device D`
/// for every part. A device whose process fails is removed from `devices`, and another one gets the part. A
/// part whose process was ended by a signal remains missing. The caller has an Interrupt.
class Dealing {
public:
    Dealing(const std::vector<std::string>& words, const std::vector<std::size_t>& parts,
            std::vector<int>& devices)
        : words_(words),
          all_(parts.size()),
          parts_(parts.begin(), parts.end()),
          devices_(devices),
          free_(devices) {}

    /// An exit code: interrupted; bad input if a process reported it; failed if no device is left; otherwise
    /// done.
    int all() {
        bool passed_on = false;
        while (!running_.empty() || can_start()) {
            while (can_start()) start();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (Interrupt::wanted() && !std::exchange(passed_on, true))
                for (const Running& one : running_) one.process.send(SIGTERM);
            for (auto one = running_.begin(); one != running_.end();) {
                const auto end = one->process.ended();
                if (end) note(*one, *end);
                one = end ? running_.erase(one) : std::next(one);
            }
            progress_.show(static_cast<double>(done_) / static_cast<double>(all_));
        }
        progress_.clear();
        if (code_ == exit_done && Interrupt::wanted()) code_ = exit_interrupted;
        return code_ == exit_done && !parts_.empty() ? exit_failed : code_;
    }

private:
    bool can_start() const {
        return code_ == exit_done && !Interrupt::wanted() && !parts_.empty() && !free_.empty();
    }

    void start() {
        const std::size_t part = parts_.front();
        const int device = free_.back();
        std::vector<std::string> words = words_;
        words.insert(words.end(), {"--part", std::to_string(part), "--device", std::to_string(device)});
        running_.push_back({part, device, Subprocess(words)});
        parts_.pop_front();
        free_.pop_back();
    }

    void note(const Running& one, const ProgramEnd& end) {
        if (end.signal == 0 && end.exit_code != exit_failed) {
            if (end.exit_code != exit_done) code_ = end.exit_code;
            free_.push_back(one.device);
            ++done_;
            return;
        }
        progress_.clear();
        if (end.signal != 0) {
            spdlog::warn("part {}: its process on device {} was ended by signal {}", one.part, one.device,
                         end.signal);
            free_.push_back(one.device);
            return;
        }
        spdlog::warn("part {}: has failed on device {}, which is left out from here on", one.part,
                     one.device);
        std::erase(devices_, one.device);
        parts_.push_back(one.part);
    }

    const std::vector<std::string>& words_;
    std::size_t all_, done_ = 0;
    std::deque<std::size_t> parts_;
    std::vector<int>& devices_;
    std::vector<int> free_;
    std::list<Running> running_;
    Progress progress_{stderr, progress_style(stderr)};
    int code_ = exit_done;
};

int compute_on_all_devices(const SharedWork& work, PartedWork& parts, const SharingOptions& options,
                           const std::vector<int>& devices) {
    for (const DeviceInfo& info : list_devices())
        if (std::ranges::find(devices, info.index) == devices.end())
            spdlog::info("device {}, {}, is left out: its bits are not those of device {}", info.index,
                         info.name, devices.front());
    if (devices.size() == 1) return compute_here(work, parts, std::to_string(devices.front()));
    spdlog::info("{} devices, a process on each", devices.size());
    const std::vector<std::string> words = program_and(words_of(options));
    std::vector<int> left_devices = devices;
    return until_merged(work, parts, [&](const Numbers& left) {
        const int code = Dealing(words, left, left_devices).all();
        if (code == exit_interrupted) return interrupted(work);
        if (code == exit_failed)
            spdlog::error("no device is left; results are kept in {}; run the same command again to continue",
                          work.out.string());
        return code;
    });
}

int compute_as_rank(const SharedWork& work, const std::string& device) {
    Ranks ranks;
    try {
        const Interrupt interrupt;
        const auto devices = alike_devices(choice_of(device));
        Device mine(std::to_string(devices[static_cast<std::size_t>(ranks.on_machine()) % devices.size()]));
        auto parts = work.begin(static_cast<std::size_t>(ranks.size()));
        parts->on_progress = [&](double) { ranks.answer(); };
        const auto left_now = [&] {
            return ranks.agreed(ranks.rank() == 0 ? left_to_compute(*parts) : Numbers{});
        };
        for (Numbers before, left; !(left = left_now()).empty(); before = left) {
            if (left == before) refuse_to_repeat(work);
            for (std::size_t next; (next = ranks.next()) < left.size();) {
                spdlog::info("part {}: rank {}, device {}", left[next], ranks.rank(), mine.info().index);
                parts->compute(mine, left[next]);
            }
            ranks.wait();
        }
        parts.reset();
        ranks.wait();
        return ranks.rank() == 0 ? work.report() : exit_done;
    } catch (const Interrupted&) {
        ranks.abort(interrupted(work));
    } catch (const std::exception& error) {
        ranks.abort(failed(work, error));
    }
}

int merge_only(const SharedWork& work, PartedWork& parts) {
    const Numbers left = left_to_compute(parts);
    if (left.empty()) return all_is_merged;
    spdlog::error("{}: {} part{} missing: {}; the command without --merge computes what is missing",
                  work.out.string(), left.size(), left.size() == 1 ? " is" : "s are", fmt::join(left, ", "));
    return exit_failed;
}

int compute_by_slurm(const SharedWork& work, PartedWork& parts, const SharingOptions& options,
                     const std::string& device) {
    SlurmJob job{work.out / "slurm", program_and(words_of(options)), program_and(words_of(options, true)),
                 options};
    if (!device.empty() && device != all_devices) job.words.insert(job.words.end(), {"--device", device});
    job.next.push_back("--no-wait");
    for (Numbers left; !(left = left_to_compute(parts)).empty();) {
        const std::string number = submit(job, left);
        if (options.no_wait) {
            print_out("{}: job {}; the same command without --no-wait waits for it\n", work.out.string(),
                      number);
            return exit_done;
        }
        Progress progress(stderr, progress_style(stderr));
        const auto all = static_cast<double>(left.size());
        wait_for_jobs(job, [&] {
            left = parts.missing();
            progress.show(std::max(0.0, 1 - static_cast<double>(left.size()) / all));
            return left.empty() || Interrupt::wanted();
        });
        progress.clear();
        if (left.empty()) continue;
        if (Interrupt::wanted()) {
            spdlog::warn("job {} continues; the same command waits for it again, `scancel {}` ends it",
                         number, number);
            return exit_interrupted;
        }
        spdlog::error(
            "job {} has ended before the work was done, see {}; run the same command again to continue",
            number, (job.folder / "*.log").string());
        return exit_failed;
    }
    return is_next_job() ? exit_done : all_is_merged;
}

/// Computes what is missing and merges, or what the options choose of it. Signals interrupt all of it.
int compute_and_merge(const SharedWork& work, PartedWork& parts, const SharingOptions& options,
                      const std::string& device, const std::vector<int>& devices) try {
    const Interrupt interrupt;
    if (options.part) return compute_one(parts, *options.part, choice_of(device));
    if (options.merge) return merge_only(work, parts);
    if (options.slurm) return compute_by_slurm(work, parts, options, device);
    if (!devices.empty()) return compute_on_all_devices(work, parts, options, devices);
    return compute_here(work, parts, device);
} catch (const Interrupted&) {
    return interrupted(work);
}

}  // namespace

void add_part_options(CLI::App& command, SharingOptions& options, std::string& device) {
    options.command = &command;
    command
        .add_option(
            "--device", device,
            "Number or part of the name of a device, as `mcdem devices` lists them; all: every device of "
            "one kind")
        ->type_name("DEVICE");
    command.add_option("--part", options.part, "Compute only this part of the work")
        ->type_name("K")
        ->group(group);
    command.add_flag("--missing", options.missing, "Print the numbers of the parts that can be computed now")
        ->group(group)
        ->excludes("--part");
    command.add_flag("--merge", options.merge, "Merge the parts, or list those that are missing")
        ->group(group)
        ->excludes("--part")
        ->excludes("--missing");
    command
        .add_option("--workers", options.workers,
                    "Number of processes among which the work is divided, if it cannot be detected")
        ->check(CLI::Range(1, 100'000))
        ->type_name("N")
        ->group(group);
}

void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device) {
    add_part_options(command, options, device);
    auto* mpi = command.add_flag("--mpi", options.mpi, "Run as one of the ranks that mpirun or srun started");
    auto* slurm = command.add_flag("--slurm", options.slurm,
                                   "Submit a Slurm job array with one task per part, and wait for it");
    for (auto* way : {mpi, slurm})
        way->group(group)->excludes("--part")->excludes("--missing")->excludes("--merge");
    mpi->excludes(slurm);
    for (auto* option :
         {command
              .add_option("--slurm-tasks", options.slurm_tasks,
                          "Number of array tasks that run at the same time")
              ->check(CLI::Range(1, 100'000))
              ->type_name("N"),
          command.add_option("--slurm-partition", options.slurm_partition, "Slurm partition")
              ->type_name("NAME"),
          command.add_option("--slurm-time", options.slurm_time, "Time limit of a task, as sbatch takes it")
              ->type_name("TIME"),
          command
              .add_option("--slurm-lines", options.slurm_lines,
                          "File with further lines for the top of the job script")
              ->type_name("FILE"),
          command.add_flag("--no-wait", options.no_wait, "Submit the job and return at once")})
        option->needs(slurm)->group(group);
}

std::vector<std::string> words_of(const SharingOptions& options, bool all) {
    std::vector<std::string> words;
    for (const CLI::App* app = options.command; app->get_parent(); app = app->get_parent())
        words.insert(words.begin(), app->get_name());
    for (const CLI::Option* option : options.command->get_options()) {
        const std::string name = option->get_name();
        const bool is_how = option->get_group() == group || name == "--device";
        if (name == "--resume" || (is_how && !all)) continue;
        for (const std::string& value : option->results()) {
            if (!option->get_positional()) words.push_back(name);
            if (option->get_items_expected_max() > 0) words.push_back(value);
        }
    }
    return words;
}

bool is_shared(const SharingOptions& options, const std::string& device) {
    return options.part || options.missing || options.merge || options.mpi || options.slurm ||
           device == all_devices;
}

int share(const SharedWork& work, const SharingOptions& options, const std::string& device) {
    if (options.mpi) return compute_as_rank(work, device);
    const bool on_all = device == all_devices && !options.slurm;
    const std::vector<int> devices = on_all ? alike_devices("") : std::vector<int>{};
    const std::size_t known = options.slurm ? static_cast<std::size_t>(options.slurm_tasks) : devices.size();
    auto parts = work.begin(options.workers.value_or(known));
    if (options.missing) {
        for (const std::size_t part : parts->missing()) print_out("{}\n", part);
        return exit_done;
    }
    const int code = compute_and_merge(work, *parts, options, device, devices);
    parts.reset();  // releases its lock
    return code == all_is_merged ? work.report() : code;
}

}  // namespace mcdem::cli
