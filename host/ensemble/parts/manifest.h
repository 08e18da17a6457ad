// Inputs of the work in a folder: written once, and checked by every later command.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "cl/device.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// Names and values of the inputs that must not change.
using Manifest = std::map<std::string, std::string>;

/// Program, kernels, scene with its overrides, and packing files: everything except the device that
/// determines the bits of a run.
Manifest manifest_of(const Scene& scene, const std::string& program);

/// The device with its build of the kernels, which determines the last bits.
Manifest manifest_of(const Device& device, const Scene& scene);

/// `<folder>/manifest.json` and `<folder>/device.json`. The second is written by the first process that
/// computes, because the process that starts the work may not have such a device.
std::filesystem::path manifest_file(const std::filesystem::path& folder);
std::filesystem::path device_file(const std::filesystem::path& folder);

/// None if the file does not exist or is damaged.
std::optional<Manifest> read_manifest(const std::filesystem::path& file);

/// Writes `wanted` if there is no manifest. Returns the content of the file. Throws InputError if it is
/// damaged, or with all entries that differ; the entry `chosen` may differ.
Manifest keep_manifest(const std::filesystem::path& file, const Manifest& wanted,
                       const std::string& chosen = "");

}  // namespace mcdem::ensemble
