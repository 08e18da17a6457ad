// What a user is told of an OpenCL error.
#pragma once
#include <string>

#include "cl/opencl.h"

namespace mcdem::inline opencl {

/// The function that failed, its code and what to do.
std::string text_of(const cl::Error& error);

}  // namespace mcdem::opencl
