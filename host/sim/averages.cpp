#include "sim/averages.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace mcdem::inline sim {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Points that fill the unit ball evenly: a golden-angle spiral, its radii from a sequence of their own.
const std::vector<Vec3>& ball_points() {
    static const std::vector<Vec3> points = [] {
        constexpr int count = 512;
        std::vector<Vec3> all;
        for (int k = 0; k < count; ++k) {
            const double z = 1 - (2 * k + 1.0) / count;
            const double angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
            const double shell = std::cbrt(std::fmod((k + 0.5) * std::numbers::sqrt2, 1.0));
            const double rim = std::sqrt(1 - z * z);
            all.push_back(shell * Vec3(rim * std::cos(angle), rim * std::sin(angle), z));
        }
        return all;
    }();
    return points;
}

double part_inside(const Vec3& centre, double radius, const Vec3& low, const Vec3& high) {
    if (((centre.array() - radius) >= low.array()).all() && ((centre.array() + radius) <= high.array()).all())
        return 1;
    if (((centre.array() + radius) <= low.array()).any() || ((centre.array() - radius) >= high.array()).any())
        return 0;
    int inside = 0;
    for (const auto& point : ball_points()) {
        const Vec3 at = centre + radius * point;
        inside += (at.array() > low.array()).all() && (at.array() < high.array()).all();
    }
    return static_cast<double>(inside) / ball_points().size();
}

}  // namespace

double packing_fraction(const std::vector<Vec3>& position, const std::vector<double>& diameter,
                        const Box& box, double plate_z) {
    const double mean = std::accumulate(diameter.begin(), diameter.end(), 0.0) / diameter.size();
    const Vec3 low = Vec3::Constant(mean);
    const Vec3 high = Vec3(box.size_x, box.size_y, plate_z) - low;
    if (!((high - low).array() > 0).all()) return not_a_number;
    double volume = 0;
    for (std::size_t i = 0; i < position.size(); ++i)
        volume += std::numbers::pi / 6 * std::pow(diameter[i], 3) *
                  part_inside(position[i], 0.5 * diameter[i], low, high);
    return volume / (high - low).prod();
}

void fill_averages(Scan& scan, const Box& box, const std::vector<double>& diameter, double force_threshold) {
    int ends = 0, contacts = 0, pairs = 0;
    double force = 0, branch = 0;
    for (const auto& contact : scan.contacts) {
        const double size = contact.force.norm();
        if (size < force_threshold) continue;
        ++contacts;
        force += size;
        ends += is_wall(contact.partner) ? 1 : 2;
        if (is_wall(contact.partner)) continue;
        ++pairs;
        branch += (scan.position[contact.partner] - scan.position[contact.grain]).norm();
    }
    scan.coordination_number = static_cast<double>(ends) / diameter.size();
    scan.mean_force = contacts ? force / contacts : not_a_number;
    scan.branch_length = pairs ? branch / pairs : not_a_number;
    scan.packing_fraction = packing_fraction(scan.position, diameter, box, scan.plate_z);
}

}  // namespace mcdem::sim
