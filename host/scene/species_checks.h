// Checks of the species and pairs of one setting.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "scene/scene_checks.h"

namespace mcdem::inline scene {

/// The setting's species must be resolved. `said`: keys that the scene sets or varies. Conditions on keys in
/// `bad`, which already have problems, are not checked.
std::vector<CrossProblem> species_problems(const Settings& settings, const std::set<std::string>& said,
                                           const std::set<std::string, std::less<>>& bad);

}  // namespace mcdem::scene
