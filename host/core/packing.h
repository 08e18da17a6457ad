// A packing: positions and diameters of grains, their initial motion and friction. The index in the vectors
// is the user's grain number.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/names.h"
#include "core/vec3.h"

namespace mcdem::inline core {

/// Tangential force of a contact in the state from which a packing was taken.
struct TangentialForce {
    int grain = 0;
    int partner = 0;            ///< a grain, or a wall (core/recording.h)
    Vec3 force = Vec3::Zero();  ///< on `grain` [N]
};

struct Packing {
    std::vector<Vec3> position;                   ///< centres [m]
    std::vector<double> diameter;                 ///< [m]
    std::vector<int> species = {};                ///< from 0; empty if there is one species, or it is unknown
    std::vector<std::string> species_names = {};  ///< names or numbers, as in the file
    std::vector<Vec3> velocity = {};              ///< half a step before the start [m/s]; empty: at rest
    std::vector<Vec3> angular_velocity = {};      ///< the same [1/s]
    std::vector<TangentialForce> tangential = {};  ///< friction springs start with it; empty: they start anew
    std::size_t size() const { return position.size(); }
    std::size_t species_of(std::size_t grain) const {
        return species.empty() ? 0 : static_cast<std::size_t>(species[grain]);
    }
};

/// The container: floor at z = 0, the plate above, and at the sides as `shape` says. A box has walls at x = 0
/// and size_x, y = 0 and size_y. A cylinder touches these four planes: both sizes are its diameter. A
/// periodic cell has these sizes as periods; a `cell` is also periodic along z, with edges (size_x, 0, 0),
/// (tilt_xy, size_y, 0) and (tilt_xz, tilt_yz, height). core/container.h says which walls exist.
struct Box {
    double size_x = 0;  ///< [m]
    double size_y = 0;  ///< [m]
    ContainerShape shape = ContainerShape::box;
    double height = 0;                             ///< only of a cell, as are the tilts [m]
    double tilt_xy = 0, tilt_xz = 0, tilt_yz = 0;  ///< [m]
};

/// Strain of a cell relative to its initial lengths: compression along x, y and z, then the shears xy, xz and
/// yz. A positive xy moves points with larger y towards +x.
using Strain = std::array<double, 6>;

}  // namespace mcdem::core
