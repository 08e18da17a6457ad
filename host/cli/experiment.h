// The commands of `mcdem experiment`.
#pragma once
#include <CLI/CLI.hpp>

namespace mcdem {

void add_experiment_check(CLI::App& experiment);
void add_experiment_from_run(CLI::App& experiment);

}  // namespace mcdem
