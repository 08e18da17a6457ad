#include "cli/run/scene_options.h"

#include <fmt/format.h>

#include "cli/shell/messages.h"
#include "io/run_packing.h"
#include "scene/read/read_scene.h"
#include "scene/read/scene_warnings.h"

namespace mcdem::inline cli {

Scene SceneOptions::read() const {
    Scene scene = read_scene(file, overrides, read_packing_or_run);
    for (const std::string& warning : scene_warnings(scene)) spdlog::warn("{}", warning);
    return scene;
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
    command.add_option("SCENE", options.file, "Scene file (TOML; scenes/README.md explains every key)")
        ->required();
    command.add_option("--set", options.overrides, "Override a scene key; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

void add_device_option(CLI::App& command, std::string& choice) {
    command
        .add_option("--device", choice,
                    "Number or part of the name of a device, as listed by `mcdem devices`")
        ->type_name("DEVICE");
}

std::string size_text(const Scene& scene) {
    const std::size_t replicas = scene.replicas.size();
    std::string text = fmt::format("{} replica{}", replicas, replicas == 1 ? "" : "s");
    const auto* drawn = std::get_if<GeneratedPacking>(&scene.replicas.front().packing.source);
    for (const auto& replica : scene.replicas) {
        const auto* other = std::get_if<GeneratedPacking>(&replica.packing.source);
        if (!other || !drawn || other->count != drawn->count) return text;
    }
    return text + fmt::format(" of {} grain{}", drawn->count, drawn->count == 1 ? "" : "s");
}

}  // namespace mcdem::cli
