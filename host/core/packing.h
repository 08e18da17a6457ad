// A packing: where the grains are and how large. Index in the vectors = the user's grain number.
#pragma once
#include <vector>

#include "core/names.h"
#include "core/vec3.h"

namespace mcdem::inline core {

struct Packing {
    std::vector<Vec3> position;    ///< centres [m]
    std::vector<double> diameter;  ///< [m]
    std::size_t size() const { return position.size(); }
};

/// What holds the grains: floor z = 0, the plate above, and at the sides what `shape` says. A box has walls
/// at x = 0 and size_x, y = 0 and size_y. A cylinder touches these four planes: both sizes are its diameter.
/// A periodic cell repeats with these sizes. What has which walls: core/container.h.
struct Box {
    double size_x = 0;  ///< [m]
    double size_y = 0;  ///< [m]
    ContainerShape shape = ContainerShape::box;
};

}  // namespace mcdem::core
