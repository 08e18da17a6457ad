#include "core/stress.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/container.h"
#include "core/errors.h"

namespace mcdem::inline core {
namespace {

/// Vector from the centre of a grain to the contact point; `grain` is one of the contact's two grains.
Vec3 arm(const Box& box, const Scan& scan, const Contact& contact, int grain) {
    return apart(box, scan.position[grain], contact.point);
}

/// For each grain, minus the sum over its contacts of arm times force [N m].
std::vector<Mat3> moments(const Box& box, const Scan& scan) {
    std::vector<Mat3> sums(scan.position.size(), Mat3::Zero());
    for (const Contact& contact : scan.contacts) {
        sums[contact.grain] -= arm(box, scan, contact, contact.grain) * contact.force.transpose();
        if (!is_wall(contact.partner))
            sums[contact.partner] += arm(box, scan, contact, contact.partner) * contact.force.transpose();
    }
    return sums;
}

}  // namespace

std::vector<Mat3> grain_stress(const Box& box, const std::vector<double>& diameter, const Scan& scan) {
    if (scan.position.size() != diameter.size())
        throw InputError(
            "the stress of grains needs the grains' positions: run with output.positions = true, and read "
            "everything");
    if (!scan.knows_contacts())
        throw InputError(
            "the stress of grains needs the contacts: run with output.contacts = true, and read everything");
    std::vector<Mat3> stress = moments(deformed(box, scan.strain), scan);
    for (std::size_t i = 0; i < stress.size(); ++i)
        stress[i] /= std::numbers::pi / 6 * std::pow(diameter[i], 3);
    return stress;
}

Mat3 packing_stress(const Box& box, const Scan& scan) {
    Mat3 sum = Mat3::Zero();
    const Box now = deformed(box, scan.strain);
    for (const Mat3& moment : moments(now, scan)) sum += moment;
    return sum / (floor_area(now) * scan.plate_z);
}

std::array<Vec3, wall_count> face_forces(const Box& now, const Mat3& stress) {
    const Vec3 edges[]{
        {now.size_x, 0, 0}, {now.tilt_xy, now.size_y, 0}, {now.tilt_xz, now.tilt_yz, now.height}};
    std::array<Vec3, wall_count> forces = no_wall_forces();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Vec3 area = edges[(axis + 1) % 3].cross(edges[(axis + 2) % 3]);
        forces[2 * axis + 1] = stress.transpose() * area;
        forces[2 * axis] = -forces[2 * axis + 1];
    }
    return forces;
}

Mat3 packing_fabric(const Box& box, const Scan& scan) {
    Mat3 sum = Mat3::Zero();
    int pairs = 0;
    const Box now = deformed(box, scan.strain);
    for (const Contact& contact : scan.contacts) {
        if (is_wall(contact.partner)) continue;
        const Vec3 n = apart(now, scan.position[contact.grain], scan.position[contact.partner]).normalized();
        sum += n * n.transpose();
        ++pairs;
    }
    return pairs > 0 ? Mat3(sum / pairs) : unknown_tensor();
}

}  // namespace mcdem::core
