#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>

#include "cli/run/scene_options.h"
#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "core/container.h"
#include "core/errors.h"
#include "ensemble/make_packings.h"
#include "scene/packing/packing_state.h"
#include "scene/programme/legs.h"
#include "sim/batch_limits.h"
#include "sim/device_replica.h"
#include "sim/expected_run.h"
#include "sim/simulation.h"

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

/// Grain-steps per second on a device of this kind, from bench/README.md: the lower ones of its tables.
double usual_rate(const DeviceInfo& device, double grains) {
    constexpr double of_core = 4e6, of_gpu = 500e6, of_grain_on_gpu = 70e3;
    return device.gpu ? std::min(of_gpu, of_grain_on_gpu * grains)
                      : of_core * std::max(1, device.compute_units);
}

/// Grain-steps per second in the first seconds of the run.
double measured_rate(Device& device, const Scene& scene) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds enough{2};
    const Interrupt interrupt;
    Simulation simulation(device, scene, make_packings(scene, Interrupt::wanted));
    const auto advance = [&] {
        if (Interrupt::wanted()) throw Interrupted();
        return simulation.advance([](int, Scan) {}, [](int, const Failure&) {});
    };
    advance();  // compiles
    const long before = simulation.grain_steps();
    const auto start = Clock::now();
    while (Clock::now() - start < enough && advance()) {
    }
    return static_cast<double>(simulation.grain_steps() - before) /
           std::chrono::duration<double>(Clock::now() - start).count();
}

/// "about 3.2 to 18 N"
std::string range_text(const PressureRange& range, double factor, const char* unit) {
    if (range.low < 0.1 * range.high)
        return fmt::format("at most about {:.2g} {}", range.high * factor, unit);
    return fmt::format("about {:.2g} to {:.2g} {}", range.low * factor, range.high * factor, unit);
}

/// Where the packing ends below the plate, and what force the plate will find.
void print_packing_below_plate(const Replica& replica, const PackingScale& scale, const ExpectedRun& run) {
    const bool drawn = std::holds_alternative<GeneratedPacking>(replica.packing.source);
    print_out("the packing is {:.4g} m high{}; the plate starts at {:.4g} m", scale.top,
              drawn ? " when generated" : "", replica.plate.start);
    const double area = floor_area(replica.box);
    if (run.lowest < scale.top && run.at_lowest.high > 0)
        print_out(", and at {:.4g} m finds {} ({})", run.lowest, range_text(run.at_lowest, area, "N"),
                  range_text(run.at_lowest, 1, "Pa"));
    print_out("\n");
}

/// Steps of the run, and its duration on this device: measured if `measure`.
void print_steps(const Scene& scene, std::optional<Device>& device, bool measure) {
    constexpr double long_time = 7200;  // [s]
    double relax = 0, all = 0, grains = 0;
    const auto sizes = packing_sizes(scene.replicas);
    for (std::size_t r = 0; r < sizes.size(); ++r) {
        const Replica& replica = scene.replicas[r];
        const PackingScale scale = expected_scale(replica);
        const ExpectedRun run = expected_run(replica, scale, time_step(replica, sizes[r].smallest / 2));
        const auto count = static_cast<double>(scale.count);
        if (r == 0 && !is_cell(replica.box)) print_packing_below_plate(replica, scale, run);
        grains += count;
        relax += count * run.relax_steps;
        all += count * (run.relax_steps + run.programme_steps);
    }
    print_out("about {:.2g} grain-steps, of which at most {:.2g} of the relaxation", all, relax);
    if (device) {
        const double rate = measure ? measured_rate(*device, scene) : usual_rate(device->info(), grains);
        print_out("; {} with {:.3g} million per second ({})", duration_text(all / rate), rate * 1e-6,
                  measure ? "measured now" : "usual for such a device; --estimate measures it");
        if (all / rate > long_time)
            spdlog::warn(
                "the run may take {}: fewer grains or replicas, a shorter stroke, fewer cycles, or "
                "softer or larger grains need less",
                duration_text(all / rate));
    }
    print_out("\n");
}

void print_scene(const SceneOptions& options, const std::string& choice, bool measure) {
    const Scene scene = options.read();
    auto device = chosen_device(choice);
    if (measure && !device) throw no_device();
    if (device) expect_runnable(*device, scene);
    print_out("{}: valid scene\n", options.file);
    print_out("{}, {} precision; {}\n", size_text(scene), name(scene.precision),
              strokes_text(scene.replicas.front()));
    print_packings(scene);
    print_memory(scene, device);
    print_steps(scene, device, measure);
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
    auto measure = std::make_shared<bool>(false);
    add_scene_options(command, *options);
    add_device_option(command, *choice);
    command.add_flag("--estimate", *measure,
                     "Make the packings and run the first two seconds, to measure how long the run takes");
    command.footer(
        "Checks the scene, and whether it fits into the device's memory. Estimates the height of the "
        "packing,\n"
        "the force on the plate at its lowest position, and the duration of the run (scenes/README.md).\n"
        "All problems are listed as `file:line: key must be .., got ..`; the exit code is then 2.\n"
        "Examples:\n"
        "  mcdem validate scenes/compression.toml\n"
        "  mcdem validate scenes/small.toml --set grains.friction=0.1 --set contact.model=elastic_sphere");
    command.callback([options, choice, measure] { print_scene(*options, *choice, *measure); });
}

}  // namespace mcdem::cli
