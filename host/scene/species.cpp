#include "scene/species.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/scene.h"

namespace mcdem::inline scene {
namespace {

/// Values of the pair replace the default values.
PairLaw with_pair(const Replica& replica, std::string_view a, std::string_view b, PairLaw law) {
    for (const SpeciesPair& pair : replica.pairs) {
        const bool is_it = (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
        if (is_it && !std::isnan(pair.friction)) law.friction = pair.friction;
        if (is_it && !std::isnan(pair.restitution)) law.restitution = pair.restitution;
    }
    return law;
}

}  // namespace

std::vector<GrainMaterial> materials(const Replica& replica) {
    if (replica.species.empty()) return {replica.grains};
    std::vector<GrainMaterial> all;
    for (const Species& species : replica.species) all.push_back(species.material);
    return all;
}

GrainMaterial stiffest(const Replica& replica) {
    return std::ranges::max(materials(replica), {}, plane_modulus);
}

GrainMaterial softest(const Replica& replica) {
    return std::ranges::min(materials(replica), {}, plane_modulus);
}

double rayleigh_speed(const GrainMaterial& g) {
    const double shear_modulus = g.youngs_modulus / (2 * (1 + g.poisson_ratio));
    return std::sqrt(shear_modulus / g.density) * (0.163 * g.poisson_ratio + 0.8766);
}

double rayleigh_time(const Replica& replica, double radius) {
    double fastest = 0;
    for (const GrainMaterial& material : materials(replica))
        fastest = std::max(fastest, rayleigh_speed(material));
    return std::numbers::pi * radius / fastest;
}

PairLaw pair_law(const Replica& replica, std::size_t first, std::size_t second) {
    if (replica.species.empty()) return {replica.grains.friction, replica.grains.restitution};
    const Species &a = replica.species[first], &b = replica.species[second];
    return with_pair(replica, a.name, b.name,
                     {std::min(a.material.friction, b.material.friction),
                      std::min(a.material.restitution, b.material.restitution)});
}

PairLaw wall_law(const Replica& replica, std::size_t species) {
    const PairLaw law{replica.walls.friction, replica.walls.restitution};
    if (replica.species.empty()) return law;
    return with_pair(replica, replica.species[species].name, walls_name, law);
}

}  // namespace mcdem::scene
