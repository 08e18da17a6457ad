#include "diagnose/infer/signature.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "metrics/estimate.h"

namespace mcdem::inline diagnose {
namespace {

/// Mean over rows and its variance, for each column.
struct Moments {
    Eigen::ArrayXd mean, variance;
};
Moments moments(const Eigen::MatrixXd& rows) {
    const Eigen::VectorXd mean = rows.colwise().mean();
    const double n = static_cast<double>(rows.rows());
    const Eigen::MatrixXd apart = rows.rowwise() - mean.transpose();
    return {mean.array(), apart.array().square().colwise().sum().transpose() / (n * std::max(1.0, n - 1))};
}

/// Factor of each mean after shrinkage.
Eigen::ArrayXd kept(const Moments& m) { return (1 - m.variance / m.mean.square().max(1e-300)).max(0.0); }

}  // namespace

std::vector<Eigen::Index> rows_with_numbers(const Eigen::MatrixXd& rows) {
    std::vector<Eigen::Index> list;
    for (Eigen::Index r = 0; r < rows.rows(); ++r)
        if (rows.row(r).array().isFinite().any()) list.push_back(r);
    return list;
}

Eigen::VectorXd Signature::at(double amplitude) const {
    const double inside = std::clamp(amplitude, -reach, reach);
    return inside * linear + inside * inside * curvature + (amplitude - inside) * slope(inside);
}

Eigen::VectorXd Signature::slope(double amplitude) const {
    return linear + 2 * std::clamp(amplitude, -reach, reach) * curvature;
}

Eigen::VectorXd Signature::spread() const {
    if (pairs() == 0) return Eigen::VectorXd::Zero(linear.size());
    return moments(slopes).variance * pairs();
}

namespace {

/// Straight line through the pairs of one amplitude.
Signature straight_signature(const std::string& name, double amplitude, const Eigen::MatrixXd& at) {
    const Moments line = moments(at / amplitude);
    Signature s;
    s.name = name;
    s.reach = std::abs(amplitude);
    s.linear = kept(line) * line.mean;
    s.curvature = Eigen::VectorXd::Zero(at.cols());
    s.slopes = at / amplitude;
    return s;
}

/// Takes the cells in which `s` has no value from `other`, which has the same pairs.
void fill_in(Signature& s, const Signature& other) {
    for (Eigen::Index cell = 0; cell < s.linear.size(); ++cell) {
        if (std::isfinite(s.linear[cell]) && std::isfinite(s.curvature[cell])) continue;
        s.linear[cell] = other.linear[cell];
        s.curvature[cell] = other.curvature[cell];
        s.slopes.col(cell) = other.slopes.col(cell);
    }
}

Signature parabola_signature(const std::string& name, double first, double second,
                             const Eigen::MatrixXd& at_first, const Eigen::MatrixXd& at_second) {
    // The parabola through zero and both differences, for each pair.
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
    s.slopes = at_second / second;
    return s;
}

}  // namespace

Signature continued_from(const Signature& signature, double done) {
    const double left = 1 - done;
    Signature s = signature;
    s.linear = left * signature.slope(done);
    s.slopes *= left;
    if (done < signature.reach) {
        s.curvature *= left * left;
        s.reach = (signature.reach - done) / left;
    } else {
        s.curvature.setZero();
    }
    return s;
}

Signature learn_signature(const std::string& name, double first, double second,
                          const Eigen::MatrixXd& at_first, const Eigen::MatrixXd& at_second) {
    const auto needed = std::min<std::size_t>(2, static_cast<std::size_t>(at_first.rows()));
    const auto holds_first = rows_with_numbers(at_first), holds_second = rows_with_numbers(at_second);
    std::vector<Eigen::Index> both;
    std::ranges::set_intersection(holds_first, holds_second, std::back_inserter(both));
    if (both.size() >= needed) {
        Signature s =
            parabola_signature(name, first, second, at_first(both, Eigen::all), at_second(both, Eigen::all));
        fill_in(s, straight_signature(name, second, at_second(both, Eigen::all)));
        fill_in(s, straight_signature(name, first, at_first(both, Eigen::all)));
        return s;
    }
    if (holds_second.size() >= needed)
        return straight_signature(name, second, at_second(holds_second, Eigen::all));
    if (holds_first.size() >= needed)
        return straight_signature(name, first, at_first(holds_first, Eigen::all));
    const Eigen::VectorXd none = Eigen::VectorXd::Constant(at_first.cols(), not_available);
    return {name, std::max(std::abs(first), std::abs(second)), none, none, {}};
}

}  // namespace mcdem::diagnose
