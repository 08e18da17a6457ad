#include "diagnose/infer/effect_fit.h"

#include <boost/math/tools/minima.hpp>
#include <cmath>

namespace mcdem::inline diagnose {
namespace {

constexpr int coarse_steps = 24;
constexpr int bits = 20;  // of the amplitude, 1e-6 of the range

/// -2 log likelihood as a function of the amplitude, from products of the three whitened vectors.
class Misfit {
public:
    Misfit(const GapSpace& space, const Signature& signature, const Eigen::VectorXd& gap)
        : reach_(signature.reach) {
        basis_.resize(static_cast<Eigen::Index>(space.cells().size()), 3);
        basis_.col(0) = space.whiten(gap);
        basis_.col(1) = space.whiten(signature.linear);
        basis_.col(2) = space.whiten(signature.curvature);
        products_ = basis_.transpose() * basis_;
    }

    double operator()(double a) const {
        const Eigen::Vector3d c = coefficients(a);
        return c.dot(products_ * c);
    }
    /// Of the signature's slope, whitened, squared.
    double information(double a) const {
        const double inside = std::clamp(a, -reach_, reach_);
        const Eigen::Vector3d c(0, 1, 2 * inside);
        return c.dot(products_ * c);
    }

private:
    Eigen::Vector3d coefficients(double a) const {  // Signature::at
        const double inside = std::clamp(a, -reach_, reach_);
        return {1, -a, -(inside * inside + (a - inside) * 2 * inside)};
    }

    double reach_;
    Eigen::MatrixXd basis_;
    Eigen::Matrix3d products_;
};

}  // namespace

double draw_error(const GapSpace& space, const Candidate& candidate, double amplitude) {
    const Signature& signature = *candidate.signature;
    const int pairs = signature.pairs();
    const Eigen::VectorXd slope = space.whiten(signature.slope(amplitude));
    const double information = slope.squaredNorm();
    if (pairs < 2 || !(information > 1e-300)) return 0;
    Eigen::VectorXd of_pair(pairs);  // the amplitude that stands for 1 in the mean
    for (int p = 0; p < pairs; ++p)
        of_pair[p] = slope.dot(space.whiten(signature.slopes.row(p))) / information;
    const double variance = (of_pair.array() - of_pair.mean()).square().sum() / (pairs - 1);
    const double chaos = 2 / (information * signature.reach * signature.reach);
    return std::abs(amplitude) * std::sqrt(std::max(0.0, variance - chaos) * (1 + 1.0 / pairs));
}

EffectFit fit_effect(const GapSpace& space, const Candidate& candidate, const Eigen::VectorXd& gap) {
    const Misfit misfit(space, *candidate.signature, gap);
    const double step = (candidate.high - candidate.low) / coarse_steps;
    double best = 0;
    for (int k = 0; k <= coarse_steps; ++k)
        if (const double a = candidate.low + k * step; misfit(a) < misfit(best)) best = a;
    const double left = std::max(candidate.low, best - step), right = std::min(candidate.high, best + step);
    const auto [amplitude, value] = boost::math::tools::brent_find_minima(misfit, left, right, bits);
    EffectFit fit;
    fit.amplitude = value < misfit(0) ? amplitude : 0;
    fit.score = 0.5 * (misfit(0) - misfit(fit.amplitude));
    const double information = misfit.information(fit.amplitude);
    fit.error = information > 1e-300 ? 1 / std::sqrt(information) : INFINITY;
    const double margin = 1e-3 * (candidate.high - candidate.low);
    fit.at_bound = fit.amplitude != 0 &&
                   (fit.amplitude < candidate.low + margin ? candidate.low != 0
                                                           : fit.amplitude > candidate.high - margin);
    return fit;
}

}  // namespace mcdem::diagnose
