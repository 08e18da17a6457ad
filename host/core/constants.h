// Physical constants.
#pragma once

namespace mcdem::inline core {

constexpr double gravity = 9.81;  // [m/s2]

}  // namespace mcdem::core
