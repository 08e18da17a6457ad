#include <fmt/format.h>

#include <optional>
#include <set>

#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/standard_streams.h"
#include "core/errors.h"
#include "scene/packing/packing_state.h"
#include "scene/programme/legs.h"
#include "sim/batch_limits.h"

namespace mcdem::inline cli {
namespace {

constexpr std::size_t max_labels = 12;

/// The device of a run, if there is one; a scene can be checked without a device.
std::optional<Device> chosen_device(const std::string& choice) {
    try {
        return Device(choice);
    } catch (const RunError&) {
        return std::nullopt;
    }
}

/// Checks whether `device`, if any, can hold the run.
void print_memory(const Scene& scene, const std::optional<Device>& device) {
    const FieldMemory memory =
        memory_needed(scene.precision, scene.slots, scene.replicas, packing_sizes(scene.replicas));
    print_out("needs at most {} of memory on the device", memory_text(memory.all));
    if (device) print_out(", {} has {}", device->info().name, memory_text(device->info().memory));
    print_out("\n");
}

void print_packings(const Scene& scene) {
    std::set<std::pair<std::string, std::optional<long>>> printed;
    for (const Replica& replica : scene.replicas) {
        const auto* file = std::get_if<PackingFile>(&replica.packing.source);
        if (!file || !printed.emplace(file->path, file->step).second) continue;
        const Packing packing = file->read();
        const PackingState state =
            packing_state(packing, replica.box, plate_face(replica, replica.plate.start));
        print_out("{}: {} grains, Z = {:.2f}, deepest overlap {:.3g} mm ({:.2g} % of a diameter)\n",
                  file->path, packing.size(), state.coordination_number, 1e3 * state.deepest_overlap,
                  100 * state.relative_overlap);
        if (!packing.tangential.empty() && mindlin_share(replica) > 0)
            print_out("{}: friction springs start with the tangential forces of its {} contacts\n",
                      file->path, packing.tangential.size());
    }
}

/// "2 cycles with 30 scans per stroke", or the size of a programme.
std::string strokes_text(const Replica& replica) {
    if (replica.programme.empty())
        return fmt::format("{} cycle{} with {} scans per stroke", replica.protocol.cycles,
                           replica.protocol.cycles == 1 ? "" : "s", replica.protocol.scans_per_stroke);
    return fmt::format("a programme of {} stages, {} moves and holds, {} scans", replica.programme.size(),
                       leg_count(replica.programme), scan_count(replica.programme));
}

void print_scene(const SceneOptions& options, const std::string& choice) {
    const Scene scene = options.read();
    const auto device = chosen_device(choice);
    if (device) expect_runnable(*device, scene);
    print_out("{}: valid scene\n", options.file);
    print_out("{}, {} precision; {}\n", size_text(scene), name(scene.precision),
              strokes_text(scene.replicas.front()));
    print_packings(scene);
    print_memory(scene, device);
    std::size_t shown = 0;
    for (const auto& replica : scene.replicas) {
        if (++shown > max_labels) {
            print_out("  .. and {} more\n", scene.replicas.size() - max_labels);
            break;
        }
        print_out("  {}\n", replica.label);
    }
}

}  // namespace

void add_validate(CLI::App& command, int&) {
    auto options = std::make_shared<SceneOptions>();
    auto choice = std::make_shared<std::string>();
    add_scene_options(command, *options);
    add_device_option(command, *choice);
    command.footer(
        "Checks the scene, and whether it fits into the device's memory.\n"
        "All problems are listed as `file:line: key must be .., got ..`; the exit code is then 2.\n"
        "Examples:\n"
        "  mcdem validate scenes/compression.toml\n"
        "  mcdem validate scenes/small.toml --set grains.friction=0.1 --set contact.model=elastic_sphere");
    command.callback([options, choice] { print_scene(*options, *choice); });
}

}  // namespace mcdem::cli
