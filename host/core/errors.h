// Errors that are reported to the user. All other exceptions are defects and end the program.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace mcdem::inline core {

/// Invalid user input: a scene, a packing, an experiment, an option (exit code 2).
/// Contains all problems found, each as `where: what must be, what was got`.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<std::string> problems)
        : std::runtime_error(join(problems)), problems_(std::move(problems)) {}
    explicit InputError(const std::string& problem) : InputError(std::vector<std::string>{problem}) {}
    const std::vector<std::string>& problems() const { return problems_; }

private:
    static std::string join(const std::vector<std::string>& lines) {
        std::string all;
        for (const auto& line : lines) all += (all.empty() ? "" : "\n") + line;
        return all;
    }
    std::vector<std::string> problems_;
};

/// The work failed although the input was valid: no device, disk full (exit code 1).
class RunError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The work was interrupted by a signal or by the caller (exit code 130). The same command continues it.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted; run the same command again to continue") {}
};

}  // namespace mcdem::core
