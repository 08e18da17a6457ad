// mcdem validate
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/scene_options.h"

namespace mcdem {
namespace {

constexpr std::size_t most_labels = 12;

void print_scene(const SceneOptions& options) {
    const Scene scene = options.read();
    const Protocol& protocol = scene.replicas.front().protocol;
    fmt::print("{}: good\n", options.file);
    fmt::print("{}, {} precision; {} cycle{} with {} scans a stroke\n", size_text(scene),
               name(scene.precision), protocol.cycles, protocol.cycles == 1 ? "" : "s",
               protocol.scans_per_stroke);
    std::size_t shown = 0;
    for (const auto& replica : scene.replicas) {
        if (++shown > most_labels) {
            fmt::print("  .. and {} more\n", scene.replicas.size() - most_labels);
            break;
        }
        fmt::print("  {}\n", replica.label);
    }
}

}  // namespace

void add_validate(CLI::App& app, int&) {
    auto* command = app.add_subcommand("validate", "Check a scene and say what it would run");
    auto options = std::make_shared<SceneOptions>();
    add_scene_options(*command, *options);
    command->footer(
        "All problems are listed, each as `file:line: key must be .., got ..`; then the exit code is 2.\n"
        "Examples:\n"
        "  mcdem validate scenes/compression.toml\n"
        "  mcdem validate scenes/small.toml --set grains.friction=0.1 --set contact.model=elastic_sphere");
    command->callback([options] { print_scene(*options); });
}

}  // namespace mcdem
