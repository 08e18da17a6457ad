// Constants of a pair of bodies from the materials of both.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "sim/reference/grain_reference.h"
#include "sim/reference/step_reference.h"

namespace mcdem::reference {

StepReference::PairConstants StepReference::pair_constants(const Body& a, const Body& b) const {
    const bool wall = b.radius == 0;
    const double nu = poisson_ratio(a), nu_there = poisson_ratio(b);
    const double e = a.youngs_modulus, e_there = b.youngs_modulus;
    PairConstants pair;
    pair.modulus = 1 / ((1 - nu * nu) / e + (1 - nu_there * nu_there) / e_there);
    pair.shear_modulus =
        1 / ((2 - nu) / shear_modulus(e, nu) + (2 - nu_there) / shear_modulus(e_there, nu_there));
    pair.radius = wall ? a.radius : 1 / (1 / a.radius + 1 / b.radius);
    // Geometric mean of the two principal relative curvatures.
    if (b.curvature != 0) pair.radius = 1 / std::sqrt((1 / a.radius + b.curvature) / a.radius);
    pair.mass = wall ? a.mass : 1 / (1 / a.mass + 1 / b.mass);
    const auto [friction, restitution] = friction_and_restitution(a, b);
    using std::numbers::pi;
    const double log_e = std::log(restitution);
    pair.damping = 2 * std::sqrt(5.0 / 6) * -log_e / std::sqrt(log_e * log_e + pi * pi);
    pair.friction = friction;
    return pair;
}

double StepReference::poisson_ratio(const Body& body) const {
    if (body.species < 0) return scene_.walls.poisson_ratio;
    return scene_.species.empty() ? scene_.grains.poisson_ratio
                                  : scene_.species[body.species].material.poisson_ratio;
}

/// The values of [[pair]] if given; otherwise those of the wall, or the smaller of the two grains' values.
std::array<double, 2> StepReference::friction_and_restitution(const Body& a, const Body& b) const {
    const auto own = [&](const Body& body) -> std::array<double, 2> {
        if (body.species < 0) return {scene_.walls.friction, scene_.walls.restitution};
        const auto& g = scene_.species.empty() ? scene_.grains : scene_.species[body.species].material;
        return {g.friction, g.restitution};
    };
    const auto called = [&](const Body& body) -> std::string {
        if (body.species < 0) return "walls";
        return scene_.species.empty() ? "" : scene_.species[body.species].name;
    };
    auto law = own(b);
    for (std::size_t k = 0; k < 2 && b.species >= 0; ++k) law[k] = std::min(law[k], own(a)[k]);
    for (const auto& pair : scene_.pairs) {
        if (std::set{pair.first, pair.second} != std::set{called(a), called(b)}) continue;
        if (pair.friction == pair.friction) law[0] = pair.friction;
        if (pair.restitution == pair.restitution) law[1] = pair.restitution;
    }
    return law;
}

/// Displacement of a contact by its own force beyond Hertz, over force [m/N]; zero for a wall.
double StepReference::self_compliance(double contact_radius, const Body& body) const {
    if (body.radius == 0) return 0;
    const Grain grain{body.radius, body.youngs_modulus, poisson_ratio(body), {}};
    return self_displacement(*body.law, grain, {Vec3::Zero(), body.radius, 1, contact_radius}) /
           (grain.youngs_modulus * grain.radius);
}

/// The smallest overlap = given + compliance(overlap) F(overlap), by bisection.
double StepReference::self_consistent_overlap(double given, const Body& a, const Body& b,
                                              const PairConstants& pair) const {
    const auto excess = [&](double overlap) {
        const double contact_radius = std::sqrt(pair.radius * overlap);
        const double force = 4.0 / 3 * pair.modulus * contact_radius * overlap;
        const double compliance = self_compliance(contact_radius, a) + self_compliance(contact_radius, b);
        return given + compliance * force - overlap;
    };
    double low = given * 1e-3;
    while (excess(1.1 * low) > 0 && low < a.radius) low *= 1.1;
    double high = 1.1 * low;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (excess(middle) > 0 ? low : high) = middle;
    }
    return (low + high) / 2;
}

}  // namespace mcdem::reference
