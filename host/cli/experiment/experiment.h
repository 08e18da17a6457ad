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

/// The absolute path of the folder, without a final slash.
std::filesystem::path whole_path(const std::string& folder);

/// Reads an experiment before it is moved to `out`. Throws InputError that begins with the heading and names
/// files as in `out`.
Experiment read_back(const std::filesystem::path& folder, const std::string& out, const std::string& heading);

/// Moves the files of an experiment into the folder `out`, experiment.toml last, because it makes the folder
/// an experiment. Throws InputError as expect_free and open_output_folder do.
void put_in_place(const std::filesystem::path& work, const std::filesystem::path& out);

}  // namespace mcdem::cli
