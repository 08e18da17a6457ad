#include "diagnose/observe/contact_residuals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/container.h"

namespace mcdem::inline diagnose {
namespace {

/// A contact from the side of one grain.
struct Side {
    int contact;
    Vec3 direction;  ///< outward from the grain's centre
    double normal_force;
};

/// Outward displacement, over (1 + nu) F/(4 pi E R), of the surface at an angle from a force: the paper's Eq.
/// 1 with both points on the undeformed sphere (Gonzalez & Cuitino 2012), s = sin(theta / 2).
double displacement_on_sphere(double cosine, double nu) {
    const double s = std::sqrt(
        std::max(0.5 * (1 - cosine), 0.0225));  // contacts closer than 17 degrees are measurement errors
    return (-2 * (1 - nu) - 2 * (1 - 2 * nu) * s + (7 - 8 * nu) * s * s) / s;
}

class Residuals {
public:
    Residuals(const Recording& recording, const Scan& scan, const ReferenceMaterial& material)
        : recording_(recording), scan_(scan), material_(material) {}

    std::vector<ContactResidual> all() {
        sides_.resize(recording_.diameter.size());
        list_.reserve(scan_.contacts.size());
        for (const Contact& contact : scan_.contacts) add(contact);
        for (std::size_t grain = 0; grain < sides_.size(); ++grain) displace(grain);
        return std::move(list_);
    }

private:
    double radius(int grain) const { return 0.5 * recording_.diameter[grain]; }
    const Vec3& position(int grain) const { return scan_.position[grain]; }

    void add(const Contact& contact) {
        ContactResidual c;
        c.grain = contact.grain;
        c.partner = contact.partner;
        c.force = contact.force;
        const double gap = is_wall(contact.partner) ? meet_wall(c) : meet_grain(c);
        c.normal_force = -c.force.dot(c.normal);
        c.tangential = (c.force + c.normal_force * c.normal).norm();
        const double modulus = reduced_modulus(is_wall(contact.partner));
        const double size =
            3 * std::abs(c.normal_force) / (4 * modulus * c.reduced_radius * c.reduced_radius);
        c.implied = std::copysign(std::cbrt(size * size), c.normal_force);
        c.measured = -gap / c.reduced_radius;
        const int index = static_cast<int>(list_.size());
        sides_[c.grain].push_back({index, c.normal, c.normal_force});
        if (!is_wall(c.partner)) sides_[c.partner].push_back({index, -c.normal, c.normal_force});
        list_.push_back(c);
    }

    double meet_grain(ContactResidual& c) const {
        const Vec3 between = apart(recording_.box, position(c.grain), position(c.partner));
        const double distance = between.norm(), here = radius(c.grain), there = radius(c.partner);
        c.normal = distance > 0 ? Vec3(between / distance) : Vec3::UnitZ();
        c.reduced_radius = here * there / (here + there);
        return distance - here - there;
    }

    double meet_wall(ContactResidual& c) const {
        const Wall wall = wall_of(c.partner);
        c.normal = towards_wall(recording_.box, wall, position(c.grain));
        c.reduced_radius = mcdem::reduced_radius(recording_.box, wall, radius(c.grain));
        return wall_distance(recording_.box, wall, scan_.plate_z, position(c.grain)) - radius(c.grain);
    }

    /// 1/E* of two grains, or of a grain and a wall.
    double reduced_modulus(bool wall) const {
        const auto compliance = [](double e, double nu) { return (1 - nu * nu) / e; };
        const double grain = compliance(material_.youngs_modulus, material_.poisson_ratio);
        const double other =
            wall ? compliance(material_.wall_youngs_modulus, material_.wall_poisson_ratio) : grain;
        return 1 / (grain + other);
    }

    void displace(std::size_t grain) {
        const double nu = material_.poisson_ratio;
        const double scale =
            (1 + nu) / (4 * std::numbers::pi * material_.youngs_modulus * radius(static_cast<int>(grain)));
        const auto& sides = sides_[grain];
        for (const Side& at : sides) {
            double sum = 0;
            for (const Side& from : sides)
                if (&from != &at && from.normal_force > 0)
                    sum += from.normal_force * displacement_on_sphere(at.direction.dot(from.direction), nu);
            ContactResidual& c = list_[at.contact];
            c.cross_contact += scale * sum / c.reduced_radius;
        }
    }

    const Recording& recording_;
    const Scan& scan_;
    const ReferenceMaterial& material_;
    std::vector<std::vector<Side>> sides_;
    std::vector<ContactResidual> list_;
};

}  // namespace

std::vector<ContactResidual> contact_residuals(const Recording& recording, const Scan& scan,
                                               const ReferenceMaterial& material) {
    return Residuals(recording, scan, material).all();
}

}  // namespace mcdem::diagnose
