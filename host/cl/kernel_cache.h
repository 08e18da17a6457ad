// The folder in which PoCL caches compiled kernels. PoCL finds no device if it cannot write this folder.
#pragma once
#include <filesystem>

namespace mcdem::inline opencl {

/// Called after OpenCL has started, because drivers change signal handlers.
inline void (*opencl_started)() = [] {};

/// PoCL's cache folder according to its environment variables.
std::filesystem::path kernel_cache_folder();

/// Must be called before OpenCL is first used. If the folder is not writable, sets POCL_CACHE_DIR to a
/// private folder in the temporary directory. Removes the empty temporary files that PoCL left more than a
/// day ago.
void prepare_kernel_cache();

}  // namespace mcdem::opencl
