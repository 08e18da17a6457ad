// Containers of every shape: which walls they have and where, and what is near whom in a periodic one.
#pragma once
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/packing.h"

namespace mcdem::inline core {

/// A cylinder's curved wall has the number of x_min; its other three and a periodic cell's four are not
/// there.
inline constexpr Wall curved_wall = Wall::x_min;

constexpr bool is_periodic(const Box& box) { return box.shape == ContainerShape::periodic; }
constexpr bool is_cylinder(const Box& box) { return box.shape == ContainerShape::cylinder; }

constexpr bool has_wall(const Box& box, Wall wall) {
    if (wall == Wall::floor || wall == Wall::plate || box.shape == ContainerShape::box) return true;
    return is_cylinder(box) && wall == curved_wall;
}

/// As words for readers have it: "side" in a cylinder.
constexpr std::string_view wall_name(const Box& box, Wall wall) {
    return is_cylinder(box) && wall == curved_wall ? "side" : name(wall);
}

constexpr double cylinder_radius(const Box& box) { return box.size_x / 2; }

/// Area of the floor over size_x size_y.
constexpr double floor_share(const Box& box) { return is_cylinder(box) ? std::numbers::pi / 4 : 1; }

/// [m2]
constexpr double floor_area(const Box& box) { return box.size_x * box.size_y * floor_share(box); }

/// The horizontal vector from a cylinder's axis [m].
inline Vec3 from_axis(const Box& box, const Vec3& point) {
    return {point.x() - box.size_x / 2, point.y() - box.size_y / 2, 0};
}

/// From one point to another, or to its nearest image in a periodic cell [m].
inline Vec3 apart(const Box& box, const Vec3& from, const Vec3& to) {
    Vec3 apart = to - from;
    if (!is_periodic(box)) return apart;
    apart.x() -= box.size_x * std::nearbyint(apart.x() / box.size_x);
    apart.y() -= box.size_y * std::nearbyint(apart.y() / box.size_y);
    return apart;
}

/// The image of a point that lies in the periodic cell itself; the point in others.
inline Vec3 into_cell(const Box& box, Vec3 point) {
    if (!is_periodic(box)) return point;
    const auto wrapped = [](double x, double size) {
        const double inside = x - size * std::floor(x / size);
        return inside < size ? inside : 0;  // rounding
    };
    point.x() = wrapped(point.x(), box.size_x);
    point.y() = wrapped(point.y(), box.size_y);
    return point;
}

/// The foot of the perpendicular on a wall that is there, the plate level at plate_z.
inline Vec3 wall_foot(const Box& box, Wall wall, double plate_z, const Vec3& point) {
    if (is_cylinder(box) && wall == curved_wall) {
        const Vec3 out = from_axis(box, point);
        const double distance = out.norm();
        return point +
               (cylinder_radius(box) - distance) * (distance > 0 ? Vec3(out / distance) : Vec3::UnitX());
    }
    const double places[wall_count] = {0, box.size_x, 0, box.size_y, 0, plate_z};
    Vec3 foot = point;
    foot[static_cast<int>(wall) / 2] = places[static_cast<int>(wall)];
    return foot;
}

/// From a wall to a point inside, negative outside [m].
inline double wall_distance(const Box& box, Wall wall, double plate_z, const Vec3& point) {
    if (is_cylinder(box) && wall == curved_wall) return cylinder_radius(box) - from_axis(box, point).norm();
    const int number = static_cast<int>(wall);
    const double place = wall_foot(box, wall, plate_z, point)[number / 2], coordinate = point[number / 2];
    return number % 2 ? place - coordinate : coordinate - place;
}

}  // namespace mcdem::core
