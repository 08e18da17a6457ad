#include "challenge/make.h"
#include "cli/experiment/experiment.h"
#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"

namespace mcdem::inline cli {
namespace {

struct MakeCommand {
    SceneOptions scene;
    std::string out, truth, device;
    ChallengeOptions options;
};

void make(MakeCommand& command) {
    const Scene scene = command.scene.read();
    ChallengeOptions& options = command.options;
    options.folder = command.out;
    options.truth =
        command.truth.empty() ? options.folder / "truth.json" : std::filesystem::path(command.truth);
    Device device(command.device);
    const Interrupt interrupt;
    Progress progress(stderr, progress_style(stderr));
    options.on_progress = [&](double fraction) { progress.show(fraction); };
    options.stop_wanted = Interrupt::wanted;
    const std::string seal = make_challenge(device, scene, options);
    progress.clear();
    print_out("{}: the challenge is made\ntruth: {}\nits SHA-256: {}\n", command.out, options.truth.string(),
              seal);
}

void add_sizes(CLI::App& sub, ChallengeSize& size) {
    const auto add = [&](const char* option, int& value, const char* help) {
        sub.add_option(option, value, help)->type_name("N");
    };
    add("--none", size.none, "Number of experiments without an effect");
    add("--per-effect", size.per_effect, "Number of experiments with each effect of the library");
    add("--pairs", size.pairs, "Number of experiments with two effects of the library");
    add("--unknown", size.unknown, "Number of experiments with an effect that the library does not have");
    add("--outside", size.outside_prior,
        "Number of experiments with modulus or strain zero far outside their uncertainty");
    add("--packings", size.packings, "Number of different packings; even");
}

}  // namespace

void add_challenge_make(CLI::App& challenge, int&) {
    auto* sub = challenge.add_subcommand(
        "make", "Simulate experiments with hidden effects, and write the truth to a separate file");
    auto command = std::make_shared<MakeCommand>();
    add_scene_options(*sub, command->scene);
    sub->add_option("--out", command->out, "Folder for the challenge")->required()->type_name("DIR");
    sub->add_option("--truth", command->truth, "File for the truth; default: DIR/truth.json")
        ->type_name("FILE");
    sub->add_option("--seed", command->options.seed,
                    "Seed of all draws; default: drawn at random and not shown")
        ->type_name("S");
    sub->add_option("--effects", command->options.effects, "Effects to hide; default: a dozen of all kinds")
        ->delimiter(',')
        ->type_name("NAME,..");
    add_sizes(*sub, command->options.size);
    command->options.measurement = {1e-4, 2e-5, 0.05, 0.004};
    add_measurement_options(*sub, command->options.measurement);
    add_device_option(*sub, command->device);
    sub->footer(
        "The same command continues where an interrupted one stopped.\n"
        "Example:\n"
        "  mcdem challenge make scenes/challenge.toml --out out/challenge --truth out/truth.json");
    sub->callback([command] { make(*command); });
}

}  // namespace mcdem::cli
