// Double-precision vectors of the host side.
#pragma once
#include <Eigen/Core>

namespace mcdem::inline core {
using Vec3 = Eigen::Vector3d;
}
