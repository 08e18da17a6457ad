// Files that are whole or not there: written beside their place, then put into it in one move.
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace mcdem {

/// Lets `write` fill `<file>.tmp`, forces it to the disk and moves it to `file`. A reader sees the old
/// file or the new one, even after a crash or power cut. When `write` throws, the old file stays.
void replace_file(const std::filesystem::path& file,
                  const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for a text that is at hand. Several programs may write one file at a time: the last one stays.
void replace_file(const std::filesystem::path& file, std::string_view text);

/// Puts the text into the file, whole, unless there is such a file: false where there is one, be it that
/// another program was quicker by a moment.
bool create_file(const std::filesystem::path& file, std::string_view text);

/// Moves `from` to `to` (same folder) in one step and forces the folder to the disk.
void move_file(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace mcdem
