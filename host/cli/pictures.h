// The figures, drawn into a folder.
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "report/figures.h"

namespace mcdem {

/// Makes the folder and draws; what could not be drawn is said. Returns the pictures as PNG.
std::vector<std::filesystem::path> draw_into(const std::filesystem::path& folder,
                                             const std::vector<Setting>& settings,
                                             const std::optional<Setting>& reference,
                                             const FigureOptions& options = {});

/// --displacement of the force distribution, --threshold of Z.
void add_figure_options(CLI::App& command, FigureOptions& figures);

/// Draws the run that has just ended into its own folder. A run without pictures is still a run: what goes
/// wrong here is said, and no more.
std::vector<std::filesystem::path> draw_run(const std::filesystem::path& folder);

}  // namespace mcdem
