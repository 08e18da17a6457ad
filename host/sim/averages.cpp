#include "sim/averages.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/container.h"
#include "core/law_range.h"
#include "core/stress.h"

namespace mcdem::inline sim {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Points evenly distributed in the unit ball: a golden-angle spiral with radii from a separate sequence.
struct BallPoints {
    static constexpr int count = 512;
    using Some = std::bitset<count>;
    std::vector<Vec3> all;
    std::array<std::vector<double>, 3> sorted;  ///< coordinates along each axis, ascending
    std::array<std::vector<Some>, 3> lowest;    ///< the points of the n lowest coordinates along each axis

    BallPoints() {
        for (int k = 0; k < count; ++k) {
            const double z = 1 - (2 * k + 1.0) / count;
            const double angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
            const double shell = std::cbrt(std::fmod((k + 0.5) * std::numbers::sqrt2, 1.0));
            const double rim = std::sqrt(1 - z * z);
            all.push_back(shell * Vec3(rim * std::cos(angle), rim * std::sin(angle), z));
        }
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<std::size_t> order(count);
            std::iota(order.begin(), order.end(), 0);
            std::ranges::sort(order, {}, [&](std::size_t k) { return all[k][axis]; });
            lowest[axis].emplace_back();
            for (const std::size_t k : order) {
                sorted[axis].push_back(all[k][axis]);
                lowest[axis].push_back(lowest[axis].back());
                lowest[axis].back().set(k);
            }
        }
    }

    /// Those between two coordinates of a sphere's axis.
    Some between(double low, double high, int axis, double centre, double radius) const {
        const auto& all = sorted[axis];
        const auto number_until = [&](auto is_before) {
            return std::ranges::partition_point(all,
                                                [&](double x) { return is_before(centre + radius * x); }) -
                   all.begin();
        };
        return lowest[axis][number_until([&](double at) { return at < high; })] &
               ~lowest[axis][number_until([&](double at) { return !(at > low); })];
    }
};

/// The region farther than a margin from every wall.
class Interior {
public:
    Interior(const Box& box, double plate_z, double margin)
        : box_(box),
          low_(is_periodic(box) ? Vec3(-unlimited, -unlimited, margin) : Vec3::Constant(margin)),
          high_(is_periodic(box) ? Vec3(unlimited, unlimited, plate_z - margin)
                                 : Vec3(Vec3(box.size_x, box.size_y, plate_z) - low_)),
          radius_(is_cylinder(box) ? cylinder_radius(box) - margin : unlimited) {}

    bool empty() const { return !((high_ - low_).array() > 0).all(); }

    double volume() const {
        if (is_periodic(box_)) return box_.size_x * box_.size_y * (high_.z() - low_.z());
        return (high_ - low_).prod() * floor_share(box_);
    }

    /// Fraction of a sphere's volume inside the region.
    double part_inside(const Vec3& centre, double radius) const {
        const double out = from_axis(box_, centre).norm();
        const Vec3 first = centre.array() - radius, last = centre.array() + radius;
        if ((last.array() <= low_.array()).any() || (first.array() >= high_.array()).any() ||
            out - radius >= radius_)
            return 0;
        static const BallPoints points;
        BallPoints::Some inside = BallPoints::Some().set();
        for (int k = 0; k < 3; ++k)
            if (first[k] < low_[k] || last[k] > high_[k])
                inside &= points.between(low_[k], high_[k], k, centre[k], radius);
        if (out + radius > radius_)
            for (std::size_t k = 0; k < points.all.size(); ++k)
                if (!(from_axis(box_, centre + radius * points.all[k]).norm() < radius_)) inside.reset(k);
        return static_cast<double>(inside.count()) / BallPoints::count;
    }

private:
    static constexpr double unlimited = std::numeric_limits<double>::infinity();
    Box box_;
    Vec3 low_, high_;
    double radius_;
};

double grain_volume(const std::vector<double>& diameter) {
    double volume = 0;
    for (const double d : diameter) volume += std::numbers::pi / 6 * std::pow(d, 3);
    return volume;
}

}  // namespace

double packing_fraction(const std::vector<Vec3>& position, const std::vector<double>& diameter,
                        const Box& box, double plate_z) {
    if (is_cell(box)) return grain_volume(diameter) / (floor_area(box) * box.height);
    const double mean = std::accumulate(diameter.begin(), diameter.end(), 0.0) / diameter.size();
    const Interior interior(box, plate_z, mean);
    if (interior.empty()) return not_a_number;
    double volume = 0;
    for (std::size_t i = 0; i < position.size(); ++i)
        if (const double part = interior.part_inside(position[i], 0.5 * diameter[i]); part > 0)
            volume += std::numbers::pi / 6 * std::pow(diameter[i], 3) * part;
    return volume / interior.volume();
}

void fill_averages(Scan& scan, const Box& box, const std::vector<double>& diameter, double force_threshold) {
    const Box now = deformed(box, scan.strain);
    int ends = 0, contacts = 0, pairs = 0;
    double force = 0, branch = 0;
    scan.max_overlap = 0;
    for (const auto& contact : scan.contacts) {
        double distance = 0;
        if (!is_wall(contact.partner)) {
            distance = apart(now, scan.position[contact.grain], scan.position[contact.partner]).norm();
            const double one = diameter[contact.grain] / 2, other = diameter[contact.partner] / 2;
            scan.max_overlap =
                std::max(scan.max_overlap, relative_overlap(one + other - distance, one, other));
        }
        const double size = contact.force.norm();
        if (size < force_threshold) continue;
        ++contacts;
        force += size;
        ends += is_wall(contact.partner) ? 1 : 2;
        pairs += !is_wall(contact.partner);
        branch += distance;
    }
    scan.coordination_number = static_cast<double>(ends) / diameter.size();
    scan.mean_force = contacts ? force / contacts : not_a_number;
    scan.branch_length = pairs ? branch / pairs : not_a_number;
    scan.stress = packing_stress(box, scan);
    scan.fabric = packing_fabric(box, scan);
    scan.packing_fraction = packing_fraction(scan.position, diameter, now, scan.plate_z);
}

}  // namespace mcdem::sim
