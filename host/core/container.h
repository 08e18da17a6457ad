// Container shapes: which walls exist and where, and distances in periodic containers.
#pragma once
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "core/packing.h"

namespace mcdem::inline core {

/// The curved wall of a cylinder has the number of x_min. Its other three side walls do not exist; neither do
/// the four of a periodic cell.
inline constexpr Wall curved_wall = Wall::x_min;

constexpr bool is_cell(const Box& box) { return box.shape == ContainerShape::cell; }
/// Along x and y.
constexpr bool is_periodic(const Box& box) { return box.shape == ContainerShape::periodic || is_cell(box); }
constexpr bool is_cylinder(const Box& box) { return box.shape == ContainerShape::cylinder; }

constexpr bool has_wall(const Box& box, Wall wall) {
    if (is_cell(box)) return false;
    if (wall == Wall::floor || wall == Wall::plate || box.shape == ContainerShape::box) return true;
    return is_cylinder(box) && wall == curved_wall;
}

constexpr double cylinder_radius(const Box& box) { return box.size_x / 2; }

/// Area of the floor over size_x size_y.
constexpr double floor_share(const Box& box) { return is_cylinder(box) ? std::numbers::pi / 4 : 1; }

/// Area of the floor [m2].
constexpr double floor_area(const Box& box) { return box.size_x * box.size_y * floor_share(box); }

/// Horizontal vector from a cylinder's axis to the point [m].
inline Vec3 from_axis(const Box& box, const Vec3& point) {
    return {point.x() - box.size_x / 2, point.y() - box.size_y / 2, 0};
}

/// Subtracts whole edges of a periodic cell from a point; `whole` rounds a coordinate in units of the edge. A
/// cell may be tilted, so the edge along z is subtracted first.
template <class Whole>
inline Vec3 less_whole_edges(const Box& box, Vec3 point, const Whole& whole) {
    if (is_cell(box)) point -= whole(point.z() / box.height) * Vec3(box.tilt_xz, box.tilt_yz, box.height);
    point -= whole(point.y() / box.size_y) * Vec3(box.tilt_xy, box.size_y, 0);
    point.x() -= whole(point.x() / box.size_x) * box.size_x;
    return point;
}

/// Vector between two points; in a periodic cell to the nearest image [m].
inline Vec3 apart(const Box& box, const Vec3& from, const Vec3& to) {
    const Vec3 apart = to - from;
    if (!is_periodic(box)) return apart;
    return less_whole_edges(box, apart, [](double edges) { return std::nearbyint(edges); });
}

/// The image of a point inside the periodic cell; in other containers the point itself. For a tilted cell the
/// equivalent upright cell with the same lengths is used.
inline Vec3 into_cell(const Box& box, Vec3 point) {
    if (!is_periodic(box)) return point;
    point = less_whole_edges(box, point, [](double edges) { return std::floor(edges); });
    const Vec3 size(box.size_x, box.size_y, is_cell(box) ? box.height : HUGE_VAL);
    for (int axis = 0; axis < 3; ++axis)
        if (!(point[axis] < size[axis])) point[axis] = 0;  // rounding
    return point;
}

/// Deformation gradient of a strain: upper triangular.
inline Mat3 deformation(const Strain& strain) {
    Mat3 f;
    f << 1 - strain[0], strain[3], strain[4], 0, 1 - strain[1], strain[5], 0, 0, 1 - strain[2];
    return f;
}

inline Mat3 inverse_deformation(const Strain& strain) {
    return deformation(strain).triangularView<Eigen::Upper>().solve(Mat3::Identity());
}

/// Velocity gradient of a cell's own motion [1/s].
inline Mat3 velocity_gradient(const Strain& strain, const Strain& rate) {
    return (deformation(rate) - Mat3::Identity()) * inverse_deformation(strain);
}

/// The cell with initial shape `box` at this strain; other containers are returned unchanged.
inline Box deformed(const Box& box, const Strain& strain) {
    if (!is_cell(box)) return box;
    Box now = box;
    now.size_x *= 1 - strain[0];
    now.size_y *= 1 - strain[1];
    now.height *= 1 - strain[2];
    now.tilt_xy = strain[3] * box.size_y;
    now.tilt_xz = strain[4] * box.height;
    now.tilt_yz = strain[5] * box.height;
    return now;
}

/// Unit normal from a point inside towards an existing wall.
inline Vec3 towards_wall(const Box& box, Wall wall, const Vec3& point) {
    if (is_cylinder(box) && wall == curved_wall) {
        const Vec3 out = from_axis(box, point);
        return out.norm() > 0 ? Vec3(out.normalized()) : Vec3::UnitX();
    }
    const int number = static_cast<int>(wall);
    return (number % 2 ? 1 : -1) * Vec3::Unit(number / 2);
}

/// R* of a sphere at an existing wall [m]. Inside a cylinder 1/R* = sqrt(1/R (1/R - 1/R_c)), the
/// geometric mean of both directions (Johnson 1985, section 4.2).
inline double reduced_radius(const Box& box, Wall wall, double radius) {
    if (!(is_cylinder(box) && wall == curved_wall)) return radius;
    return radius / std::sqrt(1 - radius / cylinder_radius(box));
}

/// Distance of a point from an existing wall, negative outside; the plate is level at plate_z [m].
inline double wall_distance(const Box& box, Wall wall, double plate_z, const Vec3& point) {
    if (is_cylinder(box) && wall == curved_wall) return cylinder_radius(box) - from_axis(box, point).norm();
    const double positions[wall_count] = {0, box.size_x, 0, box.size_y, 0, plate_z};
    const int number = static_cast<int>(wall);
    const double wall_at = positions[number], coordinate = point[number / 2];
    return number % 2 ? wall_at - coordinate : coordinate - wall_at;
}

}  // namespace mcdem::core
