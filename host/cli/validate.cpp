// mcdem validate
#include <fmt/format.h>

#include <optional>

#include "cli/commands.h"
#include "cli/scene_options.h"
#include "cli/standard_streams.h"
#include "core/errors.h"
#include "sim/batch_limits.h"

namespace mcdem {
namespace {

constexpr std::size_t most_labels = 12;

/// The device that a run would use, where there is one: a scene can be checked without.
std::optional<Device> chosen_device(const std::string& choice) {
    try {
        return Device(choice);
    } catch (const RunError&) {
        return std::nullopt;
    }
}

/// `device`: checked whether it can hold the run, where there is one.
void print_memory(const Scene& scene, const std::optional<Device>& device) {
    const FieldMemory memory =
        memory_needed(scene.precision, scene.slots, scene.replicas, packing_sizes(scene.replicas));
    print_out("needs at most {} of memory on the device", memory_text(memory.all));
    if (device) print_out(", {} has {}", device->info().name, memory_text(device->info().memory));
    print_out("\n");
}

void print_scene(const SceneOptions& options, const std::string& choice) {
    const Scene scene = options.read();
    const auto device = chosen_device(choice);
    if (device) expect_runnable(*device, scene);
    const Protocol& protocol = scene.replicas.front().protocol;
    print_out("{}: good\n", options.file);
    print_out("{}, {} precision; {} cycle{} with {} scans a stroke\n", size_text(scene),
               name(scene.precision), protocol.cycles, protocol.cycles == 1 ? "" : "s",
               protocol.scans_per_stroke);
    print_memory(scene, device);
    std::size_t shown = 0;
    for (const auto& replica : scene.replicas) {
        if (++shown > most_labels) {
            print_out("  .. and {} more\n", scene.replicas.size() - most_labels);
            break;
        }
        print_out("  {}\n", replica.label);
    }
}

}  // namespace

void add_validate(CLI::App& app, int&) {
    auto* command = app.add_subcommand("validate", "Check a scene and say what it would run");
    auto options = std::make_shared<SceneOptions>();
    auto choice = std::make_shared<std::string>();
    add_scene_options(*command, *options);
    add_device_option(*command, *choice);
    command->footer(
        "Checks the scene, and whether the device has the memory for it.\n"
        "All problems are listed, each as `file:line: key must be .., got ..`; then the exit code is 2.\n"
        "Examples:\n"
        "  mcdem validate scenes/compression.toml\n"
        "  mcdem validate scenes/small.toml --set grains.friction=0.1 --set contact.model=elastic_sphere");
    command->callback([options, choice] { print_scene(*options, *choice); });
}

}  // namespace mcdem
