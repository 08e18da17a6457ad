// Reading files. Errors of the file (InputError) are distinguished from temporary errors of the system
// (RunError).
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace mcdem::inline core {

/// Descriptor of a file opened for reading. Throws InputError if it does not exist or is a folder, pipe,
/// device or socket (without waiting for it), RunError if the system refuses.
int open_input(const std::filesystem::path& file);

/// Passes the bytes of the file to `take`, in order; throws like open_input.
void read_blocks(const std::filesystem::path& file, const std::function<void(std::string_view block)>& take);

/// All bytes of the file; throws like open_input.
std::string read_file(const std::filesystem::path& file);

/// The first bytes of the file, at most `size`; throws like open_input.
std::string read_beginning(const std::filesystem::path& file, std::size_t size);

/// All bytes; if the file does not exist, the message of the InputError is `if_missing`.
std::string read_file(const std::filesystem::path& file, std::string_view if_missing);

/// Throws RunError: the system refused `what` with this errno. This says nothing about the file's content.
[[noreturn]] void fail_reading(const std::string& what, int error);

}  // namespace mcdem::core
