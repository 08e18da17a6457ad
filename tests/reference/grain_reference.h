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

inline double self_displacement(const SurfaceLaw& law, const Grain& grain, const Slot& c) {
    const double x = relative_radius(grain, c);
    const auto& S = law.self;
    return S[0] + S[1] * std::log(x) + S[2] * x + S[3] * x * x + S[4] * x * x * x;
}

/// Displacement of every slot outward [m], as the kernels should have it: with the law's polynomials.
inline std::vector<double> surface_displacement(const SurfaceLaw& law, const Grain& grain) {
    std::vector<double> result;
    const double per_force = 1 / (grain.youngs_modulus * grain.radius);
    for (const Slot& c : grain.slots) {
        double sum = 0;
        for (const Slot& k : grain.slots) {
            if (k.force == 0 || law.shape == SurfaceShape::rigid) continue;
            if (law.shape == SurfaceShape::half_space)
                sum += &k == &c ? 0 : half_space_displacement(grain, law.gamma, k, c);
            else if (&k == &c)
                sum += per_force * k.force * self_displacement(law, grain, c);
            else
                sum += per_force * k.force * sphere_displacement(law, grain, k, c);
        }
        result.push_back(sum);
    }
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
