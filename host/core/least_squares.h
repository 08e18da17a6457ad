// Linear least squares.
#pragma once
#include <Eigen/Core>

namespace mcdem::inline core {

/// The coefficients c that minimise |columns c - values|; for dependent columns one of the solutions.
/// Compiled once: Eigen's decompositions are templates that take long to compile.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& values);

}  // namespace mcdem::core
