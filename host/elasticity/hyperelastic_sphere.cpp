#include "elasticity/hyperelastic_sphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mcdem::inline elasticity {
namespace {

/// Beyond small strain, a contact's own force moves it inward by F/(E R) (own[0] + own[1] a/R + own[2]
/// (a/R)^2).
struct Coefficients {
    double poisson_ratio;
    std::array<double, 3> own;
    double volume;  // q of kernels/confinement.h
    double shear;   // t
};

// Printed by tests/truth/fit_hyperelastic_sphere.py.
constexpr double coupling = 1.4835, hertz = 1.2467, size = 2.5925;
constexpr std::array<Coefficients, 3> fitted{{
    {0.30, {-0.0078, 0.4401, -0.7491}, 0.1962, 0.7717},
    {0.40, {-0.0238, 0.3723, -0.6152}, 0.1458, 1.2901},
    {0.49, {-0.0186, 0.2257, -0.3962}, 0.0457, 1.0354},
}};

/// Linear interpolation between the two neighbouring fitted Poisson ratios.
double between(double poisson_ratio, auto&& value) {
    std::size_t i = 0;
    while (i + 2 < fitted.size() && poisson_ratio > fitted[i + 1].poisson_ratio) ++i;
    const double share =
        (poisson_ratio - fitted[i].poisson_ratio) / (fitted[i + 1].poisson_ratio - fitted[i].poisson_ratio);
    const double inside = std::clamp(share, 0.0, 1.0);
    return (1 - inside) * value(fitted[i]) + inside * value(fitted[i + 1]);
}

/// Overlap by uniform compression, in powers of P: P/K = (1 - J) J^(2/3) solved for 1 - J^(1/3); the third
/// power for P/K up to 0.3 and flat contacts.
std::array<double, 3> uniform_compression(double poisson_ratio, double share) {
    const double compressibility = 3 * (1 - 2 * poisson_ratio);  // E/K
    return {compressibility / 3, share * std::pow(compressibility, 2) / 3,
            share * 0.7 * std::pow(compressibility, 3)};
}

}  // namespace

void add_finite_strain(SurfaceLaw& law, double poisson_ratio, double share) {
    const auto own = [&](std::size_t n) {
        return share * between(poisson_ratio, [n](const Coefficients& c) { return c.own[n]; });
    };
    // `self` is outward and has the logarithm second. Every force moves all points inward by uniform
    // compression.
    const double uniform = (1 - 2 * poisson_ratio) / (4 * std::numbers::pi);
    law.self[0] += uniform - own(0);
    law.self[2] -= own(1);
    law.self[3] -= own(2);
    law.point[1] += uniform;
    law.confinement = {share * hertz,
                       share * coupling,
                       share * size,
                       share * between(poisson_ratio, [](const Coefficients& c) { return c.volume; }),
                       share * between(poisson_ratio, [](const Coefficients& c) { return c.shear; }),
                       uniform_compression(poisson_ratio, share)};
}

}  // namespace mcdem::elasticity
