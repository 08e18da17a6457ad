// Closed form of the displacement of a sphere under point forces, for comparison with the integrals and fits
// of host/elasticity.
#pragma once
#include <cmath>
#include <numbers>

namespace mcdem::reference {

/// Outward radial displacement, in F/(E R), of a free elastic sphere at angle theta [rad] from a point force.
/// The load is balanced by a uniform body force, and the centre is fixed. Legendre series with its two
/// slowest parts summed in closed form.
inline double point_force_on_sphere(double poisson_ratio, double theta) {
    const double nu = poisson_ratio, s = std::sin(theta / 2), x = std::cos(theta);
    const auto coefficient = [nu](double n) {
        return (2 * n + 1) * (2 * (1 - nu) * n * n + nu * n - (1 - 2 * nu)) /
               ((n - 1) * (n * n + n + 1 + nu * (2 * n + 1)));
    };
    // For large n the coefficients are slow + slower/n: sum P_n = 1/(2 s), sum P_n/n = -ln(s (1 + s)).
    const double slow = 4 * (1 - nu), slower = 2 - 8 * nu * (1 - nu);
    double sum = slow * (1 / (2 * s) - 1 - x) - slower * (std::log(s * (1 + s)) + x);  // n >= 2
    double before = 1, legendre = x;
    for (int n = 2; n <= 4000; ++n) {
        const double next = ((2 * n - 1) * x * legendre - (n - 1) * before) / n;
        before = legendre;
        legendre = next;
        sum += (coefficient(n) - slow - slower / n) * legendre;
    }
    sum += coefficient(0);
    return -(1 + nu) / (4 * std::numbers::pi) * sum - 3 * (1 - 2 * nu) / (8 * std::numbers::pi) * x;
}

}  // namespace mcdem::reference
