#include "core/least_squares.h"

#include <Eigen/QR>

namespace mcdem::inline core {

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& values) {
    return columns.colPivHouseholderQr().solve(values);
}

}  // namespace mcdem::core
