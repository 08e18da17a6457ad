// Scenes from TOML. scenes/README.md documents every key.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// Reads a scene, applies overrides (`key=value`, the value as TOML or a bare word), checks it and makes all
/// replicas. Throws InputError with all problems as `file:line: key must be .., got ..`; for overrides `--set
/// key: ..`. `packings` reads packing files, now and when the packings are made.
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                 const PackingReader& packings = read_packing);

/// The same from text. `source_name` is used in messages; the packing file is relative to its folder.
Scene parse_scene(std::string_view toml_text, std::string source_name,
                  const std::vector<std::string>& overrides = {},
                  const PackingReader& packings = read_packing);

}  // namespace mcdem::scene
