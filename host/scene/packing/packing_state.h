// Overlaps and contacts of an initial packing.
#pragma once
#include "core/packing.h"
#include "scene/plate_face.h"

namespace mcdem::inline scene {

struct PackingState {
    double coordination_number = 0;  ///< contacts per grain, including those with walls and plate
    double deepest_overlap = 0;      ///< [m]
    double relative_overlap = 0;     ///< deepest overlap over the diameter of the smaller grain
};

PackingState packing_state(const Packing& packing, const Box& box, const PlateFace& plate);

struct DeepestPair {
    std::size_t first = 0, second = 0;  ///< grains
    double overlap = 0;                 ///< relative (core/law_range.h)
};

/// The two grains that overlap most, without walls, among those at most four median diameters apart: one
/// grain with an absurd diameter must not make every pair a neighbour. `height` of the container [m].
DeepestPair deepest_pair(const Packing& packing, const Box& box, double height);

struct MostNeighbours {
    std::size_t grain = 0, count = 0;
};

/// The grain with the most grains and walls, without the plate, closer than `gap` [m] to its surface, as in a
/// neighbour list. Grains more than ten median diameters apart are not counted. `height` as above.
MostNeighbours most_neighbours(const Packing& packing, const Box& box, double height, double gap);

/// Gap between the surfaces of two grains of the packing, or to a wall, up to which they are in a neighbour
/// list [m].
double list_gap(const Numerics& numerics, const Packing& packing);

}  // namespace mcdem::scene
