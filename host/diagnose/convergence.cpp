#include "diagnose/convergence.h"

#include <algorithm>
#include <cmath>

#include "metrics/estimate.h"

namespace mcdem::inline diagnose {
namespace {

/// Differences are significant beyond this number of standard errors, because about two thousand cells are
/// tested.
constexpr double sure = 4;

Estimate mean_of(const Eigen::ArrayXd& values) {
    return mean_over_replicas({values.data(), static_cast<std::size_t>(values.size())});
}

/// After step k the error e is reduced to e remaining_k, so the scene differs from step k by e (1 -
/// remaining_k). Least squares for each replica separately, so that the standard error includes correlations
/// between steps.
CellError error_of(const RefinedRuns& refinement, const Eigen::VectorXd& base, Eigen::Index cell) {
    const std::size_t steps = refinement.remaining.size();
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(base.size());
    double weight = 0;
    const auto difference = [&](std::size_t k) -> Eigen::ArrayXd {
        return (base - refinement.observed[k].col(cell)).array();
    };
    for (std::size_t k = 0; k < steps; ++k) {
        const double gone = 1 - refinement.remaining[k];
        sum += gone * difference(k);
        weight += gone * gone;
    }
    const Estimate fitted = mean_of(sum / weight);
    CellError error{fitted.value, fitted.standard_error};
    if (steps < 2) return error;
    const Estimate trend = mean_of(difference(0) / (1 - refinement.remaining.front()) -
                                   difference(steps - 1) / (1 - refinement.remaining.back()));
    if (!(std::abs(trend.value) > sure * trend.standard_error)) return error;
    const Estimate last = mean_of(difference(steps - 1));
    return {last.value, last.standard_error, false};
}

}  // namespace

bool Convergence::is_relative(std::size_t cell) const {
    const auto name = observables()[cells[cell].observable].name;
    return name == "top_force" || name == "mean_force";
}

double Convergence::scale(std::size_t cell) const {
    const double resolution = observables()[cells[cell].observable].resolution;
    return std::fmax(deviation[cell], resolution / limits.deviations);
}

double Convergence::limit(std::size_t cell) const {
    return is_relative(cell) ? limits.force : limits.deviations * scale(cell);
}

bool Convergence::is_beyond(const CauseErrors& cause, std::size_t cell) const {
    const CellError& error = cause.cells[cell];
    return std::abs(error.value) > limit(cell) && std::abs(error.value) > sure * error.standard_error;
}

int Convergence::worst_cell(const CauseErrors& cause, int observable) const {
    int worst = -1;
    double most = -1;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const double size = std::abs(cause.cells[c].value) / limit(c);
        if (cells[c].observable != observable || !(size > most)) continue;
        most = size;
        worst = static_cast<int>(c);
    }
    return worst;
}

int Convergence::worst_beyond(const CauseErrors& cause) const {
    int worst = -1;
    double most = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const double size = std::abs(cause.cells[c].value) / limit(c);
        if (!is_beyond(cause, c) || !(size > most)) continue;
        most = size;
        worst = static_cast<int>(c);
    }
    return worst;
}

Convergence convergence_of(const Grid& grid, const Eigen::MatrixXd& base,
                           const std::vector<RefinedRuns>& refinements, const ConvergenceLimits& limits) {
    Convergence result;
    result.cells = cells_of(grid);
    result.limits = limits;
    result.replicas = static_cast<int>(base.rows());
    result.mean = Eigen::VectorXd(base.cols());
    result.deviation = Eigen::VectorXd(base.cols());
    for (Eigen::Index c = 0; c < base.cols(); ++c) {
        const Estimate mean = mean_of(base.col(c).array());
        result.mean[c] = mean.value;
        result.deviation[c] = mean.standard_error * std::sqrt(static_cast<double>(mean.count));
    }
    for (const RefinedRuns& refinement : refinements) {
        CauseErrors errors{refinement.cause, refinement.remedy, {}};
        for (Eigen::Index c = 0; c < base.cols(); ++c)
            errors.cells.push_back(error_of(refinement, base.col(c), c));
        result.causes.push_back(std::move(errors));
    }
    return result;
}

}  // namespace mcdem::diagnose
