// What is wrong with the species and pairs of one setting.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "scene/scene_checks.h"

namespace mcdem::inline scene {

/// Of a setting whose species are resolved. `said`: keys that the scene gives or varies; those in `bad` had
/// problems of their own.
std::vector<CrossProblem> species_problems(const Settings& settings, const std::set<std::string>& said,
                                           const std::set<std::string, std::less<>>& bad);

}  // namespace mcdem::scene
