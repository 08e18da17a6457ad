#include <fmt/format.h>

#include "cli/run/results.h"
#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "cli/shell/text_table.h"
#include "core/errors.h"
#include "core/output_file.h"
#include "core/version.h"
#include "ensemble/calibrate_scene.h"
#include "io/result_folder.h"

namespace mcdem::inline cli {
namespace {

struct CalibrateCommand {
    SceneOptions scene;
    ReferenceOptions reference;
    std::string out, device;
    CalibrateOptions options;
};

/// "0.430 ± 0.012"; without the error if it is unknown. More decimals if fewer than two significant digits
/// would be left, of the value or of a larger error.
std::string with_error(const Estimate& estimate, int decimals) {
    const bool has_error = std::isfinite(estimate.standard_error);
    const double size = std::max(std::abs(estimate.value), has_error ? estimate.standard_error : 0);
    if (size > 0) decimals = std::max(decimals, 1 - static_cast<int>(std::floor(std::log10(size))));
    const std::string value = fmt::format("{:.{}f}", estimate.value, decimals);
    return has_error ? fmt::format("{} ± {:.{}f}", value, estimate.standard_error, decimals) : value;
}

void print_calibration(const SceneCalibration& result) {
    TextTable table;
    const bool modulus = result.of_modulus();
    const double unit = modulus ? 1e-3 * result.unit() : 1;  // kPa
    table.columns = {{"round"}, {modulus ? "E [kPa]" : "gamma"}, {"top force [N]"}};
    for (std::size_t k = 0; k < result.found.rounds.size(); ++k) {
        const auto& round = result.found.rounds[k];
        for (std::size_t i = 0; i < round.gamma.size(); ++i)
            table.rows.push_back(
                {std::to_string(k + 1), fmt::format("{:.4f}", unit * round.gamma[i]),
                 std::isfinite(round.top_force[i]) ? with_error({round.top_force[i]}, 3) : "runs away"});
    }
    print_out("{}\n", to_text(table, TableFormat::terminal));
    print_out("target: {} N at {:.2f} mm; {} replica{} for each value\n", with_error(result.target, 3),
              result.displacement * 1e3, result.replicas, result.replicas == 1 ? "" : "s");
    print_out("{} = {}{}{}\n", modulus ? "E" : "gamma",
              with_error({unit * result.found.gamma, unit * result.standard_error(), result.replicas}, 4),
              modulus ? " kPa" : "",
              result.found.converged ? "" : " (tolerance not reached: raise --rounds, or use more replicas)");
    if (!result.knows_scatter())
        print_out(
            "the error leaves out the scatter between packings, because {} a single packing; this is correct "
            "only if both are the same packing\n",
            std::isfinite(result.simulated.standard_error) ? "the reference has"
            : std::isfinite(result.target.standard_error)  ? "the scene has"
                                                           : "scene and reference each have");
}

void calibrate(CalibrateCommand& command) {
    const auto reference = load_reference(command.reference, ReadWhat::observables);
    const Scene scene = command.scene.read();
    const auto file = std::filesystem::path(command.out) / "calibration.json";
    std::optional<FolderLock> lock;
    if (!command.out.empty()) {
        lock.emplace(open_output_folder(command.out));
        expect_replaceable(file, FileKind::calibration);
    }
    Device device(command.device);
    SceneCalibration result;
    {
        Progress progress(stderr, progress_style(stderr));
        const int rounds = command.options.search.rounds;
        command.options.on_progress = [&](int round, double fraction) {
            progress.show((round + fraction) / rounds);
        };
        command.options.on_note = [&](const std::string& note) { spdlog::warn("{}", note); };
        result = calibrate_scene(device, scene, reference.setting.replicas, command.options);
    }
    print_calibration(result);
    if (command.out.empty()) return;
    replace_own(
        file, FileKind::calibration,
        calibration_json(result, command.options.model, scene, reference.setting.label, version_text));
    print_out("wrote {}\n", file.string());
}

void add_search_options(CLI::App& sub, CalibrateOptions& options) {
    sub.add_option("--low", options.bracket.low,
                   "Lower end of the search: gamma, or E divided by the scene's E");
    sub.add_option("--high", options.bracket.high,
                   "Upper end of the search: gamma, or E divided by the scene's E");
    sub.add_option("--tolerance", options.search.tolerance,
                   "Stop at this standard error of gamma, or of E divided by the scene's E");
    sub.add_option("--batch", options.search.batch,
                   "Number of values that are simulated together in one round");
    sub.add_option("--rounds", options.search.rounds, "Maximum number of rounds");
}

}  // namespace

void add_calibrate(CLI::App& app, int&) {
    auto* sub = app.add_subcommand(
        "calibrate", "Fit gamma of MC-DEM, or E of another model, to the top force of an experiment");
    auto command = std::make_shared<CalibrateCommand>();
    add_scene_options(*sub, command->scene);
    add_reference_options(
        *sub, command->reference, "--experiment",
        "Experiment folder or run whose mean top force at maximum compression is the target");
    sub->get_option("--experiment")->required();
    sub->add_option_function<std::string>(
           "--model",
           [command](const std::string& word) { command->options.model = calibrated_model(word, "--model"); },
           "mc_dem: fit gamma; any other contact model: fit Young's modulus of the grains")
        ->type_name("MODEL")
        ->default_str("mc_dem");
    sub->add_option("--out", command->out, "Folder for calibration.json")->type_name("DIR");
    add_device_option(*sub, command->device);
    add_search_options(*sub, command->options);
    sub->footer(
        "The scene gives packings, materials and protocol; its contact.model and contact.gamma are not "
        "used.\n"
        "More packings (batch.replicas) reduce the error: single runs scatter by 1 to 3 %.\n"
        "Examples (DIR: your experiment folder):\n"
        "  mcdem calibrate scenes/compression.toml --experiment DIR --discard 5 --out out/gamma\n"
        "  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --rounds 2\n"
        "  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --model "
        "hyperelastic_sphere");
    sub->callback([command] { calibrate(*command); });
}

}  // namespace mcdem::cli
