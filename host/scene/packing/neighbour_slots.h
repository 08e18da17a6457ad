// Number of neighbour slots per grain that a packing needs.
#pragma once
#include <algorithm>
#include <cstddef>

#include "scene/packing/packing_state.h"
#include "scene/scene.h"

namespace mcdem::inline scene {

/// Maximum of numerics.slots.
inline constexpr int most_slots = 64;
inline constexpr auto widest_sizes =
    "it suffices for grains up to about six times as wide as those around them, so take grains of more "
    "similar "
    "sizes";

/// The smallest of 16, 32, 48 and 64 that holds this many; the last if none does.
inline int slots_for(double neighbours) {
    return std::clamp(16 * static_cast<int>((neighbours + 15) / 16), 16, most_slots);
}

/// Slots for a packing in which a grain has this many near neighbours; a quarter more if they are many,
/// because grains move.
inline int slots_of_packing(std::size_t most_neighbours) {
    const auto count = static_cast<double>(most_neighbours);
    return slots_for(count <= 16 ? count : 1.25 * count);
}

/// The same for the packing of a replica.
inline int slots_of(const Replica& replica, const Packing& packing) {
    return slots_of_packing(
        most_neighbours(packing, replica.box, replica.plate.start, list_gap(replica.numerics, packing))
            .count);
}

/// Estimated number of near neighbours of the largest grain among grains of the mean diameter. These cover
/// two thirds of the sphere on which their centres lie, and more come with a wider list.
inline double expected_neighbours(double mean_diameter, double largest_diameter, const Numerics& numerics) {
    const double centres = 1 + largest_diameter / mean_diameter;  // distance over the mean radius
    const Numerics usual;
    const double wider =
        (centres + numerics.probe_gap + numerics.skin) / (centres + usual.probe_gap + usual.skin);
    return 2.7 * centres * centres * wider * wider * wider;
}

}  // namespace mcdem::scene
