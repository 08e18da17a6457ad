// The files of kernels/, embedded at build time.
#pragma once
#include <map>
#include <string>

namespace mcdem::inline opencl {
/// File name -> content.
const std::map<std::string, std::string>& embedded_kernel_sources();
}  // namespace mcdem::opencl
