// The paper's four figures from any settings: top force, force distribution at one level, Z after
// thresholding, scaling law.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metrics/compare.h"

namespace mcdem {

struct FigureOptions {
    CompareOptions compare;
    std::vector<Comparison> comparisons =
        {};  ///< of the settings with the reference, where at hand; else made
    Phase distribution_phase =
        Phase::unload;  ///< the force distribution is shown while loading or unloading ..
    double distribution_displacement = 18e-3;  ///< .. at the level nearest to this [m]
    double threshold = 0;                      ///< of Z where no reference tells tau [N]
};

struct Drawn {
    std::vector<std::filesystem::path> pictures;  ///< PNG and SVG of each figure
    std::vector<std::string> notes;               ///< which figures could not be drawn, and why
};

/// Draws into `folder`, which must exist: NAME.png and NAME.svg, and beside them NAME.csv and NAME.gp to
/// draw them again. Lines are simulations, points the reference.
Drawn draw_figures(const std::vector<Setting>& settings, const std::optional<Setting>& reference,
                   const std::filesystem::path& folder, const FigureOptions& options = {});

}  // namespace mcdem
