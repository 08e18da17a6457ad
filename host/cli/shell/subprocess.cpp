#include "cli/shell/subprocess.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/errors.h"
#include "core/replaced.h"

namespace mcdem::inline cli {
namespace {

pid_t start(std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) throw RunError(words.front() + ": cannot be started: " + std::strerror(errno));
    if (process == 0) {  // only async-signal-safe functions between fork and exec
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) ::_exit(not_found);
        ::execvp(arguments[0], arguments.data());
        ::_exit(not_found);
    }
    return process;
}

ProgramEnd end_of(int status) {
    ProgramEnd end;
    if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    return end;
}

}  // namespace

Subprocess::Subprocess(std::vector<std::string> words) : process_(start(words)) {}

Subprocess::Subprocess(Subprocess&& other) noexcept
    : process_(std::exchange(other.process_, -1)), end_(std::move(other.end_)) {}

Subprocess::~Subprocess() {
    if (process_ < 0) return;
    ::kill(process_, SIGTERM);
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
}

std::optional<ProgramEnd> Subprocess::ended() {
    int status = 0;
    if (process_ >= 0 && ::waitpid(process_, &status, WNOHANG) == process_) {
        process_ = -1;
        end_ = end_of(status);
    }
    return end_;
}

void Subprocess::send(int signal) const {
    if (process_ >= 0) ::kill(process_, signal);
}

std::filesystem::path this_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

std::string shell_word(const std::string& word) {
    const auto plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=:+,-";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    return "'" + replaced(word, {{'\'', "'\\''"}}) + "'";
}

std::string shell_words(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + shell_word(word);
    return text;
}

}  // namespace mcdem::cli
