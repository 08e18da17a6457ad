// Median of a sample.
#pragma once
#include <algorithm>
#include <limits>
#include <vector>

namespace mcdem::inline core {

/// The upper one of the two middle values of an even number; NaN if empty.
inline double median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace mcdem::core
