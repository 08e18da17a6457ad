// The contact model "elastic sphere" for one Poisson ratio, as polynomials that a kernel can evaluate.
// Fitted to the integrals of elastic_sphere_series.h alone: no simulation or measurement enters.
#pragma once
#include "elasticity/surface_displacement.h"

namespace mcdem::inline elasticity {

/// Coefficients of SurfaceLaw, lowest order first. Largest errors, in F/(E R), worst at nu = 0 and falling
/// towards nu = 1/2: point 1e-4 and size 8e-5 for s from 0.15 to 1, self 5e-4 for a/R from 0.03 to 0.64.
struct ElasticSphere {
    std::array<double, point_terms> point{};
    std::array<double, size_terms> size{};
    std::array<double, self_terms> self{};
};

/// The fit takes some milliseconds; its result is kept for every Poisson ratio asked for. Any thread may
/// call.
ElasticSphere elastic_sphere(double poisson_ratio);

}  // namespace mcdem::elasticity
