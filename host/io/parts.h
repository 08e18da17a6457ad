// The results of a run that was computed in parts, put together into the file that one program would have
// written.
#pragma once
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace mcdem::inline io {

/// Where the parts of the run in `folder` lie until they are merged.
std::filesystem::path parts_folder(const std::filesystem::path& folder);

/// A part that cannot be read to its end, and must be made again.
struct DamagedPart : std::runtime_error {
    DamagedPart(std::size_t number, const std::string& why) : std::runtime_error(why), part(number) {}
    std::size_t part;
};

/// Writes the replicas of all parts, one part after the other, into `merged`: to the last bit what one
/// program writes for the whole scene. Holds one replica in memory. Throws DamagedPart, and RunError where
/// `merged` cannot be written.
void merge_parts(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& merged);

}  // namespace mcdem::io
