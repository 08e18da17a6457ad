// Text at the head of a page of runs: what was simulated, and the main result.
#pragma once
#include <string>
#include <vector>

#include "metrics/levels.h"

namespace mcdem::inline report {

/// "514 grains in a box, compressed by a plate, 20 cycles; 7 settings, 32 packings each."
std::string what_was_simulated(const std::vector<Setting>& settings);

/// "Force on the plate at 30.13 mm: Independent contacts 7.19 N, MC-DEM 15.98 N." For a cell its largest mean
/// stress. Also states how many replicas stopped early.
std::string main_result(const std::vector<Setting>& settings, const LevelOptions& options = {});

}  // namespace mcdem::report
