// The surface displacement of one grain in double precision, written from the formulas as they are printed,
// to check the kernels against.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/vec3.h"
#include "elasticity/surface_displacement.h"
#include "reference/sphere_series_reference.h"

namespace reference {

using mcdem::ContactModel;
using mcdem::SurfaceLaw;
using mcdem::SurfaceShape;
using mcdem::Vec3;

/// A contact of the grain, or a direction that is only probed (force and contact radius zero).
struct Slot {
    Vec3 direction;             ///< unit vector from the centre outward
    double arm = 0;             ///< distance of the contact or probed point from the centre [m]
    double force = 0;           ///< elastic normal force of the step before [N]
    double contact_radius = 0;  ///< a [m]
};

struct Grain {
    double radius = 1;          ///< R [m]
    double youngs_modulus = 1;  ///< E [Pa]
    double poisson_ratio = 0.5;
    std::vector<Slot> slots;
};

/// Where the fitted polynomials end, and with them the law.
inline constexpr double smallest_sine = 0.15, smallest_relative_radius = 1e-3, largest_relative_radius = 0.64;

/// Eq. 1 of Brodu, Dijksman & Behringer 2015: outward displacement at slot c by the force at slot k [m].
inline double half_space_displacement(const Grain& grain, double gamma, const Slot& k, const Slot& c) {
    const double nu = grain.poisson_ratio;
    const Vec3 n_k = -k.direction, n_c = -c.direction;  // the contacts' forces point into the grain
    const Vec3 from_k_to_c = c.arm * c.direction - k.arm * k.direction;
    const double d_kc = from_k_to_c.norm();
    const Vec3 u_kc = from_k_to_c / d_kc;
    const double braces = n_k.dot(u_kc) * n_c.dot(u_kc) + (3 - 4 * nu) * n_k.dot(n_c) -
                          (1 - 2 * nu) * (n_k + u_kc).dot(n_c) / (1 + n_k.dot(u_kc));
    return -gamma * (1 + nu) * k.force / (2 * std::numbers::pi * grain.youngs_modulus * d_kc) * braces;
}

inline double sine_of_half_angle(const Slot& k, const Slot& c) {
    return std::max(smallest_sine, (k.direction - c.direction).norm() / 2);
}

/// 2/5 (a_k/R)^2 + 2/3 (a_c/R)^2
inline double spread(const Grain& grain, const Slot& k, const Slot& c) {
    return 2.0 / 5 * std::pow(k.contact_radius / grain.radius, 2) +
           2.0 / 3 * std::pow(c.contact_radius / grain.radius, 2);
}

inline double relative_radius(const Grain& grain, const Slot& c) {
    return std::clamp(c.contact_radius / grain.radius, smallest_relative_radius, largest_relative_radius);
}

template <class Coefficients>
double power_sum(const Coefficients& coefficient, double x) {
    double sum = 0;
    for (std::size_t n = 0; n < coefficient.size(); ++n) sum += coefficient[n] * std::pow(x, n);
    return sum;
}

/// The sphere's law in units of 1/(E R), at c by k.
inline double sphere_displacement(const SurfaceLaw& law, const Grain& grain, const Slot& k, const Slot& c) {
    const double s = sine_of_half_angle(k, c);
    return power_sum(law.point, s) / s + spread(grain, k, c) * power_sum(law.size, s) / (s * s * s);
}

inline bool is_confined(const SurfaceLaw& law) {
    return law.confinement.coupling != 0 || law.confinement.volume != 0;
}

/// With confinement it grows no further once the contact radius is R.
inline double self_displacement(const SurfaceLaw& law, const Grain& grain, const Slot& c) {
    const double x = relative_radius(grain, c);
    const auto& S = law.self;
    const double whole = S[0] + S[1] * std::log(x) + S[2] * x + S[3] * x * x + S[4] * x * x * x;
    return is_confined(law) ? whole * std::min(1.0, std::pow(grain.radius / c.contact_radius, 3)) : whole;
}

/// Energy of all pairs of contacts at small strain over E R^3: less than zero where they push surfaces out.
/// The part of finite contacts is of the power 8/3 in the forces, so that their derivative has the spread
/// above.
inline double pair_energy(const SurfaceLaw& law, const Grain& grain) {
    double energy = 0;
    for (const Slot& c : grain.slots)
        for (const Slot& k : grain.slots) {
            if (&c == &k) continue;
            const double s = sine_of_half_angle(k, c), relative = k.contact_radius / grain.radius;
            energy -= c.force * k.force *
                      (power_sum(law.point, s) / s / 2 +
                       2.0 / 5 * relative * relative * power_sum(law.size, s) / (s * s * s));
        }
    return energy / std::pow(grain.youngs_modulus * grain.radius * grain.radius, 2);
}

/// What confinement makes of the energy W of all pairs at the mean pressure P.
inline double confined_energy(const mcdem::Confinement& c, double W, double P) {
    const double g = 1 / (1 + c.coupling * P);
    return g * W - 4 * std::numbers::pi * c.volume * std::pow(P, 3) * g * g;
}

/// Outward displacement of every slot [m] from that of small strain: less the derivative of the energy by the
/// slot's force, by W exactly, by P as a central difference.
inline void confine(const SurfaceLaw& law, const Grain& grain, std::vector<double>& displacement) {
    constexpr double step = 1e-4;
    double P = 0;
    for (const Slot& slot : grain.slots)
        P += slot.force / (4 * std::numbers::pi * grain.youngs_modulus * grain.radius * grain.radius);
    const double W = pair_energy(law, grain);
    const auto at = [&](double change) { return confined_energy(law.confinement, W, P + change); };
    const double by_pressure = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
    for (double& b : displacement)
        b = b / (1 + law.confinement.coupling * P) - grain.radius * by_pressure / (4 * std::numbers::pi);
}

/// Displacement of every slot outward [m], as the kernels should have it: with the law's polynomials.
inline std::vector<double> surface_displacement(const SurfaceLaw& law, const Grain& grain) {
    std::vector<double> result, own;
    const double per_force = 1 / (grain.youngs_modulus * grain.radius);
    for (const Slot& c : grain.slots) {
        double sum = 0;
        for (const Slot& k : grain.slots) {
            if (&k == &c || k.force == 0 || law.shape == SurfaceShape::rigid) continue;
            sum += law.shape == SurfaceShape::half_space
                       ? half_space_displacement(grain, law.gamma, k, c)
                       : per_force * k.force * sphere_displacement(law, grain, k, c);
        }
        result.push_back(sum);
        const bool moves_itself = c.force != 0 && law.shape == SurfaceShape::sphere;
        own.push_back(moves_itself ? per_force * c.force * self_displacement(law, grain, c) : 0);
    }
    if (is_confined(law)) confine(law, grain, result);
    for (std::size_t c = 0; c < own.size(); ++c) result[c] += own[c];
    return result;
}

/// The same by model and from the series of the sphere, with no polynomial. Slow: some grains, not thousands.
inline std::vector<double> surface_displacement_by_series(ContactModel model, double gamma,
                                                          const Grain& grain) {
    const bool elastic = model == ContactModel::elastic_sphere;
    const double nu = grain.poisson_ratio, per_force = 1 / (grain.youngs_modulus * grain.radius);
    const SphereSeries series(nu);
    const auto at_c_by_k = [&](const Slot& k, const Slot& c) {
        const double s = sine_of_half_angle(k, c);
        switch (model) {
            case ContactModel::independent:
                return 0.0;
            case ContactModel::elastic_half_space:
                return half_space_displacement(grain, 1, k, c);
            case ContactModel::mc_dem:
                return half_space_displacement(grain, gamma, k, c);
            case ContactModel::sphere_to_sphere:
                return per_force * k.force * (1 + nu) / (4 * std::numbers::pi) *
                       (-2 * (1 - nu) - 2 * (1 - 2 * nu) * s + (7 - 8 * nu) * s * s) / s;
            default:
                return per_force * k.force *
                       (series.point(s) + (elastic ? spread(grain, k, c) * series.size(s) : 0));
        }
    };
    std::vector<double> result;
    for (const Slot& c : grain.slots) {
        double sum =
            elastic && c.force != 0 ? per_force * c.force * series.self(relative_radius(grain, c)) : 0;
        for (const Slot& k : grain.slots)
            if (&k != &c && k.force != 0) sum += at_c_by_k(k, c);
        result.push_back(sum);
    }
    return result;
}

}  // namespace reference
