// The space in which an observation is held against the model: cells that all of them have, noise whitened,
// and the model's rough parameters free to move within their priors.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "diagnose/infer/library.h"

namespace mcdem::inline diagnose {

/// Covariance of rows with mean zero, shrunk towards its own diagonal (Ledoit & Wolf 2004, on correlations).
Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& rows);

/// Cells whose value is finite in every replicate and every signature that is used, and that vary at all.
std::vector<Eigen::Index> usable_cells(const Eigen::MatrixXd& baseline,
                                       const std::vector<const Signature*>& used,
                                       const Eigen::VectorXd& observed);

/// What a space may leave out: the ablations, and the split into fitted and held-out cells.
using CellChoice = std::vector<Eigen::Index>;

/// Rows of `all` in the order of `cells`.
Eigen::VectorXd pick(const Eigen::VectorXd& all, const CellChoice& cells);
Eigen::MatrixXd pick_columns(const Eigen::MatrixXd& all, const CellChoice& cells);

/// Observable::resolution of each chosen cell, of `all` cells.
Eigen::ArrayXd resolutions(const CellChoice& cells, Eigen::Index all);

/// A parameter that is refitted: its linear signature on the chosen cells and its prior.
struct FreeParameter {
    Eigen::VectorXd direction;  ///< per unit
    double sigma = 0;           ///< prior
};

class GapSpace {
public:
    /// `noise`: rows of one replicate's scatter, all cells; `mean_of`: replicates behind the mean that the
    /// observed is compared with (0: known exactly). `extra`: variance that comes on top, all cells; empty:
    /// none.
    GapSpace(const Eigen::MatrixXd& noise, int mean_of, const CellChoice& cells,
             const std::vector<FreeParameter>& free, const Eigen::VectorXd& extra = {});

    const CellChoice& cells() const { return cells_; }
    /// Whitens a vector on all cells: its square is a chi-square of the gap with nuisances marginalised.
    Eigen::VectorXd whiten(const Eigen::VectorXd& all) const { return whiten_chosen(pick(all, cells_)); }
    Eigen::VectorXd whiten_chosen(const Eigen::VectorXd& chosen) const;
    /// Of a difference on all cells, nuisances marginalised, but for a constant of the number of cells.
    double log_likelihood(const Eigen::VectorXd& all) const;
    /// One sigma of each chosen cell by itself, moderated over its observable; nuisances not counted.
    const Eigen::ArrayXd& sigma() const { return sigma_; }
    /// The nuisances' most probable values given a difference on all cells, and their errors after it.
    Eigen::VectorXd fit_nuisances(const Eigen::VectorXd& all) const;
    Eigen::VectorXd nuisance_errors() const;
    /// What is left of a difference, on the chosen cells, once the nuisances have their most probable values.
    Eigen::VectorXd refitted(const Eigen::VectorXd& all) const;
    /// One sigma of a weighted sum of chosen cells; nuisances not counted.
    double sigma_of(const Eigen::VectorXd& weights) const;
    const std::vector<FreeParameter>& free() const { return free_; }

private:
    CellChoice cells_;
    std::vector<FreeParameter> free_;
    Eigen::ArrayXd sigma_;
    Eigen::LLT<Eigen::MatrixXd> noise_, total_;
    Eigen::MatrixXd directions_;  // column: nuisance, on the chosen cells
    Eigen::MatrixXd posterior_;   // covariance of the nuisances
};

}  // namespace mcdem::diagnose
