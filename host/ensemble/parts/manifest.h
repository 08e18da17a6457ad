// What the work in a folder was begun with: written once, and checked by every later command.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "cl/device.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// Name of a thing that must stay the same, and what stands for it.
using Manifest = std::map<std::string, std::string>;

/// Program, kernels, scene with its overrides, and packing files: what decides the bits of a run, but for
/// the device.
Manifest manifest_of(const Scene& scene, const std::string& program);

/// The device with its build of the kernels, which decides the last bits.
Manifest manifest_of(const Device& device, const Scene& scene);

/// `<folder>/manifest.json` and `<folder>/device.json`. The second is written by the first process that
/// computes: who begins the work may have no such device.
std::filesystem::path manifest_file(const std::filesystem::path& folder);
std::filesystem::path device_file(const std::filesystem::path& folder);

/// None where there is no such file, or one that is damaged.
std::optional<Manifest> read_manifest(const std::filesystem::path& file);

/// Writes `wanted` where there is no manifest, or a damaged one. Returns what the file holds. Throws
/// InputError that names every entry of another value; that of the name `chosen` may be another one.
Manifest keep_manifest(const std::filesystem::path& file, const Manifest& wanted,
                       const std::string& chosen = "");

}  // namespace mcdem::ensemble
