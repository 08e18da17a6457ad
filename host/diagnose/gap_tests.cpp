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

/// When the plate passes a cell, by its place among those of its observable: loading, then unloading back.
double passage(Eigen::Index place, Eigen::Index places) {
    return static_cast<double>(2 * place < places ? place : places - 1 - (place - places / 2));
}

/// Mean and trend of every observable with three cells or more, as weights of the chosen cells, which lie
/// observable by observable, loading before unloading, each by displacement (cells_of). Cells weigh by what
/// is known of them, 1/sigma^2.
std::vector<Eigen::VectorXd> observable_patterns(const GapSpace& space, Eigen::Index all) {
    constexpr std::size_t fewest = 3;
    const CellChoice& cells = space.cells();
    const Eigen::Index each = all / static_cast<Eigen::Index>(observables().size());
    std::vector<Eigen::VectorXd> patterns;
    for (std::size_t first = 0, end = 0; first < cells.size(); first = end) {
        while (end < cells.size() && cells[end] / each == cells[first] / each) ++end;
        if (end - first < fewest) continue;
        Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.size())), trend = mean;
        for (std::size_t k = first; k < end; ++k) {
            const auto cell = static_cast<Eigen::Index>(k);
            mean[cell] = 1 / (space.sigma()[cell] * space.sigma()[cell]);
            trend[cell] = mean[cell] * passage(cells[k] % each, each);
        }
        trend -= trend.sum() / mean.sum() * mean;
        patterns.push_back(mean);
        patterns.push_back(trend);
    }
    return patterns;
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
    s.highest_refitted = (space.refitted(gap).array() / space.sigma()).abs().maxCoeff();
    Eigen::VectorXd left = gap;
    if (s.directed > 0) left -= data.candidates[s.best].signature->at(s.fits[s.best].amplitude);
    s.pattern_left = highest_pattern(space, left);
    return s;
}

double highest_pattern(const GapSpace& space, const Eigen::VectorXd& gap) {
    const Eigen::VectorXd left = space.refitted(gap);
    double highest = (left.array() / space.sigma()).abs().maxCoeff();
    for (const Eigen::VectorXd& weights : observable_patterns(space, gap.size()))
        highest = std::max(highest, std::abs(weights.dot(left)) / space.sigma_of(weights));
    return highest;
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

double NullDistribution::misfit_p(const GapSpace& space, const Eigen::VectorXd& left) const {
    const double together = p_value(&GapStatistics::remainder, space.whiten(left).squaredNorm());
    const double pattern = p_value(&GapStatistics::pattern_left, highest_pattern(space, left));
    return std::min(1.0, 2 * std::min(together, pattern));
}

double NullDistribution::quantile(double GapStatistics::*statistic, double p) const {
    return boost::math::quantile(complement(fitted_gamma(draws_, statistic), p));
}

}  // namespace mcdem
