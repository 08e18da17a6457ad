#include "elasticity/elastic_sphere_series.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace mcdem::inline elasticity {
namespace {

using std::numbers::pi;

/// Gauss's rule with enough nodes for the moments of order n over a cap of radius a/R while n a/R is below
/// about 260, the maximum in sphere_self_displacement. Its positive half integrates even functions from 0
/// to 1.
using CapQuadrature = boost::math::quadrature::gauss<double, 300>;

Eigen::Map<const Eigen::ArrayXd> array_of(const std::vector<double>& values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// Moments of order n, radial and meridional, of a unit load along the plate normal distributed over a cap.
struct Moments {
    double radial;      ///< -<cos(theta) P_n>
    double meridional;  ///< <sin(theta) dP_n/dtheta> / (n(n+1))
};

/// -<1 - cos(theta) - r^2/2> over the punch: the difference between the gap of a sphere and a parabola, for
/// Hertz's force 4/3 a^3/(1 - nu^2); near -(1 - nu^2) a/20.
double gap_displacement(double poisson_ratio, double a, const Eigen::ArrayXd& r2,
                        const Eigen::ArrayXd& punch) {
    // (1 - sqrt(1 - r^2)) - r^2/2 without cancellation
    const Eigen::ArrayXd excess = r2.square() / 2 / (1 + (1 - r2).sqrt()).square();
    const double force = 4.0 / 3 * a * a * a / (1 - poisson_ratio * poisson_ratio);
    return -(excess * punch).sum() / force;
}

}  // namespace

// The modes are u = grad(phi) and u = r^2 grad(phi) + alpha x phi with phi = r^n P_n, numbered 1 and 2 here;
// both satisfy Navier's equation with the alpha below. Written in terms of (1 - 2 nu) and 2 nu, there is no
// singularity at nu = 1/2.
SurfaceMode surface_mode(double poisson_ratio, int order) {
    const double shear_part = 1 - 2 * poisson_ratio, bulk_part = 2 * poisson_ratio;
    if (order == 0) return {shear_part, 0, 0};
    if (order == 1) return {shear_part / 2, (4 * poisson_ratio - 1) / 2, 2};
    const double n = order;
    const double denominator = (n + 3) * bulk_part + (n + 5) * shear_part;
    const double alpha = -2 * (n * bulk_part + (3 * n + 1) * shear_part) / denominator;
    const double pressure = bulk_part * (2 * n * (n + 5) - 2 * (n + 3) * (3 * n + 1)) / denominator;
    // On r = 1: displacements U and V, tractions over the shear modulus s (radial) and t (meridional).
    const double U1 = n, V1 = 1, s1 = 2 * n * (n - 1), t1 = 2 * (n - 1);
    const double U2 = n + alpha, V2 = 1, s2 = pressure + 2 * (n + 1) * (n + alpha), t2 = 2 * n + alpha;
    const double scale = 2 * (1 + poisson_ratio) / (s1 * t2 - s2 * t1);
    return {scale * (U1 * t2 - U2 * t1), scale * (U2 * s1 - U1 * s2), scale * (V2 * s1 - V1 * s2)};
}

SphereDisplacement sphere_displacement(double poisson_ratio, double s) {
    constexpr int terms = 1200;
    const double x = 1 - 2 * s * s;
    double legendre = 1, before = 0;
    SphereDisplacement sum;
    for (int n = 0; n <= terms; ++n) {
        const SurfaceMode mode = surface_mode(poisson_ratio, n);
        // The series diverges like that of a Dirac function; the smooth cut-off makes it summable.
        const double filter = std::exp(-36 * std::pow(static_cast<double>(n) / terms, 8));
        const double factor = -(2 * n + 1) / (4 * pi) * filter * legendre;
        sum.point += factor * mode.radial;
        // Moments of a small cap: radial -1 + <r^2>(1/2 + n(n+1)/4), meridional -<r^2>/2;
        // <r^2> is 2/5 a^2 for a Hertz pressure, 2/3 a^2 for a punch.
        sum.size += factor * (mode.coupling / 2 - (0.5 + n * (n + 1) / 4.0) * mode.radial);
        const double next = ((2 * n + 1) * x * legendre - n * before) / (n + 1);
        before = legendre;
        legendre = next;
    }
    return sum;
}

double sphere_self_displacement(double poisson_ratio, double a) {
    // With r = a sqrt(1 - y^2) the punch has weight 1 in y and the Hertz pressure 3 y^2.
    const auto y = array_of(CapQuadrature::abscissa()), punch = array_of(CapQuadrature::weights());
    const Eigen::ArrayXd hertz = 3 * y.square() * punch;
    const Eigen::ArrayXd r2 = a * a * (1 - y.square());
    const Eigen::ArrayXd x = (1 - r2).sqrt();  // cos(theta)
    const int terms = std::max(400, static_cast<int>(120 / a));
    Eigen::ArrayXd legendre = Eigen::ArrayXd::Ones(x.size()), before = Eigen::ArrayXd::Zero(x.size());
    Eigen::ArrayXd slope(x.size()), next(x.size());  // slope: sin(theta) dP_n/dtheta
    double sum = 0;
    for (int n = 0; n <= terms; ++n) {
        const double count = n * (n + 1.0);
        slope = n * (x * legendre - before);
        const auto moments = [&](const Eigen::ArrayXd& weight) {
            return Moments{-(weight * x * legendre).sum(), n > 0 ? (weight * slope).sum() / count : 0};
        };
        const Moments source = moments(hertz), receiver = moments(punch);
        const SurfaceMode mode = surface_mode(poisson_ratio, n);
        sum -= (2 * n + 1) / (4 * pi) *
               (receiver.radial * (mode.radial * source.radial + mode.coupling * source.meridional) +
                receiver.meridional *
                    (mode.coupling * source.radial + count * mode.meridional * source.meridional));
        next = ((2 * n + 1) * x * legendre - n * before) / (n + 1);
        before.swap(legendre);
        legendre.swap(next);
    }
    const double half_space = -(1 - poisson_ratio * poisson_ratio) / (2 * a);
    return sum - half_space + gap_displacement(poisson_ratio, a, r2, punch);
}

}  // namespace mcdem::elasticity
