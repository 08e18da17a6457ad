#include "cl/error_text.h"

#include <fmt/format.h>

namespace mcdem::inline opencl {
namespace {

/// Drivers use CL_OUT_OF_RESOURCES for both.
const char* remedy_of(cl_int code) {
    switch (code) {
        case CL_MEM_OBJECT_ALLOCATION_FAILURE:
            return "the device has not enough memory; run fewer replicas at a time";
        case CL_OUT_OF_RESOURCES:
            return "the device has not enough memory (run fewer replicas at a time), or it has failed "
                   "(`mcdem devices` lists those that answer)";
        default:
            return "the device or its driver has failed (`mcdem devices` lists those that answer), or, with "
                   "PoCL, its compiled kernels are damaged (remove the folder that POCL_CACHE_DIR names, "
                   "~/.cache/pocl/kcache or mcdem-kernels-.. in /tmp)";
    }
}

}  // namespace

std::string text_of(const cl::Error& error) {
    return fmt::format("OpenCL: {} failed with code {}: {}", error.what(), error.err(),
                       remedy_of(error.err()));
}

}  // namespace mcdem::opencl
