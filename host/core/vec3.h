// Double-precision vectors and tensors on the host.
#pragma once
#include <Eigen/Core>

namespace mcdem::inline core {
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
}
