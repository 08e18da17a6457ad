#include "cl/process_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/errors.h"

namespace mcdem::inline opencl {

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

}  // namespace mcdem::opencl
