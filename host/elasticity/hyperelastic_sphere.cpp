#include "elasticity/hyperelastic_sphere.h"

#include <algorithm>
#include <array>

namespace mcdem::inline elasticity {
namespace {

/// A contact's own force moves it towards the grain by F/(E R) (own[0] + own[1] a/R + own[2] (a/R)^2) beyond
/// small strain.
struct Coefficients {
    double poisson_ratio;
    std::array<double, 3> own;
    double volume;
};

// Printed by tests/truth/fit_hyperelastic_sphere.py.
constexpr double coupling = 1.6889;
constexpr std::array<Coefficients, 3> fitted{{
    {0.30, {0.0132, 0.1263, -0.3425}, 0.0530},
    {0.40, {0.0258, -0.0629, -0.1109}, 0.3439},
    {0.49, {-0.0136, 0.0702, -0.2360}, 0.5832},
}};

/// Linear between the two fitted Poisson ratios around.
double between(double poisson_ratio, auto&& value) {
    std::size_t i = 0;
    while (i + 2 < fitted.size() && poisson_ratio > fitted[i + 1].poisson_ratio) ++i;
    const double share =
        (poisson_ratio - fitted[i].poisson_ratio) / (fitted[i + 1].poisson_ratio - fitted[i].poisson_ratio);
    const double inside = std::clamp(share, 0.0, 1.0);
    return (1 - inside) * value(fitted[i]) + inside * value(fitted[i + 1]);
}

}  // namespace

void add_finite_strain(SurfaceLaw& law, double poisson_ratio, double share) {
    const auto own = [&](std::size_t n) {
        return share * between(poisson_ratio, [n](const Coefficients& c) { return c.own[n]; });
    };
    // `self` is outward and has the logarithm second.
    law.self[0] -= own(0);
    law.self[2] -= own(1);
    law.self[3] -= own(2);
    law.confinement = {share * coupling,
                       share * between(poisson_ratio, [](const Coefficients& c) { return c.volume; })};
}

}  // namespace mcdem::elasticity
