// A recorded frame of a run as a packing.
#pragma once
#include <filesystem>
#include <optional>

#include "scene/packing/file_packing.h"

namespace mcdem::inline io {

/// Frame `frame` of a run with one replica, by default the first with positions; its box is the container of
/// the run in that frame. Throws InputError.
FilePacking recorded_packing(const std::filesystem::path& file, std::optional<long> frame);

/// A packing of a run.h5 or of a file that read_packing knows.
FilePacking read_packing_or_run(const std::filesystem::path& file, std::optional<long> frame);

}  // namespace mcdem::io
