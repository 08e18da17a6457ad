// What is at a path. A path that cannot be looked at (no permission, a failing disk or network file system)
// is an error and never "nothing there". The host asks the file system here alone; tests/floors_test.py
// checks this.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace mcdem::inline core {

enum class At { nothing, file, folder, link, other };

/// What is at the path, or where a link there leads: `nothing` also for a link to nothing, never `link`.
/// Throws RunError, with the path and the reason, if the system refuses to tell.
At look_at(const std::filesystem::path& path);

/// The same, but a link is a `link`, wherever it leads.
At look_at_itself(const std::filesystem::path& path);

// Each throws like look_at.
inline bool is_there(const std::filesystem::path& path) { return look_at(path) != At::nothing; }
inline bool is_file(const std::filesystem::path& path) { return look_at(path) == At::file; }
inline bool is_folder(const std::filesystem::path& path) { return look_at(path) == At::folder; }

/// Bytes of a file. Throws RunError, also if there is none.
std::uintmax_t size_of_file(const std::filesystem::path& file);

/// The paths of everything in a folder, in no order. Throws RunError, with the folder and the reason, unless
/// all of them can be listed.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

}  // namespace mcdem::core
