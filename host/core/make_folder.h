#pragma once
#include <filesystem>

namespace mcdem::inline core {

/// Creates a folder and its parents, if necessary. Throws RunError with the path if that fails or the folder
/// is not writable. Called before long work, not after it.
void make_folder(const std::filesystem::path& folder);

/// Throws RunError unless the folder exists and is writable.
void expect_writable(const std::filesystem::path& folder);

}  // namespace mcdem::core
