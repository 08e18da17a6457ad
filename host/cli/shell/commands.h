// The commands of this program: each function adds options and help to its command. The exit code of the
// command is stored in `exit_code` when it runs; errors are thrown.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace mcdem::inline cli {

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_interrupted = 130;

void add_devices(CLI::App& command, int& exit_code);
void add_validate(CLI::App& command, int& exit_code);
void add_run(CLI::App& command, int& exit_code);

/// Prints what can follow the words of a command line, of which the last one may be incomplete. A line is a
/// candidate, with its description after a tab, or `:files` or `:folders` for those that the shell finds.
void print_candidates(const CLI::App& app, std::vector<std::string> words);

}  // namespace mcdem::cli
