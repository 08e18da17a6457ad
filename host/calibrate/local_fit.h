// A line or parabola through the points near a root, and where it crosses a target.
#pragma once
#include <limits>
#include <vector>

namespace mcdem::inline calibrate {

/// What a fit does not tell.
constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Point {
    double x = 0;
    double y = 0;
};

struct Crossing {
    double x = 0;               ///< not-a-number where the fit does not rise through the target in the window
    double standard_error = 0;  ///< from the scatter about the fit; not-a-number where too few points tell it
};

/// Least squares over the points with low <= x <= high: a parabola from six points on, below that a line.
Crossing crossing_of_fit(const std::vector<Point>& points, double low, double high, double target);

/// The rising step function closest to the points (pool adjacent violators): values in the order of x.
/// `points` must be sorted by x.
std::vector<double> rising_fit(const std::vector<Point>& points);

}  // namespace mcdem::calibrate
