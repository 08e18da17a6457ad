// Results of `mcdem converge` as JSON.
#pragma once
#include <string>

#include "diagnose/convergence.h"

namespace mcdem::inline diagnose {

/// The content of convergence.json, with the result in words: whether the scene is converged, and one line
/// per cause: "plate speed: top_force is 1.3 +- 0.2 % too high at ..", or that all errors are within the
/// limits.
std::string convergence_json(const Convergence& convergence);

}  // namespace mcdem::diagnose
