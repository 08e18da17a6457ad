// The plate's lower face: a plane that may be tilted about the centre of the box.
#pragma once
#include "scene/scene.h"

namespace mcdem::inline scene {

struct PlateFace {
    double z = 0;                       ///< at the centre of the box [m]
    double tilt_x = 0, tilt_y = 0;      ///< slopes
    double middle_x = 0, middle_y = 0;  ///< centre of the box [m]

    double height(const Vec3& point) const {
        return z + tilt_x * (point.x() - middle_x) + tilt_y * (point.y() - middle_y);
    }
    /// Unit normal, out of the box.
    Vec3 normal() const { return Vec3(-tilt_x, -tilt_y, 1).normalized(); }
    /// Foot of the perpendicular from a point.
    Vec3 foot(const Vec3& point) const {
        const Vec3 n = normal();
        return point + (height(point) - point.z()) * n.z() * n;
    }
};

/// The face with its centre at `z` [m].
inline PlateFace plate_face(const Replica& replica, double z) {
    return {z, replica.effects.plate_tilt_x, replica.effects.plate_tilt_y, replica.box.size_x / 2,
            replica.box.size_y / 2};
}

}  // namespace mcdem::scene
