// A packing: where the grains are and how large. Index in the vectors = the user's grain number.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/names.h"
#include "core/vec3.h"

namespace mcdem::inline core {

struct Packing {
    std::vector<Vec3> position;     ///< centres [m]
    std::vector<double> diameter;   ///< [m]
    std::vector<int> species = {};  ///< from 0; empty where all grains are alike or nothing is known of it
    std::vector<std::string> species_names = {};  ///< as a file has them, names or numbers
    std::size_t size() const { return position.size(); }
    std::size_t species_of(std::size_t grain) const {
        return species.empty() ? 0 : static_cast<std::size_t>(species[grain]);
    }
};

/// What holds the grains: floor z = 0, the plate above, and at the sides what `shape` says. A box has walls
/// at x = 0 and size_x, y = 0 and size_y. A cylinder touches these four planes: both sizes are its diameter.
/// A periodic cell repeats with these sizes; a `cell` along z too, with edges (size_x, 0, 0), (tilt_xy,
/// size_y, 0) and (tilt_xz, tilt_yz, height). What has which walls: core/container.h.
struct Box {
    double size_x = 0;  ///< [m]
    double size_y = 0;  ///< [m]
    ContainerShape shape = ContainerShape::box;
    double height = 0;                             ///< of a cell alone, as are tilts [m]
    double tilt_xy = 0, tilt_xz = 0, tilt_yz = 0;  ///< [m]
};

/// Of a cell, over its lengths at start: compression along x, y and z, then the shears xy, xz and yz, where
/// xy moves what is higher along y towards x.
using Strain = std::array<double, 6>;

}  // namespace mcdem::core
