// The space in which an observation is compared with the model: common cells, whitened noise, and uncertain
// parameters marginalised over their priors.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "diagnose/infer/library.h"

namespace mcdem::inline diagnose {

/// Covariance of rows with mean zero, shrunk towards its diagonal (Ledoit & Wolf 2004, applied to
/// correlations).
Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& rows);

/// Cells with finite values in every replicate and every used signature, and with nonzero variance.
std::vector<Eigen::Index> usable_cells(const Eigen::MatrixXd& baseline,
                                       const std::vector<const Signature*>& used,
                                       const Eigen::VectorXd& observed);

/// Subset of the cells, for ablations and the split into fitted and held-out cells.
using CellChoice = std::vector<Eigen::Index>;

/// Rows of `all` in the order of `cells`.
Eigen::VectorXd pick(const Eigen::VectorXd& all, const CellChoice& cells);

/// Observable::resolution of each selected cell, of `all` cells.
Eigen::ArrayXd resolutions(const CellChoice& cells, Eigen::Index all);

/// A refitted parameter: its linear signature on the selected cells and its prior.
struct FreeParameter {
    Eigen::VectorXd direction;  ///< per unit
    double sigma = 0;           ///< prior
};

class GapSpace {
public:
    /// `noise`: rows of the scatter of one replicate, all cells. `mean_of`: number of replicates in the mean
    /// that is compared with the observation (0: exact). `extra`: additional variance, all cells; empty:
    /// none.
    GapSpace(const Eigen::MatrixXd& noise, int mean_of, const CellChoice& cells,
             const std::vector<FreeParameter>& free, const Eigen::VectorXd& extra = {});

    const CellChoice& cells() const { return cells_; }
    /// Whitens a vector on all cells; its square is a chi-square of the gap with nuisances marginalised.
    Eigen::VectorXd whiten(const Eigen::VectorXd& all) const;
    /// Marginal log likelihood of a difference on all cells, up to a constant that depends on the number of
    /// cells.
    double log_likelihood(const Eigen::VectorXd& all) const;
    /// One sigma of each selected cell, moderated over its observable, without nuisances.
    const Eigen::ArrayXd& sigma() const { return sigma_; }
    /// Most probable values of the nuisances for a difference on all cells, and their posterior errors.
    Eigen::VectorXd fit_nuisances(const Eigen::VectorXd& all) const;
    Eigen::VectorXd nuisance_errors() const;
    /// A difference on the selected cells minus the contribution of the most probable nuisances.
    Eigen::VectorXd refitted(const Eigen::VectorXd& all) const;
    /// One sigma of a weighted sum of selected cells, without nuisances.
    double sigma_of(const Eigen::VectorXd& weights) const;

private:
    CellChoice cells_;
    Eigen::ArrayXd sigma_;
    Eigen::LLT<Eigen::MatrixXd> noise_, total_;
    Eigen::MatrixXd directions_;  // column: nuisance, on the chosen cells
    Eigen::MatrixXd posterior_;   // covariance of the nuisances
};

}  // namespace mcdem::diagnose
