// Common options of all commands that read a scene.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline cli {

struct SceneOptions {
    std::string file;
    std::vector<std::string> overrides;
    Scene read() const;
};
void add_scene_options(CLI::App& command, SceneOptions& options);

void add_device_option(CLI::App& command, std::string& choice);

/// "6 replicas of 514 grains".
std::string size_text(const Scene& scene);

}  // namespace mcdem::cli
