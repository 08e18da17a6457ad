// PoCL that pip has installed beside mcdem (`pip install 'mcdem[cpu]'`). The loader does not find it, because
// no file in /etc/OpenCL/vendors names it.
#pragma once
#include <vector>

#include "cl/opencl.h"

namespace mcdem::inline opencl {

/// Its platforms; none if it is not installed. Then PoCL links kernels with the linker of mcdem's wheel.
std::vector<cl::Platform> pip_platforms();

}  // namespace mcdem::opencl
