#include "cli/shell/subprocess.h"

#include <fcntl.h>
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

/// `out`: descriptor for its standard output, or -1.
pid_t start(std::vector<std::string>& words, int out) {
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) throw RunError(words.front() + ": cannot be started: " + std::strerror(errno));
    if (process == 0) {  // only async-signal-safe functions between fork and exec
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) ::_exit(not_found);
        if (out < 0 || ::dup2(out, STDOUT_FILENO) >= 0) ::execvp(arguments[0], arguments.data());
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

Subprocess::Subprocess(std::vector<std::string> words) : process_(start(words, -1)) {}

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

std::optional<ProgramEnd> output_of(std::vector<std::string> words) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw RunError("no pipe to " + words.front());
    const pid_t process = start(words, ends[1]);
    ::close(ends[1]);
    std::string out;
    char block[4096];
    for (ssize_t size; (size = ::read(ends[0], block, sizeof block)) != 0;)
        if (size > 0)
            out.append(block, static_cast<std::size_t>(size));
        else if (errno != EINTR)
            break;
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(process, &status, 0) < 0)
        if (errno != EINTR) throw RunError(words.front() + ": lost: " + std::strerror(errno));
    ProgramEnd end = end_of(status);
    if (end.exit_code == not_found) return std::nullopt;
    end.out = std::move(out);
    return end;
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
