#include "diagnose/infer/gap_space.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace mcdem::inline diagnose {

Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& rows) {
    const double n = static_cast<double>(rows.rows());
    const Eigen::RowVectorXd sigma = (rows.array().square().colwise().sum() / n).sqrt().max(1e-300);
    const Eigen::MatrixXd z = rows.array().rowwise() / sigma.array();
    const Eigen::MatrixXd correlation = z.transpose() * z / n;
    // Sum over pairs of cells of the variance of their correlation, over that of its square.
    const Eigen::MatrixXd squares = z.array().square();
    const double sampling =
        ((squares.transpose() * squares / n).array() - correlation.array().square()).sum() / n;
    const double signal = correlation.squaredNorm() - static_cast<double>(correlation.rows());
    const double shrink = signal > 0 ? std::clamp(sampling / signal, 0.0, 1.0) : 1.0;
    Eigen::MatrixXd shrunk = (1 - shrink) * correlation;
    shrunk.diagonal().setOnes();
    return sigma.asDiagonal() * shrunk * sigma.asDiagonal();
}

std::vector<Eigen::Index> usable_cells(const Eigen::MatrixXd& baseline,
                                       const std::vector<const Signature*>& used,
                                       const Eigen::VectorXd& observed) {
    std::vector<Eigen::Index> cells;
    for (Eigen::Index cell = 0; cell < observed.size(); ++cell) {
        const auto column = baseline.col(cell).array();
        const bool varies = column.isFinite().all() && (column - column[0]).abs().maxCoeff() > 0;
        if (varies && std::isfinite(observed[cell]) && std::ranges::all_of(used, [&](const Signature* s) {
                return std::isfinite(s->linear[cell]) && std::isfinite(s->curvature[cell]);
            }))
            cells.push_back(cell);
    }
    return cells;
}

// The cells of one observable are contiguous (cells_of).
Eigen::ArrayXd resolutions(const CellChoice& cells, Eigen::Index all) {
    const Eigen::Index each = cells_each(all);
    Eigen::ArrayXd list(static_cast<Eigen::Index>(cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) list[k] = observables()[cells[k] / each].resolution;
    return list;
}

Eigen::VectorXd pick(const Eigen::VectorXd& all, const CellChoice& cells) { return all(cells); }

namespace {

/// Variances of single cells, moderated towards the mean of their observable because there are few
/// replicates: as if that mean had been observed in a few more replicates (Smyth 2004). A cell with an
/// accidentally small scatter is then not significant.
Eigen::ArrayXd moderated(const Eigen::ArrayXd& variance, const CellChoice& cells,
                         const Eigen::MatrixXd& noise) {
    constexpr double replicates_more = 8;
    const Eigen::Index each = cells_each(noise.cols());
    const double n = static_cast<double>(noise.rows());
    std::map<Eigen::Index, std::pair<double, int>> sum;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        sum[cells[k] / each].first += variance[k];
        ++sum[cells[k] / each].second;
    }
    Eigen::ArrayXd result(variance.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const auto& [total, count] = sum[cells[k] / each];
        result[k] = (n * variance[k] + replicates_more * total / count) / (n + replicates_more);
    }
    return result;
}

}  // namespace

GapSpace::GapSpace(const Eigen::MatrixXd& noise, int mean_of, const CellChoice& cells,
                   const std::vector<FreeParameter>& free, const Eigen::VectorXd& extra)
    : cells_(cells) {
    const double both = 1 + (mean_of > 0 ? 1.0 / mean_of : 0);  // scatter of the observation and of the mean
    Eigen::MatrixXd covariance = both * shrunk_covariance(noise(Eigen::all, cells));
    covariance.diagonal() += resolutions(cells, noise.cols()).square().matrix();
    if (extra.size() > 0) covariance.diagonal() += pick(extra, cells);
    sigma_ = moderated(covariance.diagonal().array(), cells, noise).sqrt();
    directions_.resize(static_cast<Eigen::Index>(cells.size()), static_cast<Eigen::Index>(free.size()));
    Eigen::MatrixXd total = covariance;
    for (std::size_t k = 0; k < free.size(); ++k) {
        directions_.col(k) = pick(free[k].direction, cells);
        total.noalias() +=
            free[k].sigma * free[k].sigma * directions_.col(k) * directions_.col(k).transpose();
    }
    noise_.compute(covariance);
    total_.compute(total);
    if (free.empty())
        return;  // Eigen's solvers take the address of the first element, which does not exist here
    Eigen::MatrixXd precision = directions_.transpose() * noise_.solve(directions_);
    for (std::size_t k = 0; k < free.size(); ++k) precision(k, k) += 1 / (free[k].sigma * free[k].sigma);
    posterior_ = precision.llt().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols()));
}

Eigen::VectorXd GapSpace::whiten(const Eigen::VectorXd& all) const {
    return total_.matrixL().solve(pick(all, cells_));
}

double GapSpace::log_likelihood(const Eigen::VectorXd& all) const {
    const auto factor = total_.matrixLLT().diagonal().array();
    return -0.5 * whiten(all).squaredNorm() - factor.log().sum();
}

Eigen::VectorXd GapSpace::fit_nuisances(const Eigen::VectorXd& all) const {
    return posterior_ * (directions_.transpose() * noise_.solve(pick(all, cells_)));
}

Eigen::VectorXd GapSpace::refitted(const Eigen::VectorXd& all) const {
    return pick(all, cells_) - directions_ * fit_nuisances(all);
}

double GapSpace::sigma_of(const Eigen::VectorXd& weights) const {
    return (noise_.matrixU() * weights).norm();
}

Eigen::VectorXd GapSpace::nuisance_errors() const { return posterior_.diagonal().cwiseSqrt(); }

}  // namespace mcdem::diagnose
