// The space in which an observation is compared with the model: common cells, whitened noise, and uncertain
// parameters marginalised over their priors.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <map>
#include <memory>
#include <vector>

#include "diagnose/infer/library.h"

namespace mcdem::inline diagnose {

/// Covariance of rows with mean zero, shrunk towards its diagonal (Ledoit & Wolf 2004, applied to
/// correlations).
Eigen::MatrixXd shrunk_covariance(const Eigen::MatrixXd& rows);

/// Subset of the cells in ascending order, for ablations and the split into fitted and held-out cells.
using CellChoice = std::vector<Eigen::Index>;

/// Cells with finite values in every replicate and in the signature of every uncertain parameter, and with
/// nonzero variance. A parameter whose change of a cell is unknown may shift it by any amount.
CellChoice usable_cells(const Eigen::MatrixXd& baseline, const std::vector<const Signature*>& parameters,
                        const Eigen::VectorXd& observed);

/// Cells in which a signature has no value.
CellChoice lacking_cells(const Signature& signature);
/// `cells` that are not among `others`.
CellChoice without(const CellChoice& cells, const CellChoice& others);

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
    /// The same on its cells that are not among `lacking`: nothing is assumed about the others. Refers to
    /// this space or a part of it that lives as long.
    const GapSpace& lacking(const CellChoice& lacking) const;
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
    /// The part of `whole` at these places of its cells.
    GapSpace(const GapSpace& whole, const std::vector<Eigen::Index>& places);
    /// From cells, covariance, directions and priors.
    void factorise();

    CellChoice cells_;
    Eigen::ArrayXd sigma_;
    Eigen::MatrixXd covariance_;  // without nuisances
    Eigen::LLT<Eigen::MatrixXd> noise_, total_;
    Eigen::MatrixXd directions_;  // column: nuisance, on the chosen cells
    Eigen::VectorXd priors_;      // one sigma of each nuisance
    Eigen::MatrixXd posterior_;   // covariance of the nuisances
    mutable std::map<CellChoice, std::shared_ptr<const GapSpace>> parts_;  // by its cells
};

}  // namespace mcdem::diagnose
