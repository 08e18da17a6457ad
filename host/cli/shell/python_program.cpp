#include "cli/shell/python_program.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>

#include "cli/shell/commands.h"
#include "cli/shell/interrupt.h"
#include "core/errors.h"
#include "core/look.h"

namespace mcdem::inline cli {
namespace {

namespace fs = std::filesystem;

constexpr auto check_interval = std::chrono::milliseconds(5);  ///< of whether it has ended
constexpr int not_found = 127;                                 ///< exit code if there is no such program

fs::path this_program() { return fs::read_symlink("/proc/self/exe"); }

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// A program in an absolute folder of the search path; elsewhere others may have put one of that name.
std::string in_search_path(const std::string& name) {
    std::istringstream folders(variable("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');)
        if (const fs::path program = fs::path(folder) / name;
            program.is_absolute() && ::access(program.c_str(), X_OK) == 0)
            return program.string();
    return "/usr/bin/" + name;  // named in the message
}

/// Whether pip has installed it, as lib/python3*/site-packages/mcdem/bin/mcdem.
bool is_from_pip() { return is_there(this_program().parent_path().parent_path() / "start.py"); }

std::string interpreter() {
    const std::string chosen = variable("MCDEM_PYTHON");
    if (!chosen.empty()) return chosen.find('/') == chosen.npos ? in_search_path(chosen) : chosen;
    // In a virtual environment its interpreter, otherwise the system's.
    fs::path bin = this_program().parent_path();
    if (is_from_pip()) bin /= "../../../../../bin";
    for (const fs::path& python : {bin / "python3", fs::path("/usr/bin/python3")})
        if (::access(python.c_str(), X_OK) == 0) return python.string();
    return in_search_path("python3");
}

/// Where the package may be: with its compiled module where Python's packages are installed, or in the build
/// folder; without it beside the data of the program, or in the sources.
std::vector<fs::path> package_folders() {
    const fs::path bin = this_program().parent_path(), prefix = bin.parent_path();
    std::vector<fs::path> folders;
    if (is_folder(prefix / "lib"))
        for (const fs::path& entry : entries_of(prefix / "lib"))
            if (entry.filename().string().starts_with("python3"))
                for (const char* packages : {"dist-packages", "site-packages"})
                    if (is_there(entry / packages / "mcdem/start.py")) folders.push_back(entry / packages);
    if (is_from_pip()) folders.push_back(prefix.parent_path());
    folders.insert(folders.end(), {prefix / "share/mcdem/python", bin / "python", MCDEM_SOURCE_PYTHON});
    return folders;
}

/// The file that starts commands (host/python/mcdem/start.py), in the package's folder.
fs::path start_file() {
    const std::string chosen = variable("MCDEM_PYTHON_FOLDER");
    const std::vector<fs::path> folders = chosen.empty() ? package_folders() : std::vector<fs::path>{chosen};
    for (const fs::path& folder : folders)
        if (is_there(folder / "mcdem/start.py")) return fs::canonical(folder / "mcdem") / "start.py";
    std::string looked;
    for (const fs::path& folder : folders) looked += (looked.empty() ? "" : " or ") + folder.string();
    throw RunError(
        fmt::format("the Python package of mcdem is not in {}: install mcdem again, or name its folder by "
                    "MCDEM_PYTHON_FOLDER",
                    looked));
}

/// Runs the words in a child process, which gets SIGTERM when this one dies. It starts with SIGINT held back
/// until it can clean up (program.py): Python's own handler would print where it was interrupted.
pid_t start(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    sigset_t held, before;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    ::pthread_sigmask(SIG_BLOCK, &held, &before);
    std::signal(SIGCHLD, SIG_DFL);  // a caller may have ignored it, and then nobody could wait for the child
    const pid_t parent = ::getpid(), child = ::fork();
    const int error = errno;
    if (child == 0) {  // only async-signal-safe functions between fork and exec
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() == parent) ::execvp(arguments[0], arguments.data());
        ::_exit(not_found);
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (child < 0) throw RunError(words.front() + ": cannot be started: " + std::strerror(error));
    return child;
}

/// Waits for the child, to which an interruption is passed on; returns the status of waitpid.
int status_of(pid_t child) {
    const Interrupt interrupt;
    int status = 0;
    bool told = false;
    for (pid_t ended = 0; (ended = ::waitpid(child, &status, WNOHANG)) != child;) {
        if (ended < 0 && errno != EINTR)
            throw RunError(std::string("the started process cannot be waited for: ") + std::strerror(errno));
        if (Interrupt::wanted() && !told) {
            ::kill(child, SIGTERM);
            told = true;
        }
        std::this_thread::sleep_for(check_interval);
    }
    return status;
}

}  // namespace

int run_python_module(const std::string& module, const std::vector<std::string>& arguments) {
    const std::string python = interpreter();
    // -E, -s: without PYTHONPATH, PYTHONHOME, .. and the user's packages, from which start.py takes what is
    // safe. -I would do the same, but Python 2 does not know it and could not say that it is too old. -B:
    // writes no bytecode beside the package.
    std::vector<std::string> words{python, "-E", "-s", "-B", start_file().string(), module};
    words.insert(words.end(), arguments.begin(), arguments.end());
    ::setenv("MCDEM_PROGRAM", this_program().c_str(), 1);
    std::fflush(stdout);  // otherwise its output would come first
    const int status = status_of(start(words));
    if (WIFEXITED(status) && WEXITSTATUS(status) == not_found)
        throw RunError(fmt::format(
            "{}: cannot be started: install python3, or name a Python 3 by MCDEM_PYTHON", python));
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    const int signal = WTERMSIG(status);
    if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) return exit_interrupted;
    ::raise(
        signal);  // ends as the command would: distributed.py distinguishes it, cli.cpp hints at the cause
    throw RunError(fmt::format("{}: was ended by signal {}", python, signal));
}

}  // namespace mcdem::cli
