#include "core/stack.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>

#include "core/errors.h"

namespace mcdem::inline core {

void expect_enough_stack() {
    constexpr rlim_t usual = rlim_t{8} << 20, enough = rlim_t{1} << 20;
    rlimit limit{};
    if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= usual) return;
    rlimit raised{usual, std::max(limit.rlim_max, usual)};
    if (::setrlimit(RLIMIT_STACK, &raised) != 0) {  // only root may raise the hard limit
        raised = {limit.rlim_max, limit.rlim_max};
        if (::setrlimit(RLIMIT_STACK, &raised) != 0) raised = limit;
    }
    if (raised.rlim_cur < enough)
        throw RunError(
            fmt::format("the limit of the stack is {} KiB, too small for the compiler of kernels: raise it "
                        "(`ulimit -s 8192`)",
                        raised.rlim_cur >> 10));
    // Threads take the limit at the start of the program.
    pthread_attr_t threads;
    if (::pthread_attr_init(&threads) != 0) return;
    if (::pthread_attr_setstacksize(&threads, raised.rlim_cur) == 0) ::pthread_setattr_default_np(&threads);
    ::pthread_attr_destroy(&threads);
}

}  // namespace mcdem::core
