// Figures for print, drawn by the Python package mcdem.figures.
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/run/run_figures.h"

namespace mcdem::inline cli {

/// Throws InputError if figures.json or a figure with one of these names exists and was not written by mcdem.
void expect_replaceable_figures(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Writes `values` (report/run/figure_values.h) as figures.json into `folder`, which must exist, and draws
/// NAME.pdf, NAME.png and NAME.svg of each. Returns the PNG files; none if Python failed, after it has
/// printed a message. Throws InputError as above, RunError if there is no Python.
std::vector<std::filesystem::path> draw_figures(const std::filesystem::path& folder,
                                                const nlohmann::ordered_json& values);

/// Draws runs with a reference, and prints which figures are not available. Creates the folder.
std::vector<std::filesystem::path> draw_runs(const std::filesystem::path& folder,
                                             const std::vector<Setting>& settings,
                                             const std::optional<Setting>& reference,
                                             const FigureOptions& options = {});

/// For commands with other results: errors are only reported.
std::vector<std::filesystem::path> draw_if_possible(
    const std::function<std::vector<std::filesystem::path>()>& draw);

/// Draws the figures of a finished run into its folder, if possible.
std::vector<std::filesystem::path> draw_run(const std::filesystem::path& folder);

/// Adds --displacement for the force distribution, and --threshold for Z.
void add_figure_options(CLI::App& command, FigureOptions& figures);

}  // namespace mcdem::cli
