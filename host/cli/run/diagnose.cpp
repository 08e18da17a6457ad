#include <fmt/ranges.h>

#include <algorithm>

#include "cli/parts/sharing.h"
#include "cli/run/figures.h"
#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "core/version.h"
#include "diagnose/decide/diagnosis_json.h"
#include "ensemble/parts/library_parts.h"
#include "experiment/check_experiment.h"
#include "io/result_folder.h"

namespace mcdem::inline cli {
namespace {

struct DiagnoseCommand {
    SceneOptions scene;
    std::string out, device, library;
    std::vector<std::string> experiments;
    DiagnoseOptions options;
    SharingOptions sharing;
};

void fill_in(DiagnoseCommand& command) {
    DiagnoseOptions& options = command.options;
    options.folder = command.out;
    if (!command.library.empty()) options.library = command.library;
    options.program = version_text;
    options.stop_wanted = Interrupt::wanted;
}

void warn_of_odd_data(const Experiment& experiment) {
    const auto odd = check_experiment(experiment).of(Severity::odd);
    if (!odd.empty())
        spdlog::warn("{} has suspicious data: {}{}; `mcdem experiment check` lists them", experiment.name,
                     odd.front(), odd.size() > 1 ? fmt::format("; and {} more", odd.size() - 1) : "");
}

Diagnosis diagnose(const DiagnoseCommand& command, const Scene& scene,
                   const std::vector<Experiment>& experiments) {
    Device device(command.device);
    std::vector<std::string> names;
    for (const Experiment& experiment : experiments) names.push_back(experiment.name);
    spdlog::info("{} against {} on {}", scene.name, fmt::join(names, ", "), device.info().name);
    std::ranges::for_each(experiments, warn_of_odd_data);
    const Interrupt interrupt;
    StageProgress stages;
    DiagnoseOptions options = command.options;
    options.on_progress = [&](const std::string& stage, double fraction) { stages.show(stage, fraction); };
    options.on_note = [](const std::string& note) { spdlog::warn("{}", note); };
    return diagnose_experiment(device, scene, experiments, options);
}

int run_alone(const DiagnoseCommand& command, const Scene& scene,
              const std::vector<Experiment>& experiments) {
    const std::filesystem::path folder = command.out;
    const FolderLock lock = open_output_folder(folder);
    if (!command.library.empty()) make_folder_of(command.library);
    expect_replaceable(folder / "diagnosis.json", FileKind::diagnosis);
    expect_replaceable(folder / "diagnosis.html", FileKind::page);
    expect_replaceable_figures(folder, {"where", "which", "how_far"});
    const Diagnosis diagnosis = diagnose(command, scene, experiments);
    replace_own(folder / "diagnosis.json", FileKind::diagnosis, diagnosis_json(diagnosis));
    present("present_diagnosis", {folder.string(), "page", "figures"});
    return exit_done;
}

int run(DiagnoseCommand& command) {
    const Scene scene = command.scene.read();
    const std::vector<Experiment> experiments =
        read_experiments({command.experiments.begin(), command.experiments.end()}, "--experiment");
    fill_in(command);
    if (!is_shared(command.sharing)) return run_alone(command, scene, experiments);
    SharedWork work;
    work.out = command.out;
    work.begin = [&](std::size_t) {
        expect_no_experiment(command.out);
        make_result_folder(command.out);
        return library_parts(scene, experiments, command.options);
    };
    work.report = [&] { return run_alone(command, scene, experiments); };
    return share(work, command.sharing, command.device);
}

}  // namespace

void add_diagnose(CLI::App& app, int& exit_code) {
    auto* sub = app.add_subcommand("diagnose",
                                   "Find where a simulation and an experiment differ, and which effect is "
                                   "consistent with the difference");
    auto command = std::make_shared<DiagnoseCommand>();
    add_scene_options(*sub, command->scene);
    sub->add_option("--experiment", command->experiments,
                    "Experiment folder; may be repeated to diagnose several packings together")
        ->required()
        ->allow_extra_args(false)
        ->type_name("DIR");
    sub->add_option("--out", command->out, "Folder for the verdict, the page and the simulations")
        ->required()
        ->type_name("DIR");
    sub->add_option("--candidates", command->options.candidates, "Candidate effects; default: all")
        ->delimiter(',')
        ->type_name("A,B,..");
    sub->add_option("--replicates", command->options.replicates,
                    "Number of runs of the unchanged scene; their scatter is the noise floor")
        ->check(CLI::Range(8, 10000));
    sub->add_option("--pairs", command->options.pairs,
                    "Number of runs of each effect at each of its two amplitudes; at most --replicates")
        ->check(CLI::Range(2, 10000));
    sub->add_option("--confirmations", command->options.confirmations,
                    "Number of runs that confirm each proposed effect at its fitted amplitude; 0: none")
        ->check(CLI::Range(0, 10000));
    sub->add_option(
           "--refine", command->options.refine,
           "If the scene is not converged: largest factor by which plate.speed, grains.density or "
           "numerics.time_step is lowered before the diagnosis is repeated (runs take up to that much "
           "longer); 1: never, and pauses of the experiment's plate are not simulated")
        ->check(CLI::Range(1.0, 64.0));
    sub->add_option("--seed", command->options.seed, "Seed of all random numbers");
    sub->add_option("--library", command->library,
                    "File with the simulated changes by each effect, for use with further experiments; read "
                    "if it exists, otherwise computed and written")
        ->type_name("FILE");
    add_sharing_options(*sub, command->sharing, command->device);
    sub->footer(
        "The scene describes the simulation; box, plate and scans are taken from the experiment. Prints the "
        "verdict in\n"
        "six lines, after one with stated parameters to check first if there are any, and writes\n"
        "diagnosis.json, diagnosis.html and figures to DIR. Simulations are kept in\n"
        "DIR/simulations: nothing is computed twice, and the same command continues an interrupted "
        "diagnosis.\n"
        "Many devices or nodes can compute the simulations of the library in parts; --merge then does the "
        "rest of the\n"
        "diagnosis (`mcdem distribute diagnose ..` does both).\n"
        "Several packings of one experiment (--experiment A --experiment B) get one verdict and one "
        "amplitude, and a\n"
        "check of how well they agree. Each packing takes as long as a diagnosis of its own.\n"
        "Verdicts: no_gap, effect, group (effects that these data cannot tell apart), unknown_effect (none "
        "of the\n"
        "library), not_converged (the simulation's own numerics), calibration_suspect.\n"
        "The first entry under Next says what to do with the verdict.\n"
        "`mcdem experiment check DIR` reports beforehand what can be diagnosed from the data.\n"
        "Example, with a simulation as the experiment:\n"
        "  mcdem run scenes/small.toml --set protocol.scan_at_start=true --out out/begun\n"
        "  mcdem experiment from-run out/begun --replica mc_dem --out out/measured\n"
        "  mcdem diagnose scenes/small.toml --set contact.model=independent --experiment out/measured --out "
        "out/diagnosis");
    sub->callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace mcdem::cli
