#include "cli/child.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "cli/shell/shell_words.h"

namespace mcdem {
namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Only functions that are allowed between fork and exec.
[[noreturn]] void become(const char* folder, const char* out, const char* err, char* const* arguments,
                         char* const* environment) {
    const bool ready = ::chdir(folder) == 0 && ::dup2(::open("/dev/null", O_RDONLY), 0) >= 0 &&
                       ::dup2(::open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600), 1) >= 0 &&
                       ::dup2(::open(err, O_WRONLY | O_CREAT | O_TRUNC, 0600), 2) >= 0;
    if (ready) ::execve(MCDEM_BINARY, arguments, environment);
    ::_exit(127);
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> all;
    for (auto& text : texts) all.push_back(text.data());
    all.push_back(nullptr);
    return all;
}

}  // namespace

Child::Child(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
             const std::vector<std::string>& environment)
    : folder_(folder) {
    std::vector<std::string> words{"mcdem"}, settings(environment);
    words.insert(words.end(), arguments.begin(), arguments.end());
    for (char** variable = environ; *variable; ++variable) settings.push_back(*variable);
    const auto argv = pointers(words), envp = pointers(settings);
    const auto out = (folder / "stdout.txt").string(), err = (folder / "stderr.txt").string();
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("fork failed");
    if (pid_ == 0) become(folder.c_str(), out.c_str(), err.c_str(), argv.data(), envp.data());
}

Child::~Child() {
    if (!is_running()) return;
    send(SIGKILL);
    wait();
}

bool Child::is_running() {
    if (!waited_) waited_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
    return !waited_;
}

void Child::send(int signal) {
    if (is_running()) ::kill(pid_, signal);
}

Finished Child::wait() {
    if (!waited_) ::waitpid(pid_, &status_, 0);
    waited_ = true;
    Finished finished;
    if (WIFEXITED(status_)) finished.exit_code = WEXITSTATUS(status_);
    if (WIFSIGNALED(status_)) finished.signal = WTERMSIG(status_);
    finished.out = text_of(folder_ / "stdout.txt");
    finished.err = text_of(folder_ / "stderr.txt");
    return finished;
}

Finished run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment) {
    return Child(folder, arguments, environment).wait();
}

Finished output_of_shell(const std::string& script) {
    Finished end;
    std::FILE* const pipe = ::popen(("exec bash -c " + shell_word(script)).c_str(), "r");
    if (!pipe) throw std::runtime_error("bash cannot be started");
    char block[4096];
    for (std::size_t size; (size = std::fread(block, 1, sizeof block, pipe)) > 0;)
        end.out.append(block, size);
    const int status = ::pclose(pipe);
    if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    return end;
}

}  // namespace mcdem
