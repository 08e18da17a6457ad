#include "diagnose/observe/force_statistics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/container.h"
#include "core/least_squares.h"

namespace mcdem::inline diagnose {
namespace {

/// Quantile: the value below which a fraction `share` of the values lies.
double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return unknown;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double mean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? unknown : sum / static_cast<double>(values.size());
}

double part(std::span<const double> values, double low, double high) {
    const auto inside =
        std::ranges::count_if(values, [&](double value) { return value >= low && value < high; });
    return values.empty() ? unknown : static_cast<double>(inside) / static_cast<double>(values.size());
}

/// Slope of y over x.
double slope(std::span<const double> x, std::span<const double> y) {
    const double mean_x = mean(x), mean_y = mean(y);
    double xx = 0, xy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
    return xx > 0 ? xy / xx : unknown;
}

}  // namespace

std::array<double, 5> wall_loads(const Recording& recording, const Scan& scan) {
    const double half_x = 0.5 * recording.box.size_x, half_y = 0.5 * recording.box.size_y;
    double floor = 0, sides = 0, plate = 0, couple_x = 0, couple_y = 0;
    for (const Contact& contact : scan.contacts) {
        if (!is_wall(contact.partner)) continue;
        switch (wall_of(contact.partner)) {
            case Wall::floor:
                floor += contact.force.z();
                break;
            case Wall::plate: {
                const double normal_force = -contact.force.z();
                plate += normal_force;
                couple_x += normal_force * (contact.point.x() / half_x - 1);
                couple_y += normal_force * (contact.point.y() / half_y - 1);
                break;
            }
            default:
                sides += std::abs(contact.force.dot(
                             towards_wall(recording.box, wall_of(contact.partner), contact.point))) /
                         4;
        }
    }
    const double top = scan.top_force();
    if (!(top > 0) || !(plate > 0)) return {unknown, unknown, unknown, unknown, unknown};
    return {floor / top, sides / top, plate / top, couple_x / plate, couple_y / plate};
}

std::array<double, 7> force_distribution_numbers(const Recording& recording, const Scan& scan,
                                                 const ReferenceMaterial& material) {
    const double grains = static_cast<double>(recording.diameter.size());
    std::vector<double> forces;
    double sides = 0, weak = 0, square = 0;
    for (const Contact& contact : scan.contacts) {
        const double force = contact.force.norm();
        forces.push_back(force);
        square += force * force;
        sides += is_wall(contact.partner) ? 1 : 2;
        weak += force < 2 * material.force_threshold ? 1 : 0;
    }
    const double average = mean(forces);
    const double variance = square / static_cast<double>(forces.size()) - average * average;
    return {sides / grains,
            weak / grains,
            std::log(average),
            std::sqrt(std::max(variance, 0.0)) / average,
            part(forces, 0, 0.3 * average),
            part(forces, 2 * average, INFINITY),
            quantile(forces, 0.95) / average};
}

// Mean vertical force over all horizontal sections, over the plate's force. A force f on a grain at z from a
// neighbour at z' acts in all sections between them and contributes f (z - z') / height. Forces of the floor
// and side walls act below the grain, those of the plate above it.
double section_load(const Scan& scan) {
    const auto height = [&](int grain) { return scan.position[grain].z(); };
    double moment = 0;
    for (const Contact& contact : scan.contacts) {
        const double from = !is_wall(contact.partner)                 ? height(contact.partner)
                            : wall_of(contact.partner) == Wall::plate ? scan.plate_z
                                                                      : 0;
        moment += contact.force.z() * (height(contact.grain) - from);
    }
    const double top = scan.top_force();
    return top > 0 ? moment / (scan.plate_z * top) : unknown;
}

namespace {

/// Root mean square of the displacements since the first scan minus their best affine map, over the mean
/// diameter.
double non_affine_displacement(const Recording& recording, const Scan& scan) {
    const std::vector<Vec3>& before = recording.scans.front().position;
    if (before.size() != scan.position.size()) return unknown;
    Eigen::Matrix4d products = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Eigen::Vector4d x = before[i].homogeneous();
        products.noalias() += x * x.transpose();
        right.noalias() += x * (scan.position[i] - before[i]).transpose();
    }
    const Eigen::Matrix<double, 4, 3> map = least_squares(products, right);
    double square = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        square += (scan.position[i] - before[i] - map.transpose() * before[i].homogeneous()).squaredNorm();
    const double diameters = std::reduce(recording.diameter.begin(), recording.diameter.end());
    const double grains = static_cast<double>(before.size());
    return std::sqrt(square / grains) / (diameters / grains);
}

}  // namespace

std::array<double, 4> fabric(const Recording& recording, const Scan& scan,
                             std::span<const ContactResidual> contacts) {
    double total = 0, vertical = 0, pulls = 0;
    std::vector<double> height, force;
    for (const ContactResidual& c : contacts) {
        total += c.normal_force;
        vertical += c.normal_force * c.normal.z() * c.normal.z();
        pulls += c.normal_force < 0 ? 1 : 0;
        if (is_wall(c.partner)) continue;
        height.push_back(scan.position[c.grain].z() + 0.5 * recording.diameter[c.grain] * c.normal.z());
        force.push_back(c.normal_force);
    }
    return {vertical / total - 1.0 / 3, -slope(height, force) * scan.plate_z / mean(force),
            non_affine_displacement(recording, scan), pulls / static_cast<double>(contacts.size())};
}

namespace {

/// Sum over grains of |sum of torques| over the sum of |torque|: the torques on a grain at rest cancel.
double torque_imbalance(const Recording& recording, std::span<const ContactResidual> contacts) {
    std::vector<Vec3> torque(recording.diameter.size(), Vec3::Zero());
    std::vector<double> size(recording.diameter.size(), 0.0);
    const auto add = [&](int grain, const Vec3& outward, const Vec3& force) {
        const Vec3 turning = outward.cross(force);
        torque[grain] += turning;
        size[grain] += turning.norm();
    };
    for (const ContactResidual& c : contacts) {
        add(c.grain, c.normal, c.force);
        if (!is_wall(c.partner)) add(c.partner, -c.normal, -c.force);
    }
    double left = 0, all = 0;
    for (std::size_t grain = 0; grain < torque.size(); ++grain) {
        left += torque[grain].norm();
        all += size[grain];
    }
    return all > 0 ? left / all : unknown;
}

}  // namespace

std::array<double, 6> friction_numbers(const Recording& recording, const Scan&,
                                       std::span<const ContactResidual> contacts,
                                       const ReferenceMaterial& material) {
    std::vector<double> grains, walls;
    double pushes = 0;
    for (const ContactResidual& c : contacts) pushes += c.normal_force / static_cast<double>(contacts.size());
    // Weak contacts between hardly overlapping grains have the least accurate directions.
    for (const ContactResidual& c : contacts)
        if (c.normal_force > 0.3 * pushes)
            (is_wall(c.partner) ? walls : grains).push_back(c.tangential / c.normal_force);
    const double mu = material.friction;
    const double sliding = mu > 0 ? part(grains, 0.8 * mu, 1.2 * mu) : unknown;
    const double grain_mean = mean(grains), wall_mean = mean(walls);
    return {grain_mean, quantile(grains, 0.8), sliding,
            wall_mean,  quantile(walls, 0.8),  torque_imbalance(recording, contacts)};
}

}  // namespace mcdem::diagnose
