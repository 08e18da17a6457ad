#include <fmt/format.h>

#include "cli/run/figures.h"
#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "core/output_file.h"
#include "core/version.h"
#include "diagnose/convergence_json.h"
#include "ensemble/converge_scene.h"
#include "io/result_folder.h"

namespace mcdem::inline cli {
namespace {

struct ConvergeCommand {
    SceneOptions scene;
    std::string out, device;
    ConvergeOptions options;
};

Convergence converge(ConvergeCommand& command, const Scene& scene) {
    Device device(command.device);
    spdlog::info("{} on {}", scene.name, device.info().name);
    if (scene.replicas.size() > 1)
        spdlog::warn("the scene has {} replicas; the first one is looked at: {}", scene.replicas.size(),
                     scene.replicas.front().label);
    const Interrupt interrupt;
    StageProgress stages;
    command.options.program = version_text;
    command.options.folder = command.out;
    command.options.stop_wanted = Interrupt::wanted;
    command.options.on_progress = [&](const std::string& cause, double fraction) {
        stages.show(cause, fraction);
    };
    return converge_scene(device, scene, command.options);
}

void run(ConvergeCommand& command) {
    const Scene scene = command.scene.read();
    const std::filesystem::path folder = command.out;
    const FolderLock lock = open_output_folder(folder);
    expect_replaceable(folder / "convergence.json", FileKind::convergence);
    expect_replaceable_figures(folder, {"convergence"});
    const Convergence convergence = converge(command, scene);
    replace_own(folder / "convergence.json", FileKind::convergence, convergence_json(convergence));
    present("present_convergence", {folder.string()});
}

}  // namespace

void add_converge(CLI::App& app, int&) {
    auto* sub = app.add_subcommand(
        "converge", "Measure how plate speed, inertia, time step and settling change a scene's results");
    auto command = std::make_shared<ConvergeCommand>();
    add_scene_options(*sub, command->scene);
    sub->add_option("--out", command->out, "Folder for the table, the figure and the simulations")
        ->required()
        ->type_name("DIR");
    sub->add_option("--replicas", command->options.replicas,
                    "Number of jittered copies of the packing; comparisons are paired")
        ->check(CLI::Range(8, 10000));
    sub->add_option("--jitter", command->options.jitter,
                    "Standard deviation of the jitter [m]; 0: half a per cent of a diameter")
        ->check(CLI::Range(0.0, 1.0));
    sub->add_option("--force-limit", command->options.limits.force,
                    "Largest relative error allowed in forces")
        ->check(above_zero());
    sub->add_option("--sd-limit", command->options.limits.deviations,
                    "Largest error allowed in other observables, in standard deviations over the copies")
        ->check(above_zero());
    sub->add_option("--seed", command->options.seed, "Seed of the jitter");
    add_device_option(*sub, command->device);
    sub->footer(
        "Runs the scene as it stands and with finer numerics, all from the same jittered packings: the plate "
        "2, 4\n"
        "and 8 times slower (protocol.rate_tolerance is lowered with plate.speed), a quarter of the density, "
        "half\n"
        "the time step, wider neighbour lists, double precision if the scene has single precision, and, if "
        "the\n"
        "plate stops at scans, stricter settling and no stops. Errors are extrapolated to the limit. Reports "
        "for\n"
        "every observable of the diagnosis the error with its standard error, its cause, the setting that\n"
        "brings it below the limit, and how much longer runs take. If jittered copies hardly differ, every\n"
        "replica is a new random packing. Simulations are kept in DIR/simulations: the same command "
        "continues\n"
        "an interrupted one.\n"
        "Example:\n"
        "  mcdem converge scenes/small.toml --set contact.model=mc_dem --out out/converge --replicas 8");
    sub->callback([command] { run(*command); });
}

}  // namespace mcdem::cli
