#include "io/process_identity.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace mcdem {
namespace {

std::string this_machine() {
    char name[256] = "";
    ::gethostname(name, sizeof name - 1);
    std::string start;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> start;
    std::error_code none;
    const auto numbers = std::filesystem::read_symlink("/proc/self/ns/pid", none);
    return fmt::format("{} {} {}", name, start, numbers.string());
}

/// Field 22 of /proc/<process>/stat; -1 where it cannot be read. The name before it may hold blanks and
/// brackets.
long start_of(long process) {
    std::ifstream in(fmt::format("/proc/{}/stat", process));
    std::string text;
    std::getline(in, text);
    const auto after_name = text.rfind(')');
    if (after_name == std::string::npos) return -1;
    std::istringstream fields(text.substr(after_name + 1));
    std::string skipped;
    long started = -1;
    for (int field = 3; field < 22; ++field) {
        fields >> skipped;
        if (field == 3 && (skipped == "Z" || skipped == "X")) return -1;  // ended, and not yet buried
    }
    fields >> started;
    return started;
}

}  // namespace

ProcessIdentity this_process() {
    static const std::string machine = this_machine();
    return {machine, ::getpid(), start_of(::getpid())};
}

Life life_of(const ProcessIdentity& process) {
    if (process.machine != this_process().machine) return Life::cannot_be_told;
    if (::kill(static_cast<pid_t>(process.process), 0) != 0 && errno == ESRCH) return Life::ended;
    return start_of(process.process) == process.started ? Life::alive : Life::ended;
}

}  // namespace mcdem
