// The folder in which PoCL keeps compiled kernels between runs. Without one that it can write, PoCL finds no
// device; from files cut short by a power cut it ends the program.
#pragma once
#include <filesystem>

namespace mcdem::inline opencl {

/// Called when OpenCL has started: drivers change what signals do.
inline void (*opencl_started)() = [] {};

/// Where PoCL keeps them, as its environment variables say.
std::filesystem::path kernel_cache_folder();

/// To be called before OpenCL is first used. Where the folder cannot be written, sets POCL_CACHE_DIR to one
/// of this user's alone among the temporary files; removes files that are cut short, which are then made
/// anew.
void prepare_kernel_cache();

}  // namespace mcdem::opencl
