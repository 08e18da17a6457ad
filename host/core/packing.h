// A packing: where the grains are and how large. Index in the vectors = the user's grain number.
#pragma once
#include <vector>

#include "core/vec3.h"

namespace mcdem::inline core {

struct Packing {
    std::vector<Vec3> position;    ///< centres [m]
    std::vector<double> diameter;  ///< [m]
    std::size_t size() const { return position.size(); }
};

/// Box with walls at x = 0 and size_x, y = 0 and size_y, floor z = 0; the plate closes it above.
struct Box {
    double size_x = 0;  ///< [m]
    double size_y = 0;  ///< [m]
};

}  // namespace mcdem::core
