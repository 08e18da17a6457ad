// One function per command, which adds it with its help to the command line. The exit code of the command is
// stored in `exit_code` when it runs; errors are thrown.
#pragma once
#include <CLI/CLI.hpp>
#include <vector>

namespace mcdem::inline cli {

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_interrupted = 130;

void add_devices(CLI::App& app, int& exit_code);
void add_validate(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_distribute(CLI::App& app, int& exit_code);
void add_python_commands(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);

/// Whether the Python package runs the command that these words begin with; its arguments are passed on
/// unread.
bool is_python_command(const std::vector<std::string>& words);

}  // namespace mcdem::cli
