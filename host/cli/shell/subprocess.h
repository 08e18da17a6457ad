// Other programs, started without a shell.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// How a program ended.
struct ProgramEnd {
    int exit_code = -1;  ///< -1 where a signal ended it
    int signal = 0;
    std::string out;  ///< what it wrote to standard output, where that was read
};

/// A program that runs beside this one; told to end (SIGTERM) when this one dies.
class Subprocess {
public:
    /// Its output goes where this program's goes; `environment` is added to this program's: "NAME=value".
    /// Exit code 127 where there is no such program. Throws RunError where it cannot be started.
    explicit Subprocess(std::vector<std::string> words, const std::vector<std::string>& environment = {});
    ~Subprocess();
    Subprocess(Subprocess&& other) noexcept;
    Subprocess(const Subprocess&) = delete;

    /// How it ended; nothing while it runs.
    std::optional<ProgramEnd> ended();
    void send(int signal) const;

private:
    pid_t process_ = -1;  ///< -1 once it has ended
    std::optional<ProgramEnd> end_;
};

/// Runs a program of the search path to its end and reads its output. Nothing where there is no such program.
std::optional<ProgramEnd> output_of(std::vector<std::string> words);

/// The file of this program.
std::filesystem::path this_program();

}  // namespace mcdem::cli
