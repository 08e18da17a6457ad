#include "cl/process_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/errors.h"

namespace mcdem::inline opencl {
namespace {

/// The soft limit of a resource; infinity if it is not known.
rlim_t limit_of(decltype(RLIMIT_STACK) resource) {
    rlimit limit{};
    return ::getrlimit(resource, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

}  // namespace

void expect_enough_open_files() {
    constexpr rlim_t enough = 64, plenty = 1024;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= plenty) return;
    rlimit raised = limit;
    raised.rlim_cur = limit.rlim_max < plenty ? limit.rlim_max : plenty;
    if (::setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
    if (limit.rlim_cur < enough)
        throw RunError(
            fmt::format("the limit of open files is {}, too few for the OpenCL driver: raise it (`ulimit "
                        "-n`) to {} or more",
                        limit.rlim_cur, enough));
}

void expect_room_for_kernels() {
    constexpr rlim_t largest_file = 8 << 20;
    if (const rlim_t limit = limit_of(RLIMIT_FSIZE); limit < largest_file)
        throw RunError(fmt::format(
            "the limit of the file size is {} bytes, too small for the files of the OpenCL driver: "
            "raise it (`ulimit -f`) to {} or more",
            limit, largest_file));
}

void expect_enough_stack() {
    constexpr rlim_t enough = 512 << 10;
    if (const rlim_t limit = limit_of(RLIMIT_STACK); limit < enough)
        throw RunError(fmt::format(
            "the limit of the stack is {} kB, too small for the program and the OpenCL driver: raise it "
            "(`ulimit -s`) to {} or more",
            limit >> 10, enough >> 10));
}

}  // namespace mcdem::opencl
