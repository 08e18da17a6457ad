// Checks of the stages of a programme.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "scene/keys.h"
#include "scene/scene_checks.h"

namespace mcdem::inline scene {

/// `said`: the keys that the scene sets or varies. Stages with keys in `bad`, which already have problems,
/// are not checked.
std::vector<CrossProblem> programme_problems(const Settings& settings, const std::set<std::string>& said,
                                             const std::set<std::string, std::less<>>& bad);

/// Force on the plate [N] above which the contacts under it would exceed numerics.overlap_limit.
double max_plate_force(const Settings& settings, double smallest_diameter);
/// The same for the stress of a cell [Pa].
double max_cell_stress(const Settings& settings);

}  // namespace mcdem::scene
