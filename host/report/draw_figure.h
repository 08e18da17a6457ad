// Draws a figure with gnuplot.
#pragma once
#include <filesystem>
#include <vector>

#include "report/plot_script.h"

namespace mcdem {

/// Draws into `folder`, which must exist: NAME.png and NAME.svg, which are returned, and beside them NAME.csv
/// and NAME.gp to draw them again. Throws RunError where it cannot.
std::vector<std::filesystem::path> draw_figure(const Figure& figure, const std::filesystem::path& folder);

}  // namespace mcdem
