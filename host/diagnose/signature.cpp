#include "diagnose/signature.h"

#include <algorithm>
#include <cmath>

namespace mcdem {
namespace {

/// Mean over rows and its variance, column by column.
struct Moments {
    Eigen::ArrayXd mean, variance;
};
Moments moments(const Eigen::MatrixXd& rows) {
    const Eigen::VectorXd mean = rows.colwise().mean();
    const double n = static_cast<double>(rows.rows());
    const Eigen::MatrixXd apart = rows.rowwise() - mean.transpose();
    return {mean.array(), apart.array().square().colwise().sum().transpose() / (n * std::max(1.0, n - 1))};
}

/// Part of each mean that is kept.
Eigen::ArrayXd kept(const Moments& m) { return (1 - m.variance / m.mean.square().max(1e-300)).max(0.0); }

}  // namespace

Eigen::VectorXd Signature::at(double amplitude) const {
    const double inside = std::clamp(amplitude, -reach, reach);
    return inside * linear + inside * inside * curvature + (amplitude - inside) * slope(inside);
}

Eigen::VectorXd Signature::slope(double amplitude) const {
    return linear + 2 * std::clamp(amplitude, -reach, reach) * curvature;
}

Signature learn_signature(const std::string& name, double first, double second,
                          const Eigen::MatrixXd& at_first, const Eigen::MatrixXd& at_second) {
    // The parabola through zero and both differences, pair by pair.
    const double a = first, b = second, determinant = a * b * (b - a);
    const Moments curvature = moments((at_second * a - at_first * b) / determinant);
    const Moments parabola = moments((at_first * b * b - at_second * a * a) / determinant);
    const Moments straight = moments((at_first * a + at_second * b) / (a * a + b * b));
    const Eigen::ArrayXd bent = kept(curvature);
    const Moments linear{bent * parabola.mean + (1 - bent) * straight.mean,
                         bent * parabola.variance + (1 - bent) * straight.variance};
    const Eigen::ArrayXd seen = kept(linear).max(bent);
    Signature s;
    s.name = name;
    s.reach = std::max(std::abs(first), std::abs(second));
    s.linear = seen * linear.mean;
    s.curvature = bent * curvature.mean;
    s.variance = linear.variance;
    s.spread = moments(at_second / second).variance * static_cast<double>(at_second.rows());
    s.pairs = static_cast<int>(at_first.rows());
    return s;
}

}  // namespace mcdem
