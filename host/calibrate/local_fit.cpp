#include "calibrate/local_fit.h"

#include <Eigen/Core>
#include <cmath>

#include "core/least_squares.h"

namespace mcdem::inline calibrate {
namespace {

constexpr int points_for_parabola = 6;

/// y - target = c0 + c1 t + c2 t^2 with t from -1 to 1 over the window.
struct Fit {
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd products;  ///< of the powers of t, summed over the points
    double scatter;            ///< variance of a point; NaN without degrees of freedom
    double slope(double t) const {
        return coefficients[1] + (coefficients.size() > 2 ? 2 * coefficients[2] * t : 0);
    }
    double variance(double t) const {
        const Eigen::VectorXd powers = Eigen::Vector3d(1, t, t * t).head(coefficients.size());
        return scatter * (powers.transpose() * least_squares(products, powers)).value();
    }
};

Fit fit_of(const std::vector<Point>& scaled, double target) {
    const auto n = static_cast<Eigen::Index>(scaled.size());
    const Eigen::Index terms = n >= points_for_parabola ? 3 : 2;
    Eigen::MatrixXd powers(n, terms);
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const double t = scaled[i].x;
        powers.row(i) = Eigen::RowVector3d(1, t, t * t).head(terms);
        y[i] = scaled[i].y - target;
    }
    const Eigen::VectorXd c = least_squares(powers, y);
    const double residual = (y - powers * c).squaredNorm();
    const double scatter = n > terms ? residual / static_cast<double>(n - terms) : none;
    return {c, powers.transpose() * powers, scatter};
}

/// Increasing zero of the fit within the window.
double root(const Fit& fit) {
    const double c0 = fit.coefficients[0], c1 = fit.coefficients[1];
    const double c2 = fit.coefficients.size() > 2 ? fit.coefficients[2] : 0;
    const double discriminant = c1 * c1 - 4 * c2 * c0;
    if (!(discriminant > 0)) return none;
    const double t = -2 * c0 / (c1 + std::sqrt(discriminant));  // increasing branch, also for c2 = 0
    return std::abs(t) <= 1 && fit.slope(t) > 0 ? t : none;
}

}  // namespace

Crossing crossing_of_fit(const std::vector<Point>& points, double low, double high, double target) {
    const double middle = (low + high) / 2, half = (high - low) / 2;
    std::vector<Point> scaled;
    for (const auto& point : points)
        if (point.x >= low && point.x <= high) scaled.push_back({(point.x - middle) / half, point.y});
    if (scaled.size() < 2) return {none, none, none};
    const auto fit = fit_of(scaled, target);
    const double t = root(fit);
    return {middle + half * t, half * std::sqrt(fit.variance(t)) / fit.slope(t), fit.slope(t) / half};
}

std::vector<double> rising_fit(const std::vector<Point>& points) {
    struct Block {
        double mean;
        int size;
    };
    std::vector<Block> blocks;
    for (const auto& point : points) {
        blocks.push_back({point.y, 1});
        while (blocks.size() > 1 && blocks[blocks.size() - 2].mean > blocks.back().mean) {
            const auto last = blocks.back();
            blocks.pop_back();
            auto& joined = blocks.back();
            joined.mean = (joined.mean * joined.size + last.mean * last.size) / (joined.size + last.size);
            joined.size += last.size;
        }
    }
    std::vector<double> values;
    for (const auto& block : blocks) values.insert(values.end(), block.size, block.mean);
    return values;
}

}  // namespace mcdem::calibrate
