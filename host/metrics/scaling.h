// The scaling law F ~ <Z><phi><b><f> between the force on the plate and averages over the packing.
#pragma once
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// One level: the product of averages over cycles.
struct ScalingPoint {
    Phase phase = Phase::load;
    double displacement = 0;  ///< [m]
    Estimate top_force;       ///< F [N]
    Estimate product;         ///< <Z><phi><b><f> [N m]
};

/// Levels with all factors known.
std::vector<ScalingPoint> scaling_points(const Levels& levels);

struct ScalingFit {
    double coefficient =
        not_available;                 ///< F = coefficient * product, least squares through the origin [1/m]
    double r_squared = not_available;  ///< 1 - residual / scatter about the mean force
    /// With F = a x + b x^2 fitted through the origin: the contribution b x^2 / (a x + b x^2) of the square
    /// at the largest product. 0: linear; positive: superlinear.
    double curvature = not_available;
    int points = 0;
};
ScalingFit fit_scaling(const std::vector<ScalingPoint>& points, std::optional<Phase> phase = std::nullopt);

}  // namespace mcdem::metrics
