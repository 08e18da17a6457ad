// What stands for a number that a scene says nothing of.
#pragma once
#include <limits>

namespace mcdem::inline scene {

inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

}  // namespace mcdem::scene
