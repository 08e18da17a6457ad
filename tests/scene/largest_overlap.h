// Largest overlap in a packing.
#pragma once
#include <algorithm>

#include "core/container.h"
#include "core/near_pairs.h"

namespace mcdem {

/// Largest overlap of two grains, or of a grain and a wall, over the radius of the smaller grain.
inline double largest_overlap(const Packing& packing, const Box& box, double height) {
    double most = 0;
    for (std::size_t i = 0; i < packing.size(); ++i) {
        const double radius = packing.diameter[i] / 2;
        for (int wall = 0; wall < wall_count; ++wall)
            if (has_wall(box, static_cast<Wall>(wall)))
                most = std::max(most, (radius - wall_distance(box, static_cast<Wall>(wall), height,
                                                              packing.position[i])) /
                                          radius);
    }
    const NeighbourGrid grid(packing.position, box, height, std::ranges::max(packing.diameter));
    grid.for_each_pair([&](int i, int j) {
        const double reach = (packing.diameter[i] + packing.diameter[j]) / 2;
        const double distance = apart(box, packing.position[i], packing.position[j]).norm();
        most = std::max(most, 2 * (reach - distance) / std::min(packing.diameter[i], packing.diameter[j]));
    });
    return most;
}

}  // namespace mcdem
