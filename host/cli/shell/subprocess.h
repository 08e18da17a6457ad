// Runs other programs without a shell, and quotes words for one.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline cli {

inline constexpr int not_found = 127;  ///< exit code if the program does not exist

struct ProgramEnd {
    int exit_code = -1;  ///< -1 if a signal ended it
    int signal = 0;
};

/// A child process; it gets SIGTERM when this program dies.
class Subprocess {
public:
    /// The process inherits the output streams and the environment. Exit code 127 if the program does not
    /// exist. Throws RunError if it cannot be started.
    explicit Subprocess(std::vector<std::string> words);
    ~Subprocess();
    Subprocess(Subprocess&& other) noexcept;
    Subprocess(const Subprocess&) = delete;

    /// Result of the process; nothing while it runs.
    std::optional<ProgramEnd> ended();
    void send(int signal) const;

private:
    pid_t process_ = -1;  ///< -1 after it has ended
    std::optional<ProgramEnd> end_;
};

std::filesystem::path this_program();

/// The word, in quotes if a shell would interpret it.
std::string shell_word(const std::string& word);
std::string shell_words(const std::vector<std::string>& words);

}  // namespace mcdem::cli
