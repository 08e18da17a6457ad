#include "diagnose/gap_tests.h"

#include <boost/math/distributions/gamma.hpp>
#include <cmath>
#include <set>

#include "scene/random.h"

namespace mcdem {
namespace {

constexpr int draws_a_replicate = 3;

/// Rows of all folds but one.
Eigen::MatrixXd without_fold(const GapData& data, int fold) {
    std::vector<Eigen::Index> kept;
    for (std::size_t r = 0; r < data.fold.size(); ++r)
        if (data.fold[r] != fold) kept.push_back(static_cast<Eigen::Index>(r));
    return data.noise(kept, Eigen::all);
}

boost::math::gamma_distribution<> fitted_gamma(const std::vector<GapStatistics>& draws,
                                               double GapStatistics::*statistic) {
    double mean = 0, square = 0;
    for (const GapStatistics& draw : draws) mean += draw.*statistic / static_cast<double>(draws.size());
    for (const GapStatistics& draw : draws)
        square += std::pow(draw.*statistic - mean, 2) / static_cast<double>(draws.size() - 1);
    return {mean * mean / square, square / mean};
}

}  // namespace

GapStatistics gap_statistics(const GapSpace& space, const GapData& data, const Eigen::VectorXd& gap) {
    GapStatistics s;
    s.omnibus = space.whiten(gap).squaredNorm();
    for (const Candidate& candidate : data.candidates) {
        s.fits.push_back(fit_effect(space, candidate, gap));
        if (s.fits.back().score > s.fits[s.best].score) s.best = s.fits.size() - 1;
    }
    if (!s.fits.empty()) s.directed = s.fits[s.best].score;
    s.remainder = s.omnibus - 2 * s.directed;
    Eigen::VectorXd refitted = pick(gap, space.cells());
    const Eigen::VectorXd shifts = space.fit_nuisances(gap);
    for (Eigen::Index k = 0; k < shifts.size(); ++k)
        refitted -= shifts[k] * pick(space.free()[static_cast<std::size_t>(k)].direction, space.cells());
    s.highest_refitted = (refitted.array() / space.sigma()).abs().maxCoeff();
    return s;
}

NullDistribution::NullDistribution(const GapData& data, int mean_of, std::uint64_t seed) {
    Random random(seed, Stream::null_draws);
    const double both = std::sqrt(1 + (mean_of > 0 ? 1.0 / mean_of : 0));
    const std::set<int> folds(data.fold.begin(), data.fold.end());
    for (const int fold : folds) {
        const GapSpace space(without_fold(data, fold), mean_of, data.cells, data.free);
        for (std::size_t r = 0; r < data.fold.size(); ++r) {
            if (data.fold[r] != fold) continue;
            for (int draw = 0; draw < draws_a_replicate; ++draw) {
                Eigen::VectorXd gap = both * data.noise.row(static_cast<Eigen::Index>(r)).transpose();
                for (const FreeParameter& parameter : data.free)
                    gap += parameter.sigma * random.normal() * parameter.direction;
                draws_.push_back(gap_statistics(space, data, gap));
            }
        }
    }
}

double NullDistribution::p_value(double GapStatistics::*statistic, double value) const {
    return value > 0 ? cdf(complement(fitted_gamma(draws_, statistic), value)) : 1;
}

double NullDistribution::quantile(double GapStatistics::*statistic, double p) const {
    return boost::math::quantile(complement(fitted_gamma(draws_, statistic), p));
}

}  // namespace mcdem
