// What an experiment does not have, and what could be told with it.
#pragma once
#include <string>
#include <vector>

#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {

/// One sentence for each file whose observables are missing everywhere.
std::vector<std::string> not_measured(const Eigen::VectorXd& observed, const Grid& grid);

}  // namespace mcdem::diagnose
