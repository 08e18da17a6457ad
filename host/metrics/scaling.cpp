#include "metrics/scaling.h"

#include <Eigen/Core>

#include "core/least_squares.h"

namespace mcdem::inline metrics {

std::vector<ScalingPoint> scaling_points(const Levels& levels) {
    const auto force = level_means(levels, top_force);
    const Eigen::ArrayXXd product = by_replica(levels, [](const Scan& s) { return s.coordination_number; }) *
                                    by_replica(levels, [](const Scan& s) { return s.packing_fraction; }) *
                                    by_replica(levels, [](const Scan& s) { return s.branch_length; }) *
                                    by_replica(levels, [](const Scan& s) { return s.mean_force; });
    const auto products = level_means(levels, product);
    std::vector<ScalingPoint> points;
    for (std::size_t l = 0; l < levels.size(); ++l)
        if (force[l].mean.available() && products[l].mean.available())
            points.push_back({levels[l].phase, levels[l].displacement, force[l].mean, products[l].mean});
    return points;
}

ScalingFit fit_scaling(const std::vector<ScalingPoint>& points, std::optional<Phase> phase) {
    std::vector<double> products, forces;
    for (const auto& point : points) {
        if (phase && point.phase != *phase) continue;
        products.push_back(point.product.value);
        forces.push_back(point.top_force.value);
    }
    ScalingFit fit;
    fit.points = static_cast<int>(products.size());
    if (products.empty()) return fit;
    const Eigen::Map<const Eigen::ArrayXd> x(products.data(), fit.points), f(forces.data(), fit.points);
    const double largest = x.maxCoeff();
    if (!(largest > 0)) return fit;
    fit.coefficient = (x * f).sum() / x.square().sum();
    const double spread = (f - f.mean()).square().sum();
    if (spread > 0) fit.r_squared = 1 - (f - fit.coefficient * x).square().sum() / spread;
    if (fit.points < 3) return fit;
    Eigen::MatrixXd powers(fit.points, 2);
    powers << (x / largest).matrix(), (x / largest).square().matrix();
    const Eigen::Vector2d c = least_squares(powers, f.matrix());
    fit.curvature = c[1] / c.sum();
    return fit;
}

}  // namespace mcdem::metrics
