// Shared code of the commands `mcdem challenge ..`.
#pragma once
#include <CLI/CLI.hpp>

namespace mcdem::inline cli {

void add_challenge_make(CLI::App& challenge, int& exit_code);
void add_challenge_run(CLI::App& challenge, int& exit_code);
void add_challenge_score(CLI::App& challenge, int& exit_code);

}  // namespace mcdem::cli
