#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "experiment/experiment.h"

namespace mcdem::inline cli {

void add_experiment_from_run(CLI::App& experiment);
void add_experiment_import(CLI::App& experiment, int& exit_code);

/// Adds the options of what an instrument states of its errors.
void add_measurement_options(CLI::App& command, Measurement& measurement);

/// Throws InputError if the folder contains another experiment or a run.
void expect_free(const std::filesystem::path& out);

}  // namespace mcdem::cli
