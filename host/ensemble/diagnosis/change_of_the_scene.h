// Advice on the scene's keys that follows from a diagnosis.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "ensemble/diagnosis/build_library.h"

namespace mcdem::inline ensemble {

/// How to change the scene according to the named effect; nothing if none is named.
std::optional<NextStep> change_of_the_scene(const Diagnosis& diagnosis, const Model& model,
                                            const std::vector<Nuisance>& nuisances);

}  // namespace mcdem::ensemble
