#include "diagnose/infer/gap_tests.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <set>

#include "scene/random.h"

namespace mcdem::inline diagnose {
namespace {

constexpr int draws_a_replicate = 3;

/// The replicates without one fold, and that fold as if it were observed. Left-out replicates do not
/// contribute to the mean either: otherwise a small set would lie in the subspace of the others' scatter, in
/// contrast to an experiment.
class LeftOut {
public:
    LeftOut(const GapData& data, int fold) : data_(data) {
        for (std::size_t r = 0; r < data.fold.size(); ++r)
            (data.fold[r] == fold ? out_ : kept_).push_back(static_cast<Eigen::Index>(r));
    }

    Eigen::MatrixXd noise() const {
        std::vector<Eigen::Index> rows;
        std::vector<int> group;
        for (const auto r : kept_) {
            const auto alike = [&](Eigen::Index other) { return group_of(other) == group_of(r); };
            if (std::ranges::count_if(kept_, alike) < 2) continue;  // only one replicate left
            rows.push_back(r);
            group.push_back(group_of(r));
        }
        return apart_from_mean(unscaled(rows), group);
    }
    const std::vector<Eigen::Index>& rows() const { return out_; }

    /// A row minus the mean of the remaining replicates, scaled to the variance of one replicate.
    Eigen::VectorXd row(Eigen::Index r) const {
        Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(data_.noise.cols());
        int kept = 0;
        for (const auto other : kept_)
            if (group_of(other) == group_of(r)) sum += data_.noise.row(other), ++kept;
        if (kept == 0) return data_.noise.row(r).transpose();
        return unscaling(r) / std::sqrt(1 + 1.0 / kept) * (data_.noise.row(r) - sum / kept).transpose();
    }

private:
    /// Rows before they were scaled to the variance of one replicate.
    Eigen::MatrixXd unscaled(const std::vector<Eigen::Index>& rows) const {
        Eigen::MatrixXd some = data_.noise(rows, Eigen::all);
        for (std::size_t k = 0; k < rows.size(); ++k)
            some.row(static_cast<Eigen::Index>(k)) *= unscaling(rows[k]);
        return some;
    }
    double unscaling(Eigen::Index r) const {
        const double n = static_cast<double>(std::ranges::count(data_.group, group_of(r)));
        return std::sqrt(std::max(1.0, n - 1) / n);
    }
    int group_of(Eigen::Index r) const { return data_.group[r]; }
    const GapData& data_;
    std::vector<Eigen::Index> kept_, out_;
};

using PackingDraws = std::map<int, std::vector<GapStatistics>>;

/// The cube root of a statistic is nearly normal (Wilson & Hilferty 1931). Its mean and variance are
/// estimated from few replicates, so a further replicate follows Student's t. Packings differ in both. The
/// mean is that of the first packing, the experiment's own if it is known. The variance is pooled over the
/// packings; for the experiment's own it is known no better than from that packing's replicates.
struct Predicted {
    double mean = 0, sigma = 0;
    double own_degrees = 0, pooled_degrees = 0;  ///< of freedom

    double complement_at(double value, double degrees) const {
        const boost::math::students_t_distribution<> t(degrees);
        return value > 0 ? cdf(complement(t, (std::cbrt(value) - mean) / sigma)) : 1;
    }
    double quantile(double p) const {
        const boost::math::students_t_distribution<> t(own_degrees);
        return std::pow(std::max(0.0, mean + sigma * boost::math::quantile(complement(t, p))), 3);
    }
};

double replicates_of(const std::vector<GapStatistics>& draws) {
    return static_cast<double>(draws.size()) / draws_a_replicate;
}

double mean_root(const std::vector<GapStatistics>& draws, double GapStatistics::*statistic) {
    double mean = 0;
    for (const GapStatistics& draw : draws)
        mean += std::cbrt(draw.*statistic) / static_cast<double>(draws.size());
    return mean;
}

Predicted predicted(const PackingDraws& draws, double GapStatistics::*statistic) {
    const std::vector<GapStatistics>& own = draws.begin()->second;
    const double mean = mean_root(own, statistic), n = replicates_of(own);
    double squares = 0, degrees = 0;
    for (const auto& [_, of_packing] : draws) {
        const double centre = mean_root(of_packing, statistic);
        for (const GapStatistics& draw : of_packing)
            squares += std::pow(std::cbrt(draw.*statistic) - centre, 2) / draws_a_replicate;
        degrees += replicates_of(of_packing) - 1;
    }
    const double variance = std::max(squares / degrees, 1e-12 * mean * mean);
    return {mean, std::sqrt(variance * (1 + 1 / n)), n - 1, degrees};
}

/// Statistics are larger if fewer replicates determine the covariance. Scales those of the draws by the ratio
/// found for the observed gap when a fold is left out.
void take_to_scale(std::vector<GapStatistics>& draws, const std::vector<GapStatistics>& left_out,
                   const GapStatistics& whole) {
    for (double GapStatistics::*statistic :
         {&GapStatistics::omnibus, &GapStatistics::directed, &GapStatistics::remainder,
          &GapStatistics::highest_refitted, &GapStatistics::pattern_left}) {
        double mean = 0;
        for (const GapStatistics& one : left_out)
            mean += one.*statistic / static_cast<double>(left_out.size());
        if (!(mean > 0) || !(whole.*statistic > 0)) continue;
        for (GapStatistics& draw : draws) draw.*statistic *= whole.*statistic / mean;
    }
}

/// Order in which the plate passes a cell, by its index in its observable: loading, then unloading.
double passage(Eigen::Index place, Eigen::Index places) {
    return static_cast<double>(2 * place < places ? place : places - 1 - (place - places / 2));
}

/// Mean and trend of every observable with three or more cells, as weights of the selected cells, which are
/// ordered by observable, phase (loading first) and displacement (cells_of). Cells have the weight 1/sigma^2.
std::vector<Eigen::VectorXd> observable_patterns(const GapSpace& space, Eigen::Index all) {
    constexpr std::size_t fewest = 3;
    const CellChoice& cells = space.cells();
    const Eigen::Index each = cells_each(all);
    std::vector<Eigen::VectorXd> patterns;
    for (std::size_t first = 0, end = 0; first < cells.size(); first = end) {
        while (end < cells.size() && cells[end] / each == cells[first] / each) ++end;
        if (end - first < fewest) continue;
        Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.size())), trend = mean;
        for (std::size_t k = first; k < end; ++k) {
            mean[k] = 1 / (space.sigma()[k] * space.sigma()[k]);
            trend[k] = mean[k] * passage(cells[k] % each, each);
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
    const bool own_known = std::ranges::find(data.group, own_packing) != data.group.end();
    const std::set<int> folds(data.fold.begin(), data.fold.end());
    std::vector<GapStatistics> observed;
    for (const int fold : folds) {
        const LeftOut left_out(data, fold);
        const GapSpace space(left_out.noise(), mean_of, data.cells, data.free);
        observed.push_back(gap_statistics(space, data, data.gap));
        for (const Eigen::Index r : left_out.rows())
            for (int draw = 0; draw < draws_a_replicate; ++draw) {
                Eigen::VectorXd gap = both * left_out.row(r);
                for (const FreeParameter& parameter : data.free)
                    gap += parameter.sigma * random.normal() * parameter.direction;
                const int packing = own_known ? data.group[r] : 0;
                draws_[packing].push_back(gap_statistics(space, data, gap));
            }
    }
    const GapSpace whole(data.noise, mean_of, data.cells, data.free);
    const GapStatistics all = gap_statistics(whole, data, data.gap);
    for (auto& [_, draws] : draws_) take_to_scale(draws, observed, all);
}

double NullDistribution::p_value(double GapStatistics::*statistic, double value) const {
    const Predicted root = predicted(draws_, statistic);
    return root.complement_at(value, root.own_degrees);
}

double NullDistribution::mean(double GapStatistics::*statistic) const {
    const std::vector<GapStatistics>& own = draws_.begin()->second;
    double sum = 0;
    for (const GapStatistics& draw : own) sum += draw.*statistic;
    return sum / static_cast<double>(own.size());
}

double NullDistribution::misfit_p(const GapSpace& space, const Eigen::VectorXd& left) const {
    const auto p = [&](double GapStatistics::*statistic, double value) {
        const Predicted root = predicted(draws_, statistic);
        return root.complement_at(value, root.pooled_degrees);
    };
    const double together = p(&GapStatistics::remainder, space.whiten(left).squaredNorm());
    const double pattern = p(&GapStatistics::pattern_left, highest_pattern(space, left));
    return std::min(1.0, 2 * std::min(together, pattern));
}

double NullDistribution::quantile(double GapStatistics::*statistic, double p) const {
    return predicted(draws_, statistic).quantile(p);
}

}  // namespace mcdem::diagnose
