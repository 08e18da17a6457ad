#include "report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "core/errors.h"
#include "report/labels.h"

namespace mcdem::gnuplot {
namespace {

const char* const log_name = "gnuplot.log";

/// What the child does before it becomes gnuplot: enter the folder, read nothing, write to the log.
class Preparation {
public:
    explicit Preparation(const std::filesystem::path& folder) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log_name, O_WRONLY | O_CREAT | O_TRUNC,
                                         0644);
        posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    }
    ~Preparation() { posix_spawn_file_actions_destroy(&actions_); }
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;
    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_;
};

std::string said(const std::filesystem::path& folder) {
    std::ifstream log(folder / log_name);
    return {std::istreambuf_iterator<char>(log), {}};
}

int wait_for(pid_t child) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw RunError("gnuplot: lost: " + std::generic_category().message(errno));
    return status;
}

}  // namespace

// Between single quotes gnuplot reads everything as it stands, except that '' is one quote.
std::string quoted(const std::string& text) {
    std::string safe = "'";
    for (char c : one_line(text)) safe += c == '\'' ? std::string("''") : std::string(1, c);
    return safe + "'";
}

std::string csv_field(const std::string& text) {
    const auto line = one_line(text);
    if (line.find_first_of(",\"") == std::string::npos) return line;
    std::string field = "\"";
    for (char c : line) field += c == '"' ? std::string("\"\"") : std::string(1, c);
    return field + "\"";
}

std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value + 0.0) : "";  // + 0: no minus before a zero
}

void run(const std::filesystem::path& folder, const std::string& script) {
    const Preparation preparation(folder);
    // default-settings: a user's ~/.gnuplot must not change pictures
    std::string program = "gnuplot", defaults = "--default-settings", file = script;
    char* const arguments[] = {program.data(), defaults.data(), file.data(), nullptr};
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, program.c_str(), preparation.get(), nullptr, arguments, environ);
    if (error == ENOENT)
        throw RunError(
            "gnuplot was not found, pictures cannot be drawn: install the package gnuplot-nox "
            "(apt install gnuplot-nox)");
    if (error != 0) throw RunError("gnuplot cannot be started: " + std::generic_category().message(error));
    const int status = wait_for(child);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw RunError(fmt::format("gnuplot failed on {}:\n{}", (folder / script).string(), said(folder)));
}

}  // namespace mcdem::gnuplot
