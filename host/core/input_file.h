// Files that are read: what is wrong with the file is told from what is wrong with the system at the moment.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace mcdem::inline core {

/// Descriptor of a file opened for reading. Throws InputError where there is no such file or it is a folder,
/// pipe, device or socket (which are not waited for), RunError where the system refuses.
int open_input(const std::filesystem::path& file);

/// Hands over the file's bytes from its beginning to its end; throws like open_input.
void read_blocks(const std::filesystem::path& file, const std::function<void(std::string_view block)>& take);

/// All bytes of the file; throws like open_input.
std::string read_file(const std::filesystem::path& file);

/// Likewise; where there is no such file, the InputError says `if_missing` of it.
std::string read_file(const std::filesystem::path& file, std::string_view if_missing);

/// Throws like open_input, and leaves the file alone.
void expect_input(const std::filesystem::path& file);

/// RunError: the system has refused `what` with this errno, which says nothing of the file's content.
[[noreturn]] void fail_reading(const std::string& what, int error);

}  // namespace mcdem::core
