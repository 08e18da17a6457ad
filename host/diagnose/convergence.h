// Influence of a scene's numerics on its observables: paired runs with refined numerics, extrapolated to the
// limit.
#pragma once
#include <string>
#include <vector>

#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {

/// Runs of the scene with one numerical setting refined step by step.
struct RefinedRuns {
    std::string cause;              ///< "plate speed"
    std::string remedy;             ///< setting that reduces the error by the factor {}; empty: there is none
    std::vector<double> remaining;  ///< fraction of the error that remains after each step, from the order of
                                    ///< the method: 1/2, 1/4, ..
    std::vector<Eigen::MatrixXd> observed;  ///< by step; row: replica, column: cell
};

/// Error of one cell from one cause: the scene minus the limit of infinitely fine numerics.
struct CellError {
    double value = 0;
    double standard_error = 0;
    bool follows_order = true;  ///< false: the steps are inconsistent, and `value` is the difference of the
                                ///< last step, a lower limit
};

struct CauseErrors {
    std::string cause, remedy;
    std::vector<CellError> cells;
};

struct ConvergenceLimits {
    double force = 0.005;  ///< maximum relative error of forces
    double deviations =
        0.5;  ///< maximum of all other errors, in standard deviations of the replicates of one packing
};

struct Convergence {
    std::string scene, copies;  ///< `copies`: description of the replicas
    std::vector<Cell> cells;
    int replicas = 0;
    Eigen::VectorXd mean, deviation;  ///< of the scene's replicas, by cell
    std::vector<CauseErrors> causes;
    ConvergenceLimits limits;
    double seconds = 0;

    /// Standard deviation of the cell over replicas. The lower limit follows from the resolution, which must
    /// not exceed the allowed error: copies without rearrangements hardly differ.
    double scale(std::size_t cell) const;
    /// Largest allowed error of the cell, in units of the observable.
    double limit(std::size_t cell) const;
    /// Whether errors are relative, as for forces, whose observables are logarithms.
    bool is_relative(std::size_t cell) const;
    /// Whether the error is significantly beyond the limit.
    bool is_beyond(const CauseErrors& cause, std::size_t cell) const;
    /// The cell of an observable with the largest error from this cause over its limit; -1: none has one.
    int worst_cell(const CauseErrors& cause, int observable) const;
    /// The worst cell of all observables beyond its limit, or -1.
    int worst_beyond(const CauseErrors& cause) const;
};

/// `base`: observations of the scene itself. Rows are paired: a replica starts from the same packing in every
/// step. A replica without a value in a cell is left out there.
Convergence convergence_of(const Grid& grid, const Eigen::MatrixXd& base,
                           const std::vector<RefinedRuns>& refinements, const ConvergenceLimits& limits);

}  // namespace mcdem::diagnose
