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

/// The absolute path of the folder, without a final slash.
std::filesystem::path whole_path(const std::string& folder);

/// Reads an experiment before it is moved to `out`. Throws InputError that begins with the heading and names
/// files as in `out`.
Experiment read_back(const std::filesystem::path& folder, const std::string& out, const std::string& heading);

}  // namespace mcdem::cli
