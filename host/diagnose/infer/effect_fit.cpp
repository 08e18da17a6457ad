#include "diagnose/infer/effect_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <iterator>
#include <utility>

namespace mcdem::inline diagnose {
namespace {

constexpr int coarse_steps = 24;
constexpr int bits = 20;  // of the amplitude: 1e-6 of the range
/// Amplitudes are optimised in turn until none changes by more than this fraction of its range. Signatures
/// with a correlation of 0.99 need a hundred rounds.
constexpr double unmoved = 1e-5;
constexpr int max_rounds = 200;

/// -2 log likelihood as a function of the amplitudes, from products of the whitened gap and the terms of the
/// signatures.
class Misfit {
public:
    Misfit(const GapSpace& space, const std::vector<Candidate>& candidates, const Eigen::VectorXd& gap)
        : candidates_(candidates) {
        Eigen::MatrixXd basis(static_cast<Eigen::Index>(space.cells().size()), 1 + 2 * effects());
        basis.col(0) = space.whiten(gap);
        for (Eigen::Index k = 0; k < effects(); ++k) {
            basis.col(1 + 2 * k) = space.whiten(signature(k).linear);
            basis.col(2 + 2 * k) = space.whiten(signature(k).curvature);
        }
        products_ = basis.transpose() * basis;
    }

    double operator()(const Eigen::VectorXd& amplitudes) const {
        Eigen::VectorXd c(products_.rows());  // Signature::at
        c[0] = 1;
        for (Eigen::Index k = 0; k < effects(); ++k) {
            const double a = amplitudes[k], inside = within_reach(k, a);
            c[1 + 2 * k] = -a;
            c[2 + 2 * k] = -(inside * inside + (a - inside) * 2 * inside);
        }
        return c.dot(products_ * c);
    }

    /// Fisher information of the amplitudes: products of the whitened slopes of their signatures.
    Eigen::MatrixXd information(const Eigen::VectorXd& amplitudes) const {
        Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(products_.rows(), effects());
        for (Eigen::Index k = 0; k < effects(); ++k) {
            slopes(1 + 2 * k, k) = 1;
            slopes(2 + 2 * k, k) = 2 * within_reach(k, amplitudes[k]);
        }
        return slopes.transpose() * products_ * slopes;
    }

    /// The best amplitude `k` with the others fixed.
    double best_amplitude(Eigen::VectorXd amplitudes, Eigen::Index k) const {
        const auto misfit = [&](double a) {
            amplitudes[k] = a;
            return (*this)(amplitudes);
        };
        const auto [low, high] = bounds(k);
        const double step = (high - low) / coarse_steps;
        double best = 0;
        for (int i = 0; i <= coarse_steps; ++i)
            if (const double a = low + i * step; misfit(a) < misfit(best)) best = a;
        const double left = std::max(low, best - step), right = std::min(high, best + step);
        const auto [amplitude, value] = boost::math::tools::brent_find_minima(misfit, left, right, bits);
        return value < misfit(0) ? amplitude : 0;
    }

    Eigen::VectorXd best_amplitudes() const {
        Eigen::VectorXd amplitudes = Eigen::VectorXd::Zero(effects());
        bool moved = true;
        for (int round = 0; moved && round < max_rounds; ++round) {
            moved = false;
            for (Eigen::Index k = 0; k < effects(); ++k) {
                const double before = amplitudes[k];
                const auto [low, high] = bounds(k);
                amplitudes[k] = best_amplitude(amplitudes, k);
                moved = moved || std::abs(amplitudes[k] - before) > unmoved * (high - low);
            }
            if (effects() == 1) break;
        }
        return amplitudes;
    }

private:
    Eigen::Index effects() const { return static_cast<Eigen::Index>(candidates_.size()); }
    const Signature& signature(Eigen::Index k) const { return *candidates_[k].signature; }
    std::pair<double, double> bounds(Eigen::Index k) const {
        const Candidate& candidate = candidates_[k];
        return {candidate.low, candidate.high};
    }
    double within_reach(Eigen::Index k, double a) const {
        return std::clamp(a, -signature(k).reach, signature(k).reach);
    }

    const std::vector<Candidate>& candidates_;
    Eigen::MatrixXd products_;
};

}  // namespace

CellChoice lacking_cells(const std::vector<Candidate>& candidates) {
    CellChoice all;
    for (const Candidate& candidate : candidates) {
        CellChoice both;
        std::ranges::set_union(all, candidate.lacking, std::back_inserter(both));
        all = std::move(both);
    }
    return all;
}

double draw_error(const GapSpace& whole, const Candidate& candidate, double amplitude) {
    const GapSpace& space = whole.lacking(candidate.lacking);
    const Signature& signature = *candidate.signature;
    const int pairs = signature.pairs();
    const Eigen::VectorXd slope = space.whiten(signature.slope(amplitude));
    const double information = slope.squaredNorm();
    if (pairs < 2 || !(information > 1e-300)) return 0;
    Eigen::VectorXd of_pair(pairs);  // amplitude of each pair relative to the mean
    for (int p = 0; p < pairs; ++p)
        of_pair[p] = slope.dot(space.whiten(signature.slopes.row(p))) / information;
    const double variance = (of_pair.array() - of_pair.mean()).square().sum() / (pairs - 1);
    const double chaos = 2 / (information * signature.reach * signature.reach);
    return std::abs(amplitude) * std::sqrt(std::max(0.0, variance - chaos) * (1 + 1.0 / pairs));
}

JointFit fit_effects(const GapSpace& space, const std::vector<Candidate>& candidates,
                     const Eigen::VectorXd& gap) {
    const Misfit misfit(space.lacking(lacking_cells(candidates)), candidates, gap);
    const Eigen::VectorXd amplitudes = misfit.best_amplitudes();
    const Eigen::MatrixXd information = misfit.information(amplitudes);
    const Eigen::FullPivLU<Eigen::MatrixXd> solver(information);
    JointFit fit;
    fit.amplitudes.assign(amplitudes.begin(), amplitudes.end());
    fit.errors.assign(candidates.size(), INFINITY);
    if (information.diagonal().minCoeff() > 1e-300 && solver.isInvertible()) {
        const Eigen::VectorXd variances = solver.inverse().diagonal();
        std::ranges::transform(variances, fit.errors.begin(), [](double v) { return std::sqrt(v); });
    }
    fit.score = 0.5 * (misfit(Eigen::VectorXd::Zero(amplitudes.size())) - misfit(amplitudes));
    return fit;
}

EffectFit fit_effect(const GapSpace& space, const Candidate& candidate, const Eigen::VectorXd& gap) {
    const JointFit alone = fit_effects(space, {candidate}, gap);
    EffectFit fit{.amplitude = alone.amplitudes[0], .error = alone.errors[0], .score = alone.score};
    const double margin = 1e-3 * (candidate.high - candidate.low);
    fit.at_bound = fit.amplitude != 0 &&
                   (fit.amplitude < candidate.low + margin ? candidate.low != 0
                                                           : fit.amplitude > candidate.high - margin);
    return fit;
}

}  // namespace mcdem::diagnose
