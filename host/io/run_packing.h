// A recorded run's packing, as scenes may start from it.
#pragma once
#include <filesystem>
#include <optional>

#include "core/packing.h"

namespace mcdem::inline io {

/// Of a run of one replica: frame `frame`, or the first with positions. Throws InputError.
Packing packing_of_run(const std::filesystem::path& file, std::optional<long> frame);

}  // namespace mcdem::io
