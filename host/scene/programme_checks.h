// What the stages of a programme demand.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "scene/keys.h"
#include "scene/scene_checks.h"

namespace mcdem::inline scene {

/// `said`: the keys that the scene gives or varies. Keys in `bad` had problems of their own; stages that have
/// one are not checked.
std::vector<CrossProblem> programme_problems(const Settings& settings, const std::set<std::string>& said,
                                             const std::set<std::string, std::less<>>& bad);

/// Beyond this force on the plate [N] every contact under it would be deeper than numerics.overlap_limit.
double max_plate_force(const Settings& settings, double smallest_diameter);
/// The same of a stress of a cell [Pa].
double max_cell_stress(const Settings& settings);

}  // namespace mcdem::scene
