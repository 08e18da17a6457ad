// A packing of few grains that touch each other and the walls, for comparisons with the reference.
#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "core/packing.h"
#include "scene/scene.h"

namespace mcdem::reference {

inline constexpr ContactModel all_models[] = {ContactModel::independent,
                                              ContactModel::point_force_on_sphere,
                                              ContactModel::sphere_to_sphere,
                                              ContactModel::elastic_half_space,
                                              ContactModel::mc_dem,
                                              ContactModel::elastic_sphere,
                                              ContactModel::hyperelastic_sphere};

/// Gives the same numbers with every standard library.
class Uniform {
public:
    explicit Uniform(unsigned seed) : engine_(seed) {}
    double operator()(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    Vec3 vector(double size) {
        const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
        return {x, y, z};
    }
    std::vector<Vec3> vectors(std::size_t count, double size) {
        std::vector<Vec3> all;
        for (std::size_t i = 0; i < count; ++i) all.push_back(vector(size));
        return all;
    }

private:
    std::mt19937_64 engine_;
};

/// One material for grains and walls, with which every effect is visible within a few steps.
inline Replica test_replica(ContactModel model = ContactModel::mc_dem) {
    Replica replica;
    replica.grains = {23.3e3, 0.45, 1000, 300, 0.3, 0.7, 0.5};
    replica.walls = {2e5, 0.4, 0.2, 0.8};
    replica.contact.model = model;
    replica.contact.gamma = 1.1;
    return replica;
}

/// A replica and its initial packing.
struct Start {
    Replica replica;
    Packing packing;
};

/// Grains of 10 mm radius (5 % either way) on a cubic lattice with random offsets. Neighbours overlap by
/// about 5 % of a diameter, and the outer grains touch the walls.
inline Start jittered_lattice(Replica replica, int count, unsigned seed) {
    constexpr double radius = 0.01, spacing = 0.019, wall_gap = 0.0095;
    Uniform uniform(seed);
    const int side = static_cast<int>(std::ceil(std::cbrt(count)));
    Packing packing;
    for (int i = 0; i < count; ++i) {
        const Vec3 site(i % side, i / side % side, i / (side * side));
        packing.position.push_back(spacing * site + Vec3::Constant(wall_gap) + uniform.vector(3e-4));
        packing.diameter.push_back(2 * radius * uniform(0.95, 1.05));
    }
    const double size = (side - 1) * spacing + 2 * wall_gap;
    replica.box = {size, size};
    replica.plate.start = ((count - 1) / (side * side)) * spacing + 2 * wall_gap;
    replica.plate.end = 0.9 * replica.plate.start;
    return {replica, packing};
}

}  // namespace mcdem::reference
