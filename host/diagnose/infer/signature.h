// How an effect moves the observation, as a function of its amplitude, learnt from paired runs.
#pragma once
#include <Eigen/Core>
#include <string>

namespace mcdem::inline diagnose {

/// mu(a) = linear a + curvature a^2 up to the largest amplitude simulated, straight on beyond it. One entry a
/// cell.
struct Signature {
    std::string name;
    double reach = 0;           ///< largest |a| of the paired runs
    Eigen::VectorXd linear;     ///< per unit amplitude
    Eigen::VectorXd curvature;  ///< per unit amplitude squared
    Eigen::VectorXd variance;   ///< of `linear`, from the scatter over pairs
    Eigen::MatrixXd slopes;     ///< row: pair; the difference at the second amplitude, over it

    Eigen::VectorXd at(double amplitude) const;
    Eigen::VectorXd slope(double amplitude) const;  ///< d mu / d a
    int pairs() const { return static_cast<int>(slopes.rows()); }
    /// Variance over pairs of `slopes`: how much packings (and random draws of the effect) differ in it,
    /// chaos included.
    Eigen::VectorXd spread() const;
};

/// The signature of a part `b` of what is left of a setting once a part `done` was taken off it: of the
/// amplitude done + b (1 - done), less what is done.
Signature continued_from(const Signature& signature, double done);

/// From differences of paired runs (row: pair, column: cell) at two amplitudes. What does not stand out of
/// the scatter over pairs is shrunk towards zero (positive-part James & Stein 1961, cell by cell), the
/// curvature first. Pairs of which a run failed (not-a-number throughout) are left out. Where fewer than two
/// are left, it is a straight line through those of the one amplitude at which runs hold; not-a-number where
/// they hold at neither.
Signature learn_signature(const std::string& name, double first, double second,
                          const Eigen::MatrixXd& at_first, const Eigen::MatrixXd& at_second);

}  // namespace mcdem::diagnose
