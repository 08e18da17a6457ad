// Draws a figure with gnuplot.
#pragma once
#include <filesystem>
#include <vector>

#include "report/plot_script.h"

namespace mcdem {

/// Throws InputError where a figure of this name lies in `folder` that was not drawn here, or whose script
/// was edited.
void expect_replaceable_figure(const std::filesystem::path& folder, const std::string& name);

/// Draws into `folder`, which must exist: NAME.png and NAME.svg, which are returned, and beside them NAME.csv
/// and NAME.gp to draw them again. Throws InputError as above, RunError where it cannot.
std::vector<std::filesystem::path> draw_figure(const Figure& figure, const std::filesystem::path& folder);

}  // namespace mcdem
