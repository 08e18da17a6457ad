// Marker for numbers that a scene does not specify.
#pragma once
#include <limits>

namespace mcdem::inline scene {

inline constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

}  // namespace mcdem::scene
