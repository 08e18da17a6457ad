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

/// Throws InputError where a file that is not mcdem's lies in the place of figures.json or of a figure of
/// these names.
void expect_replaceable_figures(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Writes `values` (report/run/figure_values.h) as figures.json into `folder`, which must exist, and draws
/// NAME.pdf, NAME.png and NAME.svg of each. Returns the PNG files; none where Python could not draw, which it
/// has said. Throws InputError as above, RunError where there is no Python.
std::vector<std::filesystem::path> draw_figures(const std::filesystem::path& folder,
                                                const nlohmann::ordered_json& values);

/// Draws runs against a reference; what they do not tell is said. Makes the folder.
std::vector<std::filesystem::path> draw_runs(const std::filesystem::path& folder,
                                             const std::vector<Setting>& settings,
                                             const std::optional<Setting>& reference,
                                             const FigureOptions& options = {});

/// For a command that has more to give than figures: what goes wrong is said, and no more.
std::vector<std::filesystem::path> draw_if_possible(
    const std::function<std::vector<std::filesystem::path>()>& draw);

/// Draws the run that has just ended into its own folder, if possible.
std::vector<std::filesystem::path> draw_run(const std::filesystem::path& folder);

/// --displacement of the force distribution, --threshold of Z.
void add_figure_options(CLI::App& command, FigureOptions& figures);

}  // namespace mcdem::cli
