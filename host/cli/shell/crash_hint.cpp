#include "cli/shell/crash_hint.h"

#include <unistd.h>

#include <csignal>
#include <initializer_list>

namespace mcdem::inline cli {
namespace {

constexpr char hint[] =
    "mcdem: ended by a defect of the program or of the OpenCL driver. If it happens again, remove the "
    "compiled kernels (the "
    "folder of POCL_CACHE_DIR, else ~/.cache/pocl/kcache), which may be damaged: they are made anew. A run "
    "goes on with "
    "--resume\n";

void say_hint(int signal) {
    const ssize_t written = write(STDERR_FILENO, hint, sizeof hint - 1);
    (void)written;
    raise(signal);  // default action again because of SA_RESETHAND
}

}  // namespace

void hint_at_crashes() {
    for (const int signal : {SIGABRT, SIGBUS, SIGSEGV, SIGILL, SIGFPE}) {
        struct sigaction before {};
        const bool is_free = sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL;
        if (!is_free && signal != SIGABRT)
            continue;  // handler of a sanitizer, or one that continues with the previous handler
        struct sigaction action {};
        action.sa_handler = say_hint;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigaction(signal, &action, nullptr);
    }
}

}  // namespace mcdem::cli
