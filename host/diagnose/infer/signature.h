// Change of the observation by an effect as a function of its amplitude, from paired runs.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace mcdem::inline diagnose {

/// mu(a) = linear a + curvature a^2 up to the largest simulated amplitude, linear beyond it. One entry per
/// cell.
struct Signature {
    std::string name;
    double reach = 0;           ///< largest |a| of the paired runs
    Eigen::VectorXd linear;     ///< per unit amplitude
    Eigen::VectorXd curvature;  ///< per unit amplitude squared
    Eigen::MatrixXd slopes;     ///< row: pair; difference at the second amplitude over that amplitude

    Eigen::VectorXd at(double amplitude) const;
    Eigen::VectorXd slope(double amplitude) const;  ///< d mu / d a
    int pairs() const { return static_cast<int>(slopes.rows()); }
    /// Variance over pairs of `slopes`: differences between packings, random draws of the effect, and chaos.
    Eigen::VectorXd spread() const;
};

/// Rows of complete runs; a failed run has only NaN.
std::vector<Eigen::Index> rows_with_numbers(const Eigen::MatrixXd& rows);

/// The signature of a further reduction `b` of a setting after it was reduced by `done`: that of the
/// amplitude done + b (1 - done) minus that of `done`.
Signature continued_from(const Signature& signature, double done);

/// From differences of paired runs (row: pair, column: cell) at two amplitudes. Values are shrunk towards
/// zero according to the scatter over pairs (positive-part James & Stein 1961, cell by cell), the curvature
/// first. Pairs with a failed run (all NaN) are left out. With fewer than two complete pairs, it is a
/// straight line through the results at the amplitude at which runs succeed; NaN if they succeed at neither.
/// The same holds for a single cell without a value in some pair: a force whose logarithm is observed may
/// vanish with a large effect only.
Signature learn_signature(const std::string& name, double first, double second,
                          const Eigen::MatrixXd& at_first, const Eigen::MatrixXd& at_second);

}  // namespace mcdem::diagnose
