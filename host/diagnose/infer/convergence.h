// What the numerics of a scene do to its observables: paired runs with finer numerics, extrapolated to their
// limit.
#pragma once
#include <string>
#include <vector>

#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {

/// Runs of the scene with one kind of numerics refined step by step.
struct RefinedRuns {
    std::string cause;   ///< "plate speed"
    std::string remedy;  ///< what brings the error down by a factor, with {} for it; empty: nothing to set
    std::vector<double>
        remaining;  ///< part of the error that each step leaves, by the method's order: 1/2, 1/4, ..
    std::vector<Eigen::MatrixXd> observed;  ///< by step; row: replica, column: cell
};

/// Error of one cell by one cause: the scene less the limit of infinitely fine numerics.
struct CellError {
    double value = 0;
    double standard_error = 0;
    bool follows_order =
        true;  ///< false: steps disagree, `value` is the last step's difference, at least that large
};

struct CauseErrors {
    std::string cause, remedy;
    std::vector<CellError> cells;
};

struct ConvergenceLimits {
    double force = 0.005;     ///< largest relative error of forces
    double deviations = 0.5;  ///< .. of everything else, in standard deviations of one packing's replicates
};

struct Convergence {
    std::string scene, copies;  ///< `copies`: what the replicas are
    std::vector<Cell> cells;
    int replicas = 0;
    Eigen::VectorXd mean, deviation;  ///< of the scene's replicas, by cell
    std::vector<CauseErrors> causes;
    ConvergenceLimits limits;
    double seconds = 0;

    /// Standard deviation of the cell over replicas, at least what makes its resolution count as the largest
    /// error that is allowed: copies that do not rearrange hardly differ.
    double scale(std::size_t cell) const;
    /// Largest error of the cell that is within the limits, in the observable's units.
    double limit(std::size_t cell) const;
    /// Errors of forces are relative: their observables are logarithms.
    bool is_relative(std::size_t cell) const;
    /// Beyond the limit, and not by chance.
    bool is_beyond(const CauseErrors& cause, std::size_t cell) const;
    /// The cell of an observable where this cause's error is largest over its limit; -1: no cell has it.
    int worst_cell(const CauseErrors& cause, int observable) const;
    /// .. of all observables that is beyond its limit, or -1.
    int worst_beyond(const CauseErrors& cause) const;
};

/// `base`: the scene's own observations. Rows are paired: a replica starts from the same packing in every
/// step. Cells in which a replica has no value leave that replica out.
Convergence convergence_of(const Grid& grid, const Eigen::MatrixXd& base,
                           const std::vector<RefinedRuns>& refinements, const ConvergenceLimits& limits);

}  // namespace mcdem::diagnose
