#include <fmt/format.h>

#include <algorithm>

#include "cl/profile.h"
#include "cli/parts/sharing.h"
#include "cli/run/checked_device.h"
#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/python_program.h"
#include "cli/shell/shell_words.h"
#include "cli/shell/standard_streams.h"
#include "core/container.h"
#include "core/errors.h"
#include "core/parameters.h"
#include "core/version.h"
#include "ensemble/parts/run_parts.h"
#include "io/checkpoint.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem::inline cli {
namespace {

struct RunCommand {
    SceneOptions scene;
    std::string out, device;
    bool resume = false, no_figures = false;
    SharingOptions sharing;
    RunCut cut;
};

std::string resume_command(const RunCommand& command) {
    std::string text = "mcdem " + shell_words(words_of(command.sharing));
    if (!command.device.empty()) text += " --device " + shell_word(command.device);
    return text + " --resume";
}

void warn_of_failure(const Replica& replica, const Failure& failure) {
    spdlog::warn("replica {} stopped at {}", replica.label.empty() ? "1" : replica.label, failure.text());
}

RunSummary run_with_progress(Device& device, const Scene& scene, const RunCommand& command) {
    const Interrupt interrupt;
    Progress progress(stderr, progress_style(stderr));
    RunOptions options;
    options.folder = command.out;
    options.start = command.resume ? Start::resume : Start::fresh;
    options.program = version_text;
    options.on_progress = [&](double fraction) { progress.show(fraction); };
    options.on_failure = [&](const Replica& replica, const Failure& failure) {
        progress.clear();
        warn_of_failure(replica, failure);
    };
    options.on_warning = [&](const std::string& message) {
        progress.clear();
        spdlog::warn("{}", message);
    };
    options.stop_wanted = Interrupt::wanted;
    return run_scene(device, scene, options);
}

void print_summary(const Run& run, const RunSummary& summary, std::size_t failed) {
    const std::size_t replicas = run.recordings.size();
    print_out("{}: {} of {} replica{} done", run.name, replicas - failed, replicas, replicas == 1 ? "" : "s");
    if (failed > 0) print_out(", {} stopped early", failed);
    if (summary.grain_steps > 0)
        print_out("; {:.1f} million grain-steps in {} ({:.1f} million/s)", summary.grain_steps * 1e-6,
                  duration_text(summary.seconds), summary.grain_steps * 1e-6 / summary.seconds);
    print_out("\n");
}

void warn_of_no_contact(const Run& run) {
    const auto untouched = std::ranges::count_if(run.recordings, [](const Recording& recording) {
        return !recording.failure && !is_cell(recording.box) && !recording.scans.empty() &&
               std::ranges::none_of(recording.scans, [](const Scan& scan) { return scan.top_force() > 0; });
    });
    if (untouched > 0)
        spdlog::warn(
            "in {} of {} replica{} the plate touched no grain at any scan: lower plate.end, or the plate's "
            "positions in [[programme]]",
            untouched, run.recordings.size(), run.recordings.size() == 1 ? "" : "s");
}

/// The plate of such a replica stands until the packing settles.
bool waits_for_rest(const Recording& recording) {
    return find_parameter(recording.parameters, "protocol.stop_at_scans") == Parameter(true) &&
           find_parameter(recording.parameters, "protocol.pause") == Parameter(0.0) &&
           !has_programme(recording.parameters);
}

void warn_of_unsettled(const Run& run) {
    std::size_t unsettled = 0, all = 0;
    for (const auto& recording : run.recordings) {
        if (!waits_for_rest(recording)) continue;
        for (const auto& scan : recording.scans) {
            if (scan.plate_z == recording.plate_start) continue;  // after relax_time
            ++all;
            unsettled += !scan.settled;
        }
    }
    if (unsettled > 0)
        spdlog::warn(
            "{} of {} scans were taken before the packing had settled (settled = 0 in plate.csv): forces may "
            "still change; raise protocol.settle_time, or set protocol.stop_at_scans = false",
            unsettled, all);
}

void print_paths(const std::filesystem::path& folder) {
    print_out("\nwrote\n");
    for (const auto& file : {run_file(folder), folder / "plate.csv"}) print_out("  {}\n", file.string());
}

/// The table of forces, the figures and the paths, by the Python package.
void present_run(const std::filesystem::path& folder) {
    try {
        const int code = run_python_module("mcdem.report.present_run", {folder.string()});
        if (code == exit_interrupted) throw Interrupted();
        if (code != exit_done)
            throw RunError(
                fmt::format("the results are written, but could not all be shown: Python ended with exit "
                            "code {}",
                            code));
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        spdlog::warn("no table and no figures: {}", error.what());
        print_paths(folder);
    }
}

/// Reports a run with results in the folder; returns the exit code.
int report_run(const RunCommand& command, const RunSummary& summary) {
    const Run run = read_run(command.out, ReadWhat::observables);
    std::size_t failed = 0;
    for (const auto& recording : run.recordings) failed += recording.failure.has_value();
    print_summary(run, summary, failed);
    warn_of_no_contact(run);
    warn_of_unsettled(run);
    command.no_figures ? print_paths(command.out) : present_run(command.out);
    if (failed < run.recordings.size()) return exit_done;
    spdlog::error("all replicas stopped early");
    return exit_failed;
}

SharedWork shared_work(const RunCommand& command, const Scene& scene) {
    SharedWork work;
    work.out = command.out;
    work.begin = [&](std::size_t workers) {
        RunOptions options;
        options.folder = command.out;
        options.program = version_text;
        options.on_failure = warn_of_failure;
        options.on_warning = [](const std::string& message) { spdlog::warn("{}", message); };
        options.stop_wanted = Interrupt::wanted;
        RunCut cut = command.cut;
        cut.workers = workers;
        return std::make_unique<RunParts>(scene, options, cut);
    };
    work.check = [&](Device& device) { check_at_first_use(device, scene.precision); };
    work.report = [&] { return report_run(command, {}); };
    return work;
}

/// Reports an error and how to resume.
int failed_run(const RunCommand& command, const std::exception& error) {
    const int code = report_error(error);
    if (has_checkpoint(command.out))
        spdlog::warn("recorded data are kept; resume with\n  {}", resume_command(command));
    return code;
}

int run_alone(const RunCommand& command, const Scene& scene) {
    Device device(command.device);
    check_at_first_use(device, scene.precision);
    spdlog::info("{}: {} on {}", scene.name, size_text(scene), device.info().name);
    RunSummary summary;
    try {
        summary = run_with_progress(device, scene, command);
    } catch (const cl::Error& error) {
        return failed_run(command, error);
    } catch (const RunError& error) {
        return failed_run(command, error);
    }
    if (is_profiling()) fmt::print(stderr, "{}", profile_text());
    if (summary.end == RunEnd::interrupted) {
        spdlog::warn("interrupted; resume with\n  {}", resume_command(command));
        return exit_interrupted;
    }
    if (summary.end == RunEnd::was_done) spdlog::info("{}: this run is done already", command.out);
    return report_run(command, summary);
}

int run(const RunCommand& command) {
    const Scene scene = command.scene.read();
    if (is_shared(command.sharing) || command.cut.part_replicas > 0 ||
        (command.resume && is_run_in_parts(command.out)))
        return share(shared_work(command, scene), command.sharing, command.device);
    return run_alone(command, scene);
}

}  // namespace

void add_run(CLI::App& sub, int& exit_code) {
    auto command = std::make_shared<RunCommand>();
    add_scene_options(sub, command->scene);
    sub.add_option("--out", command->out, "Result folder; created if missing")->required()->type_name("DIR");
    sub.add_flag("--resume", command->resume, "Continue the interrupted run in DIR");
    sub.add_flag("--no-figures", command->no_figures, "Do not draw figures at the end, and print no table");
    add_sharing_options(sub, command->sharing, command->device);
    sub.add_option_function<std::size_t>(
           "--part-replicas", [command](std::size_t replicas) { command->cut.part_replicas = replicas; },
           "Run in parts of so many replicas; default with --part: enough to fill a device, but at least two "
           "parts per process")
        ->check(CLI::Range(1, 10'000))
        ->type_name("N")
        ->group("Many devices and nodes");
    sub.footer(
        "Writes run.h5 (everything, HDF5), plate.csv (forces and averages) and figures into DIR. A replica "
        "that\n"
        "fails is reported and recorded; the others continue. The exit code is 1 if all replicas failed.\n"
        "A run that is interrupted (Ctrl-C, crash, power cut) loses at most the time since its last "
        "checkpoint\n"
        "(output.checkpoint_minutes). Continue it with --resume; the results are bit-identical.\n"
        "With --part, --part-replicas or `mcdem distribute` the run is computed in parts, with bit-identical "
        "results.\n"
        "Lost parts are computed again; to continue such a run give the same command again, without "
        "--resume.\n"
        "Examples:\n"
        "  mcdem run scenes/small.toml --out out/small\n"
        "  mcdem run scenes/compression.toml --out out/soft --set grains.youngs_modulus=10e3\n"
        "  mcdem run scenes/compression.toml --out out/one --set contact.model=elastic_sphere\n"
        "  mcdem run scenes/compression.toml --out out/one --set contact.model=elastic_sphere --resume\n"
        "  mcdem run scenes/replicas.toml --out out/shared --part 3/8\n"
        "  mcdem run scenes/replicas.toml --out out/shared --merge");
    sub.callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace mcdem::cli
