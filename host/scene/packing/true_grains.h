// True diameters and stiffnesses of grains, which may differ from the stated ones.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// `stated` with true diameters: stated + effects.diameter_error + a normal deviation of
/// effects.polydispersity, drawn with the packing's seed. Throws InputError if a diameter is not positive.
Packing true_packing(const Replica& replica, Packing stated);

/// E/E_i - 1 of every grain, ln E_i normal with mean ln E - s^2/2 and sd s = effects.modulus_scatter (so that
/// the mean of E_i is E), drawn with the packing's seed.
std::vector<double> excess_compliance(const Replica& replica, std::size_t grains);

}  // namespace mcdem::scene
