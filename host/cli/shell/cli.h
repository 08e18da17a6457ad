// The program as its users meet it: commands, help, messages and exit codes.
#pragma once

namespace mcdem::inline cli {

/// Runs the command that the arguments ask for. Returns the exit code: 0 done, 1 failed, 2 bad input,
/// 130 interrupted. Tables go to standard output, messages and progress to standard error.
int run_cli(int argc, const char* const* argv);

}  // namespace mcdem::cli
