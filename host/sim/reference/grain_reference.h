// Reference for the kernels: surface displacement of one grain in double precision, written directly from
// the published formulas.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/vec3.h"
#include "elasticity/surface_displacement.h"
#include "sim/reference/sphere_series_reference.h"

namespace mcdem::reference {

using mcdem::ContactModel;
using mcdem::SurfaceLaw;
using mcdem::SurfaceShape;
using mcdem::Vec3;

/// A contact of the grain, or a direction without contact (force and contact radius zero).
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

/// G = E / (2 (1 + nu)) [Pa]
inline double shear_modulus(double youngs_modulus, double poisson_ratio) {
    return youngs_modulus / (2 * (1 + poisson_ratio));
}

/// Range of the fitted polynomials; arguments are clamped to it.
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
    for (std::size_t n = coefficient.size(); n-- > 0;) sum = coefficient[n] + x * sum;
    return sum;
}

inline double cubed(double x) { return x * x * x; }

/// Displacement at c by k in the sphere models, in units of 1/(E R).
inline double sphere_displacement(const SurfaceLaw& law, const Grain& grain, const Slot& k, const Slot& c) {
    const double s = sine_of_half_angle(k, c);
    return power_sum(law.point, s) / s + spread(grain, k, c) * power_sum(law.size, s) / (s * s * s);
}

inline bool is_confined(const SurfaceLaw& law) { return law.confinement.coupling != 0; }

inline double whole_self_displacement(const SurfaceLaw& law, const Grain& grain, const Slot& c) {
    const double x = relative_radius(grain, c);
    const auto& S = law.self;
    return S[0] + S[1] * std::log(x) + S[2] * x + S[3] * x * x + S[4] * x * x * x;
}

/// Part of the self displacement that is solved within the step; with confinement the rest is delayed.
inline double self_displacement(const SurfaceLaw& law, const Grain& grain, const Slot& c) {
    const double whole = whole_self_displacement(law, grain, c);
    return is_confined(law) ? whole / (1 + cubed(c.contact_radius / (0.4 * grain.radius))) : whole;
}

/// Work of the surface displacements over E R^3 (confinement.h): Hertz overlaps; self displacements beyond
/// Hertz and displacements by point forces; contribution of the contact sizes. Mean pressure over E.
struct Works {
    double hertz = 0, points = 0, sizes = 0, pressure = 0;
    double deviator = 0;  ///< tr T^2 - P^2/3, T = sum F n n/(4 pi E R^2)
};

inline double hertz_share(const Grain& grain, const Slot& c) {
    if (c.force == 0) return 0;
    return 0.75 * c.force / c.contact_radius * (1 - std::pow(grain.poisson_ratio, 2)) / grain.youngs_modulus;
}

/// The force is proportional to the cube of the contact radius x R, so F^2 x^n has the integral F^2 x^n/(2 +
/// n/3).
inline double own_work(const SurfaceLaw& law, const Grain& grain, const Slot& c) {
    const double x = relative_radius(grain, c);
    const auto& S = law.self;
    return S[0] / 2 + S[1] * (std::log(x) / 2 - 1.0 / 12) + 3.0 / 7 * S[2] * x + 3.0 / 8 * S[3] * x * x +
           S[4] / 3 * x * x * x;
}

/// n T n - P/3 at slot c.
inline double deviator_along(const Grain& grain, const Slot& c) {
    const double area = 4 * std::numbers::pi * grain.youngs_modulus * grain.radius * grain.radius;
    double sum = 0;
    for (const Slot& k : grain.slots)
        sum += k.force / area * (std::pow(k.direction.dot(c.direction), 2) - 1.0 / 3);
    return sum;
}

inline Works works(const SurfaceLaw& law, const Grain& grain) {
    const double area = grain.youngs_modulus * grain.radius * grain.radius;
    Works w;
    for (const Slot& c : grain.slots) {
        const double force = c.force / area;
        w.pressure += force / (4 * std::numbers::pi);
        w.deviator += force / (4 * std::numbers::pi) * deviator_along(grain, c);
        w.hertz += 0.6 * force * hertz_share(grain, c) / grain.radius;
        if (force != 0) w.points += force * force * own_work(law, grain, c);
        for (const Slot& k : grain.slots) {
            if (&c == &k) continue;
            const double s = sine_of_half_angle(k, c), relative = k.contact_radius / grain.radius;
            w.points += force * k.force / area * power_sum(law.point, s) / s / 2;
            w.sizes +=
                force * k.force / area * 2 / 5 * relative * relative * power_sum(law.size, s) / (s * s * s);
        }
    }
    return w;
}

/// Confined work at a mean pressure P (confinement.h).
inline double confined_work(const mcdem::Confinement& c, const Works& w, double P) {
    const double e = std::pow(1 + c.hertz * P, -2.0 / 3), g = 1 / (1 + c.coupling * P),
                 z = 1 / (1 + c.size * P);
    const double p = c.bulk[0] > 0 ? std::min(P, 0.1 / c.bulk[0]) : P;  // linear beyond P/K = 0.3
    const double overlap = c.bulk[0] * p + c.bulk[1] * p * p + c.bulk[2] * std::pow(p, 3);
    const double slope = c.bulk[0] + 2 * c.bulk[1] * p + 3 * c.bulk[2] * p * p;
    const double bulk = c.bulk[0] * p * p / 2 + c.bulk[1] * std::pow(p, 3) / 3 +
                        c.bulk[2] * std::pow(p, 4) / 4 + overlap * (P - p) + slope * (P - p) * (P - p) / 2;
    return (1 - e) * w.hertz + g * w.points + std::pow(z, 5.0 / 3) * w.sizes +
           4 * std::numbers::pi * (P * (c.volume * P * P + c.shear * w.deviator) * z * z - bulk);
}

/// Outward displacement of a slot [m]: the derivative of the work with respect to its force. The derivative
/// at constant P is analytic; the derivative with respect to P is a finite difference.
inline double confined_displacement(const SurfaceLaw& law, const Grain& grain, const Works& w,
                                    const Slot& c) {
    constexpr double step = 1e-4;
    const auto at = [&](double change) { return confined_work(law.confinement, w, w.pressure + change); };
    const double by_pressure = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
    const double e = std::pow(1 + law.confinement.hertz * w.pressure, -2.0 / 3);
    const double g = 1 / (1 + law.confinement.coupling * w.pressure),
                 z = 1 / (1 + law.confinement.size * w.pressure);
    const double per_force = 1 / (grain.youngs_modulus * grain.radius);
    double sum = (1 - e) * hertz_share(grain, c) + grain.radius * by_pressure / (4 * std::numbers::pi);
    sum += 2 * grain.radius * law.confinement.shear * w.pressure * z * z * deviator_along(grain, c);
    if (c.force != 0) sum += g * per_force * c.force * whole_self_displacement(law, grain, c);
    for (const Slot& k : grain.slots) {
        if (&k == &c) continue;
        const double s = sine_of_half_angle(k, c);
        sum += per_force * k.force *
               (g * power_sum(law.point, s) / s +
                std::pow(z, 5.0 / 3) * spread(grain, k, c) * power_sum(law.size, s) / (s * s * s));
    }
    return sum;
}

/// Outward displacement of every slot [m], with the same polynomials as in the kernels.
inline std::vector<double> surface_displacement(const SurfaceLaw& law, const Grain& grain) {
    std::vector<double> result;
    const double per_force = 1 / (grain.youngs_modulus * grain.radius);
    const Works w = is_confined(law) ? works(law, grain) : Works{};
    for (const Slot& c : grain.slots) {
        if (is_confined(law)) {
            result.push_back(confined_displacement(law, grain, w, c));
            continue;
        }
        double sum = 0;
        for (const Slot& k : grain.slots) {
            if (&k == &c || k.force == 0 || law.shape == SurfaceShape::rigid) continue;
            sum += law.shape == SurfaceShape::half_space
                       ? half_space_displacement(grain, law.gamma, k, c)
                       : per_force * k.force * sphere_displacement(law, grain, k, c);
        }
        const bool moves_itself = c.force != 0 && law.shape == SurfaceShape::sphere;
        if (moves_itself) sum += per_force * c.force * self_displacement(law, grain, c);
        result.push_back(sum);
    }
    return result;
}

/// The same for each contact model, from the series of the sphere instead of polynomials. Slow.
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

}  // namespace mcdem::reference
