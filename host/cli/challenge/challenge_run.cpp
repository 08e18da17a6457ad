#include "challenge/run.h"
#include "cli/parts/sharing.h"
#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "core/atomic_file.h"
#include "core/version.h"
#include "diagnose/decide/diagnosis_json.h"

namespace mcdem::inline cli {
namespace {

struct RunChallengeCommand {
    SceneOptions scene;
    std::string challenge, library, out, device;
    ChallengeRunOptions options;
    SharingOptions sharing;
};

void fill_in(RunChallengeCommand& command) {
    ChallengeRunOptions& options = command.options;
    options.challenge = command.challenge;
    options.out = command.out;
    options.library.file = command.library;
    options.program = version_text;
    options.keep = [](const std::filesystem::path& file, const Diagnosis& diagnosis) {
        replace_file(file, diagnosis_json(diagnosis));
    };
    options.on_problem = [](const std::string& message) { spdlog::warn("{}", message); };
    options.stop_wanted = Interrupt::wanted;
}

int report(const RunChallengeCommand& command) {
    print_out("{}: all cases are diagnosed\n", command.out);
    return exit_done;
}

int run_alone(RunChallengeCommand& command, const Scene& scene) {
    Device device(command.device);
    const Interrupt interrupt;
    Progress progress(stderr, progress_style(stderr));
    command.options.on_progress = [&](double fraction) { progress.show(fraction); };
    command.options.on_problem = [&](const std::string& message) {
        progress.clear();
        spdlog::warn("{}", message);
    };
    run_challenge(device, scene, command.options);
    progress.clear();
    return report(command);
}

SharedWork shared_work(const RunChallengeCommand& command, const Scene& scene) {
    SharedWork work;
    work.out = command.out;
    work.begin = [&](std::size_t) { return challenge_parts(scene, command.options); };
    work.report = [&] { return report(command); };
    return work;
}

int run(RunChallengeCommand& command) {
    const Scene scene = command.scene.read();
    fill_in(command);
    if (is_shared(command.sharing))
        return share(shared_work(command, scene), command.sharing, command.device);
    return run_alone(command, scene);
}

void add_numbers(CLI::App& sub, ChallengeRunOptions& options) {
    const auto add = [&](const char* option, int& value, const char* help) {
        sub.add_option(option, value, help)->type_name("N");
    };
    add("--replicates", options.replicates,
        "Number of simulations of each experiment with the unchanged scene");
    add("--confirmations", options.confirmations, "Number of confirming simulations of each diagnosis");
    add("--library-packings", options.library.packings, "Number of packings of a new library");
    add("--library-replicates", options.library.replicates, "Simulations per packing of a new library");
    add("--library-pairs", options.library.pairs,
        "Simulations of a new library that are repeated with every effect");
    sub.add_option("--candidates", options.library.candidates, "Effects of a new library; default: all")
        ->delimiter(',')
        ->type_name("NAME,..");
    sub.add_option("--seed", options.seed, "Seed of all random numbers of the diagnoses");
}

}  // namespace

void add_challenge_run(CLI::App& challenge, int& exit_code) {
    auto* sub = challenge.add_subcommand("run", "Diagnose every experiment of a challenge");
    auto command = std::make_shared<RunChallengeCommand>();
    sub->add_option("CHALLENGE", command->challenge, "Folder of the challenge")->required();
    add_scene_options(*sub, command->scene, "--scene", "Scene that the challenge was made with");
    sub->add_option(
           "--library", command->library,
           "File with the simulated changes by each effect; computed and written if it does not exist")
        ->required()
        ->type_name("FILE");
    sub->add_option("--out", command->out, "Folder for the diagnoses")->required()->type_name("DIR");
    add_numbers(*sub, command->options);
    add_sharing_options(*sub, command->sharing, command->device);
    sub->footer(
        "The same command continues where an interrupted one stopped.\n"
        "Many devices or nodes compute it in parts (`mcdem distribute challenge run ..`): the simulations of "
        "the "
        "library,\n"
        "then the cases.\n"
        "Example:\n"
        "  mcdem challenge run out/challenge --scene scenes/challenge.toml --library out/library.json --out "
        "out/diagnoses");
    sub->callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace mcdem::cli
