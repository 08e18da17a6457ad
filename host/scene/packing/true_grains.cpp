#include "scene/packing/true_grains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/random.h"

namespace mcdem::inline scene {

Packing true_packing(const Replica& replica, Packing stated) {
    const double error = replica.effects.diameter_error, sd = replica.effects.polydispersity;
    if (error == 0 && sd == 0) return stated;
    Random random(replica.packing.seed, Stream::true_diameters);
    for (double& diameter : stated.diameter) diameter += error + sd * random.normal();
    const auto smallest = std::ranges::min_element(stated.diameter);
    if (!(*smallest > 0))
        throw InputError(fmt::format(
            "effects.diameter_error and effects.polydispersity must leave every diameter > 0 [m], "
            "got {} for grain {} of {}",
            *smallest, smallest - stated.diameter.begin(), replica.label));
    return stated;
}

std::vector<double> excess_compliance(const Replica& replica, std::size_t grains) {
    const double s = replica.effects.modulus_scatter;
    std::vector<double> all(grains, 0.0);
    if (s == 0) return all;
    Random random(replica.packing.seed, Stream::moduli);
    for (double& excess : all) excess = std::expm1(s * s / 2 - s * random.normal());
    return all;
}

}  // namespace mcdem::scene
