// Checks whether an experiment can be diagnosed, before anything is simulated.
#pragma once
#include <string>
#include <vector>

#include "diagnose/observe/observation.h"
#include "experiment/experiment.h"

namespace mcdem::inline diagnose {

/// Minimum number of cells that an experiment and its simulations must have in common.
inline constexpr std::size_t min_cells = 4;

/// Data that `mcdem diagnose` needs and the experiment lacks, each with a remedy; empty if it can be
/// diagnosed.
std::vector<std::string> needed_to_diagnose(const Experiment& experiment);

}  // namespace mcdem::diagnose
