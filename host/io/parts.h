// Merges the results of a distributed run into the file that a single process would have written.
#pragma once
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "core/stop.h"

namespace mcdem::inline io {

/// Folder of the parts of the run in `folder` until they are merged.
std::filesystem::path parts_folder(const std::filesystem::path& folder);

/// A part that cannot be read completely and must be computed again.
struct DamagedPart : std::runtime_error {
    DamagedPart(std::size_t number, const std::string& why) : std::runtime_error(why), part(number) {}
    std::size_t part;
};

/// Writes the replicas of all parts in order into `merged`; the file is bit-identical to that of a single
/// process. Holds one replica in memory. Throws Interrupted, and leaves no file, if `stop_wanted` becomes
/// true meanwhile; DamagedPart, and RunError if `merged` cannot be written.
void merge_parts(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& merged,
                 const StopWanted& stop_wanted = never_stop);

}  // namespace mcdem::io
