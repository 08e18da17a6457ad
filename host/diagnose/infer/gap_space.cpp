#include "diagnose/infer/gap_space.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace mcdem::inline diagnose {
namespace {

bool has_value(const Signature& signature, Eigen::Index cell) {
    return std::isfinite(signature.linear[cell]) && std::isfinite(signature.curvature[cell]);
}

}  // namespace

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

CellChoice usable_cells(const Eigen::MatrixXd& baseline, const std::vector<const Signature*>& parameters,
                        const Eigen::VectorXd& observed) {
    CellChoice cells;
    for (Eigen::Index cell = 0; cell < observed.size(); ++cell) {
        const auto column = baseline.col(cell).array();
        const bool varies = column.isFinite().all() && (column - column[0]).abs().maxCoeff() > 0;
        if (varies && std::isfinite(observed[cell]) &&
            std::ranges::all_of(parameters, [&](const Signature* s) { return has_value(*s, cell); }))
            cells.push_back(cell);
    }
    return cells;
}

CellChoice lacking_cells(const Signature& signature) {
    CellChoice cells;
    for (Eigen::Index cell = 0; cell < signature.linear.size(); ++cell)
        if (!has_value(signature, cell)) cells.push_back(cell);
    return cells;
}

CellChoice without(const CellChoice& cells, const CellChoice& others) {
    CellChoice rest;
    std::ranges::set_difference(cells, others, std::back_inserter(rest));
    return rest;
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
    covariance_ = both * shrunk_covariance(noise(Eigen::all, cells));
    covariance_.diagonal() += resolutions(cells, noise.cols()).square().matrix();
    if (extra.size() > 0) covariance_.diagonal() += pick(extra, cells);
    sigma_ = moderated(covariance_.diagonal().array(), cells, noise).sqrt();
    directions_.resize(static_cast<Eigen::Index>(cells.size()), static_cast<Eigen::Index>(free.size()));
    priors_.resize(directions_.cols());
    for (std::size_t k = 0; k < free.size(); ++k) {
        directions_.col(k) = pick(free[k].direction, cells);
        priors_[k] = free[k].sigma;
    }
    factorise();
}

GapSpace::GapSpace(const GapSpace& whole, const std::vector<Eigen::Index>& places)
    : sigma_(whole.sigma_(places)),
      covariance_(whole.covariance_(places, places)),
      directions_(whole.directions_(places, Eigen::all)),
      priors_(whole.priors_) {
    for (const auto place : places) cells_.push_back(whole.cells_[place]);
    factorise();
}

void GapSpace::factorise() {
    posterior_ = priors_.array().square().matrix().asDiagonal();
    if (cells_.empty()) return;  // Eigen's solvers take the address of the first element
    noise_.compute(covariance_);
    Eigen::MatrixXd total = covariance_;
    for (Eigen::Index k = 0; k < priors_.size(); ++k)
        total.noalias() += priors_[k] * priors_[k] * directions_.col(k) * directions_.col(k).transpose();
    total_.compute(total);
    if (priors_.size() == 0) return;
    Eigen::MatrixXd precision = directions_.transpose() * noise_.solve(directions_);
    for (Eigen::Index k = 0; k < priors_.size(); ++k) precision(k, k) += 1 / (priors_[k] * priors_[k]);
    posterior_ = precision.llt().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols()));
}

const GapSpace& GapSpace::lacking(const CellChoice& lacking) const {
    const CellChoice rest = without(cells_, lacking);
    if (rest.size() == cells_.size()) return *this;
    std::shared_ptr<const GapSpace>& part = parts_[rest];
    if (part) return *part;
    std::vector<Eigen::Index> places;
    for (std::size_t k = 0; k < cells_.size(); ++k)
        if (std::ranges::binary_search(rest, cells_[k])) places.push_back(static_cast<Eigen::Index>(k));
    part = std::shared_ptr<const GapSpace>(new GapSpace(*this, places));
    return *part;
}

Eigen::VectorXd GapSpace::whiten(const Eigen::VectorXd& all) const {
    if (cells_.empty()) return {};
    return total_.matrixL().solve(pick(all, cells_));
}

double GapSpace::log_likelihood(const Eigen::VectorXd& all) const {
    if (cells_.empty()) return 0;
    const auto factor = total_.matrixLLT().diagonal().array();
    return -0.5 * whiten(all).squaredNorm() - factor.log().sum();
}

Eigen::VectorXd GapSpace::fit_nuisances(const Eigen::VectorXd& all) const {
    if (cells_.empty()) return Eigen::VectorXd::Zero(priors_.size());
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
