#include "elasticity/elastic_sphere.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "core/least_squares.h"
#include "elasticity/elastic_sphere_series.h"

namespace mcdem::inline elasticity {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr double smallest_sine =
    0.15;  ///< lower end of the polynomials' range, up to s = 1; contacts 17 degrees apart

/// Samples of the series: Chebyshev points of [smallest_sine, 1], with weights that make a least-squares fit
/// nearly a minimax fit.
struct Samples {
    ArrayXd s, weight, point, size;
};

Samples sample(double poisson_ratio) {
    constexpr int count = 160;
    Samples samples{ArrayXd(count), ArrayXd(count), ArrayXd(count), ArrayXd(count)};
    for (int i = 0; i < count; ++i) {
        const double u = std::cos(pi * (2 * i + 1) / (2 * count));
        samples.s[i] = (smallest_sine + 1) / 2 + (1 - smallest_sine) / 2 * u;
        samples.weight[i] = std::pow(1 - u * u, -0.25);
        const SphereDisplacement value = sphere_displacement(poisson_ratio, samples.s[i]);
        samples.point[i] = value.point;
        samples.size[i] = value.size;
    }
    return samples;
}

/// Weighted least-squares polynomial, as coefficients of the powers of s. Solved in Chebyshev polynomials of
/// 2 s - 1, because powers would lose half the digits.
VectorXd fit_polynomial(const ArrayXd& s, const ArrayXd& value, const ArrayXd& weight, int degree) {
    MatrixXd powers = MatrixXd::Zero(degree + 1, degree + 1);  // column n: T_n(2 s - 1) in powers of s
    powers(0, 0) = 1;
    powers(0, 1) = -1;
    powers(1, 1) = 2;
    for (int n = 2; n <= degree; ++n) {
        powers.col(n) = -2 * powers.col(n - 1) - powers.col(n - 2);
        powers.col(n).tail(degree) += 4 * powers.col(n - 1).head(degree);
    }
    MatrixXd basis(s.size(), degree + 1);
    for (int n = 0; n <= degree; ++n) basis.col(n) = weight * (n * (2 * s - 1).acos()).cos();
    const VectorXd coefficients = least_squares(basis, (weight * value).matrix());
    return powers * coefficients;
}

/// A polynomial with exact value at s = 0; the other coefficients are fitted.
template <std::size_t terms>
std::array<double, terms> with_limit(double limit, const VectorXd& rest) {
    std::array<double, terms> polynomial{limit};
    std::copy(rest.begin(), rest.end(), polynomial.begin() + 1);
    return polynomial;
}

std::array<double, self_terms> fit_self(double poisson_ratio) {
    const ArrayXd a = (ArrayXd(12) << .05, .08, .12, .17, .22, .28, .34, .40, .46, .52, .58, .64).finished();
    // The second part of the series decreases as 1/n: its logarithm is known exactly and vanishes at nu =
    // 1/2.
    const double slope = (1 + poisson_ratio) * std::pow(1 - 2 * poisson_ratio, 2) / (2 * pi);
    VectorXd value(a.size());
    MatrixXd powers(a.size(), 4);
    for (int i = 0; i < a.size(); ++i) {
        value[i] = sphere_self_displacement(poisson_ratio, a[i]) - slope * std::log(a[i]);
        powers.row(i) << 1, a[i], a[i] * a[i], a[i] * a[i] * a[i];
    }
    const VectorXd fitted = least_squares(powers, value);
    return {fitted[0], slope, fitted[1], fitted[2], fitted[3]};
}

SurfaceLaw fit(double poisson_ratio) {
    const auto [s, weight, point, size] = sample(poisson_ratio);
    // Close to the load the sphere is a half space, (1 - nu^2)/(pi d) at distance d = 2 s. A load
    // distribution with mean square radius <r^2> adds <r^2>/4 times the Laplacian, which is 1/(16 s^3) for
    // the 1/s of a point load.
    const double near_point = -(1 - poisson_ratio * poisson_ratio) / (2 * pi), near_size = near_point / 16;
    // `size` is divided by s^3, so small s needs the weight; contacts rarely meet below s = 0.3.
    const ArrayXd size_weight = weight / s.square() * (s / 0.3).pow(1.5).min(1.0);
    SurfaceLaw sphere;
    sphere.shape = SurfaceShape::sphere;
    sphere.point = with_limit<point_terms>(
        near_point, fit_polynomial(s, point - near_point / s, weight, point_terms - 2));
    sphere.size = with_limit<size_terms>(
        near_size, fit_polynomial(s, (s.cube() * size - near_size) / s, size_weight, size_terms - 2));
    sphere.self = fit_self(poisson_ratio);
    return sphere;
}

}  // namespace

SurfaceLaw elastic_sphere(double poisson_ratio) {
    static std::mutex mutex;
    static std::map<double, SurfaceLaw> known;
    const std::lock_guard lock(mutex);
    const auto place = known.find(poisson_ratio);
    if (place != known.end()) return place->second;
    return known[poisson_ratio] = fit(poisson_ratio);
}

}  // namespace mcdem::elasticity
