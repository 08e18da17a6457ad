#pragma once
#include <filesystem>

namespace mcdem::inline core {

/// A folder to write into, with the folders above it; there may be one already. Throws RunError that names it
/// where it cannot be made or written to: asked before long work, not after.
void make_folder(const std::filesystem::path& folder);

/// The folder of a file to be written, likewise.
void make_folder_of(const std::filesystem::path& file);

/// The second half: it must be there.
void expect_writable(const std::filesystem::path& folder);

}  // namespace mcdem::core
