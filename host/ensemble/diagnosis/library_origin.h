// What a signature library depends on.
#pragma once
#include <map>
#include <string>

#include "ensemble/diagnosis/library_trials.h"

namespace mcdem::inline ensemble {

/// Everything that signatures and scatter depend on, by name: keys of the scene, stated errors of the
/// instrument, sizes of grains, kernels, program version and observables.
std::map<std::string, std::string> library_origin(const TrialSettings& common, const Model& model,
                                                  std::size_t grains);

}  // namespace mcdem::ensemble
