#include "io/vtk_walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/container.h"

namespace mcdem::inline io {
namespace {

constexpr int sides = 64;  ///< of the polygon that approximates a circle

/// The floor's corners, counterclockwise as seen from above.
std::vector<Vec3> corners_of(const Box& box) {
    if (!is_cylinder(box))
        return {{0, 0, 0}, {box.size_x, 0, 0}, {box.size_x, box.size_y, 0}, {0, box.size_y, 0}};
    std::vector<Vec3> corners;
    for (int n = 0; n < sides; ++n) {
        const double angle = 2 * std::numbers::pi * n / sides;
        corners.push_back(cylinder_radius(box) * Vec3(1 + std::cos(angle), 1 + std::sin(angle), 0));
    }
    return corners;
}

/// The wall above the edge from corner n to the next one; -1: none.
int wall_over(const Box& box, std::size_t n) {
    if (is_cylinder(box)) return static_cast<int>(curved_wall);
    if (is_periodic(box)) return -1;
    constexpr Wall walls[]{Wall::y_min, Wall::x_max, Wall::y_max, Wall::x_min};
    return static_cast<int>(walls[n]);
}

class Builder {
public:
    explicit Builder(const Box& box) : corners_(corners_of(box)), box_(box) {}

    void level(Wall wall, double height) {
        std::vector<Vec3> face = corners_;
        for (Vec3& corner : face) corner.z() = height;
        add(VtkCell::polygon, static_cast<int>(wall), face);
    }
    void edges_at(double height) {
        const Vec3 up(0, 0, height);
        for (std::size_t n = 0; n < corners_.size(); ++n)
            add(VtkCell::line, -1, {corners_[n] + up, next(n) + up});
    }
    /// Side walls, or vertical edges if there are none.
    void upright(double height) {
        const Vec3 up(0, 0, height);
        for (std::size_t n = 0; n < corners_.size(); ++n) {
            const Vec3 &here = corners_[n], &there = next(n);
            if (const int wall = wall_over(box_, n); wall >= 0)
                add(VtkCell::polygon, wall, {here, there, there + up, here + up});
            else
                add(VtkCell::line, -1, {here, here + up});
        }
    }
    VtkWalls made;

private:
    const Vec3& next(std::size_t n) const { return corners_[(n + 1) % corners_.size()]; }
    void add(VtkCell type, int wall, const std::vector<Vec3>& corners) {
        made.cells.add(type, corners);
        made.wall.push_back(wall);
    }
    std::vector<Vec3> corners_;
    Box box_;
};

}  // namespace

VtkWalls vtk_walls(const Recording& recording, const Scan& scan) {
    const Box now = deformed(recording.box, scan.strain);
    Builder walls(now);
    if (is_cell(now)) {
        walls.upright(now.height);
        walls.edges_at(0);
        walls.edges_at(now.height);
        return walls.made;
    }
    walls.upright(std::max(recording.plate_start, scan.plate_z));
    walls.level(Wall::floor, 0);
    walls.level(Wall::plate, scan.plate_z);
    return walls.made;
}

}  // namespace mcdem::io
