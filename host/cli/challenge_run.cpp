// mcdem challenge run
#include "ensemble/challenge_run.h"

#include <fmt/format.h>

#include "cli/challenge.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "cli/scene_options.h"
#include "cli/version.h"
#include "core/atomic_file.h"
#include "report/diagnosis_json.h"
#include "scene/read_scene.h"

namespace mcdem {
namespace {

struct RunChallengeCommand {
    std::string challenge, scene, library, out, device;
    std::vector<std::string> overrides;
    ChallengeRunOptions options;
};

void run(RunChallengeCommand& command, int& exit_code) {
    const Scene scene = read_scene(command.scene, command.overrides);
    ChallengeRunOptions& options = command.options;
    options.challenge = command.challenge;
    options.out = command.out;
    options.library.file = command.library;
    options.program = version_text;
    options.keep = [](const std::filesystem::path& file, const Diagnosis& diagnosis) {
        replace_file(file, diagnosis_json(diagnosis));
    };
    Device device(command.device);
    const Interrupt interrupt;
    Progress progress(stderr, progress_style(stderr));
    options.on_progress = [&](double fraction) { progress.show(fraction); };
    options.on_problem = [&](const std::string& message) {
        progress.clear();
        spdlog::warn("{}", message);
    };
    options.stop_wanted = Interrupt::wanted;
    try {
        run_challenge(device, scene, options);
        progress.clear();
        fmt::print("{}: all cases are diagnosed\n", command.out);
    } catch (const Interrupted& interrupted) {
        progress.clear();
        spdlog::warn("{}", interrupted.what());
        exit_code = exit_interrupted;
    }
}

void add_numbers(CLI::App& sub, ChallengeRunOptions& options) {
    const auto add = [&](const char* option, int& value, const char* help) {
        sub.add_option(option, value, help)->capture_default_str()->type_name("N");
    };
    add("--replicates", options.replicates, "Simulations of each experiment as it is");
    add("--confirmations", options.confirmations, "Simulations of each diagnosis with its cause");
    add("--library-packings", options.library.packings, "Packings of a new library");
    add("--library-replicates", options.library.replicates, "Its simulations a packing");
    add("--library-pairs", options.library.pairs, "Of them, those repeated with every effect");
    sub.add_option("--candidates", options.library.candidates, "Effects of a new library, instead of all")
        ->delimiter(',')
        ->type_name("NAME,..");
    sub.add_option("--seed", options.seed, "Of everything that is random in the diagnoses")
        ->capture_default_str();
}

}  // namespace

void add_challenge_run(CLI::App& challenge, int& exit_code) {
    auto* sub =
        challenge.add_subcommand("run", "Diagnose every reality of a challenge from its experiment alone");
    auto command = std::make_shared<RunChallengeCommand>();
    sub->add_option("CHALLENGE", command->challenge, "Folder of the challenge")->required();
    sub->add_option("--scene", command->scene, "Scene that the challenge was made with")->required();
    sub->add_option("--set", command->overrides, "Overrides a key of the scene; may come several times")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    sub->add_option("--library", command->library, "Signature library; made where the file is missing")
        ->required()
        ->type_name("FILE");
    sub->add_option("--out", command->out, "Folder for the diagnoses")->required()->type_name("DIR");
    add_numbers(*sub, command->options);
    add_device_option(*sub, command->device);
    sub->footer("The same command goes on where an interrupted one stopped.");
    sub->callback([command, &exit_code] { run(*command, exit_code); });
}

}  // namespace mcdem
