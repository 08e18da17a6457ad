#include "cli/sharing.h"

#include <csignal>
#include <list>
#include <thread>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "cli/ranks.h"
#include "cli/shell_word.h"
#include "cli/slurm.h"
#include "cli/standard_streams.h"
#include "cli/subprocess.h"
#include "core/errors.h"

namespace mcdem {
namespace {

using Clock = std::chrono::steady_clock;

const char* const all_devices = "all";

std::string choice_of(const std::string& device) { return device == all_devices ? "" : device; }

/// Shows how far all the work is, at most once a second: that needs a look at the folder.
class Watch {
public:
    explicit Watch(const SharedWork& work) : work_(work) {}
    void look() {
        if (Clock::now() - last_ < std::chrono::seconds(1)) return;
        progress_.show(work_.fraction());
        last_ = Clock::now();
    }
    void clear() { progress_.clear(); }

private:
    const SharedWork& work_;
    Progress progress_{stderr, progress_style(stderr)};
    Clock::time_point last_{};
};

int interrupted(const SharedWork& work) {
    spdlog::warn("interrupted; what was done stays in {}, and the same command goes on", work.out.string());
    return exit_interrupted;
}

/// This process works, on one device. Only the leader tells how far all is and what came of it.
int work_here(const SharedWork& work, const std::string& device, std::size_t workers, bool leads) {
    const Interrupt interrupt;
    Device chosen(device);
    Watch watch(work);
    bool done = false;
    try {
        done = work.join(chosen, workers, [&] {
            if (leads) watch.look();
        });
    } catch (const cl::Error& error) {
        watch.clear();
        const int code = report_error(error);
        spdlog::warn("what was done stays in {}: other workers go on with it, or the same command",
                     work.out.string());
        return code;
    }
    watch.clear();
    if (!done) return interrupted(work);
    return leads ? work.report() : exit_done;
}

int work_as_rank(const SharedWork& work, const std::string& device) {
    const Rank me = meet_ranks();
    const auto devices = alike_devices(choice_of(device));
    const int mine = devices[static_cast<std::size_t>(me.on_machine) % devices.size()];
    return work_here(work, std::to_string(mine), static_cast<std::size_t>(me.size), me.rank == 0);
}

/// A worker of its own for a device: this program again.
struct DeviceWorker {
    int device;
    Subprocess process;
    bool told_of = false;
};

/// Waits until all have ended; the worst exit code of those that ended by themselves, none where one was
/// killed.
int wait_for(std::list<DeviceWorker>& workers, const SharedWork& work, bool leads) {
    const Interrupt interrupt;
    Watch watch(work);
    int worst = exit_done;
    bool passed_on = false;
    for (std::size_t running = workers.size(); running > 0;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        if (leads) watch.look();
        for (auto& worker : workers) {
            const auto end = worker.process.ended();
            if (Interrupt::wanted() && !passed_on) worker.process.send(SIGTERM);
            if (!end || std::exchange(worker.told_of, true)) continue;
            --running;
            worst = std::max(worst, end->exit_code);
            watch.clear();
            if (end->signal != 0)
                spdlog::warn("the worker on device {} was ended by signal {}; the others do its work again",
                             worker.device, end->signal);
        }
        passed_on = Interrupt::wanted();
    }
    return worst;
}

int work_on_all_devices(const SharedWork& work, bool leads) {
    const auto devices = alike_devices("");
    for (const DeviceInfo& info : list_devices())
        if (leads && std::ranges::find(devices, info.index) == devices.end())
            spdlog::info("device {}, {}, is left out: its bits are not those of device {}", info.index,
                         info.name, devices.front());
    if (devices.size() == 1) return work_here(work, std::to_string(devices.front()), 1, leads);
    if (leads) spdlog::info("{} devices, a worker on each", devices.size());
    std::list<DeviceWorker> workers;
    for (const int device : devices) {
        std::vector<std::string> words{this_program().string()};
        words.insert(words.end(), work.words.begin(), work.words.end());
        words.insert(words.end(), {"--worker", "--device", std::to_string(device)});
        workers.push_back({device, Subprocess(words)});
    }
    const int worst = wait_for(workers, work, leads);
    if (work.done()) return leads ? work.report() : exit_done;
    if (worst == exit_interrupted) return interrupted(work);
    if (worst == exit_bad_input) return worst;
    spdlog::error("no worker is left; what was done stays in {}, and the same command goes on",
                  work.out.string());
    return exit_failed;
}

int work_by_slurm(const SharedWork& work, const SharingOptions& options, const std::string& device) {
    SlurmJob job;
    job.folder = work.out / "slurm";
    job.words = {this_program().string()};
    job.words.insert(job.words.end(), work.words.begin(), work.words.end());
    job.words.insert(job.words.end(), {"--worker", "--device", device.empty() ? all_devices : device});
    job.tasks = options.slurm_tasks;
    job.partition = options.slurm_partition;
    job.time = options.slurm_time;
    job.lines_file = options.slurm_lines;
    if (!work.done()) {
        const std::string number = submit(job);
        if (options.no_wait) {
            print_out("{}: job {}; the same command without --no-wait waits for it\n", work.out.string(),
                      number);
            return exit_done;
        }
        const Interrupt interrupt;
        Watch watch(work);
        const bool ended = wait_for_job(number, work.done, [&] {
            watch.look();
            return !Interrupt::wanted();
        });
        watch.clear();
        if (!ended) {
            spdlog::warn("job {} goes on; the same command waits for it again, `scancel {}` ends it", number,
                         number);
            return exit_interrupted;
        }
        if (!work.done()) {
            spdlog::error("job {} has ended before the work was done; {} says why; the same command goes on",
                          number, (job.folder / (number + "_*.log")).string());
            return exit_failed;
        }
    }
    return work.report();
}

}  // namespace

void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device) {
    const std::string group = "Many devices and nodes";
    command
        .add_option(
            "--device", device,
            "Number or part of the name of a device, as `mcdem devices` lists them; all: every device of "
            "one kind")
        ->type_name("DEVICE");
    auto* mpi =
        command.add_flag("--mpi", options.mpi, "This is one of the ranks that mpirun or srun started");
    auto* worker =
        command.add_flag("--worker", options.worker,
                         "Join the work in the folder, on any machine that has it; say nothing of it");
    auto* slurm =
        command.add_flag("--slurm", options.slurm, "Submit a Slurm job array of workers, and wait for it");
    mpi->excludes(worker)->excludes(slurm);
    worker->excludes(slurm);
    for (auto* option :
         {command.add_option("--slurm-tasks", options.slurm_tasks, "Workers of the array")
              ->capture_default_str()
              ->check(CLI::Range(1, 100'000))
              ->type_name("N"),
          command.add_option("--slurm-partition", options.slurm_partition, "Partition")->type_name("NAME"),
          command
              .add_option("--slurm-time", options.slurm_time, "Time limit of a worker, as sbatch takes it")
              ->type_name("TIME"),
          command.add_option("--slurm-lines", options.slurm_lines, "Lines for the top of the job script")
              ->type_name("FILE"),
          command.add_flag("--no-wait", options.no_wait, "Submit, and do not wait")})
        option->needs(slurm)->group(group);
    for (auto* option : {mpi, worker, slurm}) option->group(group);
}

bool is_shared(const SharingOptions& options, const std::string& device) {
    return options.mpi || options.worker || options.slurm || device == all_devices;
}

int share(const SharedWork& work, const SharingOptions& options, const std::string& device) {
    if (options.mpi) return work_as_rank(work, device);
    if (options.slurm || device == all_devices) work.check();
    if (options.slurm) return work_by_slurm(work, options, device);
    if (device == all_devices) return work_on_all_devices(work, !options.worker);
    return work_here(work, device, 1, !options.worker);
}

}  // namespace mcdem
