// The packing of a recorded run as initial packing of a scene.
#pragma once
#include <filesystem>
#include <optional>

#include "core/packing.h"

namespace mcdem::inline io {

/// From a run of one replica: frame `frame`, or the first one with positions. Throws InputError.
Packing packing_of_run(const std::filesystem::path& file, std::optional<long> frame);

}  // namespace mcdem::io
