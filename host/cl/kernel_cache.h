// The folder in which PoCL caches compiled kernels, which it loads as machine code. PoCL finds no device if
// it cannot write this folder.
#pragma once
#include <filesystem>
#include <string>

namespace mcdem::inline opencl {

/// Called after OpenCL has started, because drivers change signal handlers.
inline void (*opencl_started)() = [] {};

/// Called with the reason and a remedy if the folder that the environment names is not used because others
/// could put code of theirs there.
inline void (*kernel_cache_refused)(const std::string& why) = [](const std::string&) {};

/// The folder of this user for what can be made again, by XDG_CACHE_HOME or HOME; empty if they name none.
std::filesystem::path user_cache();

/// PoCL's cache folder according to its environment variables POCL_CACHE_DIR, XDG_CACHE_HOME and HOME,
/// absolute; empty if they name none.
std::filesystem::path wanted_kernel_cache();

/// Why others than this user could change what is in the folder, with a remedy; empty if only this user can.
/// Folders above it must belong to root or this user; others may write there only if it is as in /tmp
/// (sticky). Nothing in the folder may belong to others, and nothing may be a link.
std::string why_open_to_others(const std::filesystem::path& folder);

/// Must be called before OpenCL is first used. Sets POCL_CACHE_DIR to the folder of the environment, if this
/// user can write there and nobody else, otherwise to a private one in the temporary directory, never to
/// PoCL's own default, /tmp/pocl/kcache. Removes the empty temporary files that PoCL left there more than a
/// day ago.
void prepare_kernel_cache();

}  // namespace mcdem::opencl
