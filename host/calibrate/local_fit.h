// A line or parabola through the points near a root, and its crossing with a target.
#pragma once
#include <limits>
#include <vector>

namespace mcdem::inline calibrate {

/// Unknown value.
constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Point {
    double x = 0;
    double y = 0;
};

struct Crossing {
    double x = 0;               ///< NaN if the fit does not rise through the target in the window
    double standard_error = 0;  ///< from the scatter about the fit; NaN with too few points
    double slope = 0;           ///< dy/dx there
};

/// Least squares over the points with low <= x <= high: a parabola for six or more points, otherwise a line.
Crossing crossing_of_fit(const std::vector<Point>& points, double low, double high, double target);

/// The increasing step function closest to the points (pool adjacent violators), in the order of x. `points`
/// must be sorted by x.
std::vector<double> rising_fit(const std::vector<Point>& points);

}  // namespace mcdem::calibrate
