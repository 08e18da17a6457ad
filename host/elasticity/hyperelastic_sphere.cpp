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
constexpr double coupling = 1.3148, hertz = 0.8988, size = 1.3148;
constexpr std::array<Coefficients, 3> fitted{{
    {0.30, {-0.0128, 0.3940, -0.6893}, 0.3061, -0.0091},
    {0.40, {-0.0085, 0.2214, -0.4386}, 0.2282, 0.4952},
    {0.49, {-0.0067, 0.1080, -0.2533}, 0.1588, 0.8371},
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
