// Data that an experiment lacks, and what they would show.
#pragma once
#include <string>
#include <vector>

#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {

/// One sentence for each file whose observables are missing in all scans.
std::vector<std::string> not_measured(const Eigen::VectorXd& observed, const Grid& grid);

}  // namespace mcdem::diagnose
