// What all programs that share work must have in common, or their results would not fit together.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "cl/device.h"
#include "scene/scene.h"

namespace mcdem {

/// Name of a thing that must be the same, and what stands for it.
using Common = std::map<std::string, std::string>;

/// Program, kind of device, scene with its overrides, and the packing files: what decides the bits of a run.
Common common_of(const Device& device, const Scene& scene, const std::string& program);

/// Writes `common` and `chosen` into the file where there is none. Returns `chosen` as the first program
/// wrote it. Throws InputError where that program had another value of anything in `common`, saying which.
Common agree(const std::filesystem::path& file, const Common& common, const Common& chosen);

/// Whether there is a file that says nothing: what a power cut may leave of one.
bool is_damaged_agreement(const std::filesystem::path& file);

/// `chosen` as it stands in the file. Throws InputError where the file is missing or damaged.
Common read_chosen(const std::filesystem::path& file);

}  // namespace mcdem
