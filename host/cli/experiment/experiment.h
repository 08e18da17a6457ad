#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace mcdem::inline cli {

void add_experiment_from_run(CLI::App& experiment);
void add_experiment_import(CLI::App& experiment, int& exit_code);

/// Throws InputError if the folder contains another experiment or a run.
void expect_free(const std::filesystem::path& out);

}  // namespace mcdem::cli
