// Entry point of the program: commands, help, messages and exit codes.
#pragma once

namespace mcdem::inline cli {

/// Runs the command in the arguments. Returns the exit code: 0 done, 1 failed, 2 bad input, 130 interrupted.
/// Tables are printed on standard output, messages and progress on standard error.
int run_cli(int argc, const char* const* argv);

}  // namespace mcdem::cli
