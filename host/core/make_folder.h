#pragma once
#include <filesystem>

namespace mcdem {

/// With the folders above it; nothing where it is there. Throws RunError that names it where it cannot be made.
void make_folder(const std::filesystem::path& folder);

}  // namespace mcdem
