// The contact model "elastic sphere" for one Poisson ratio, as polynomials for the kernels. They are fitted
// only to the integrals of elastic_sphere_series.h, not to simulations or measurements.
#pragma once
#include "elasticity/surface_displacement.h"

namespace mcdem::inline elasticity {

/// The law of an elastic sphere. Maximum errors in F/(E R), largest at nu = 0 and decreasing towards nu =
/// 1/2: point 1e-4 and size 8e-5 for s from 0.15 to 1, self 5e-4 for a/R from 0.03 to 0.64. The fit takes
/// some milliseconds; results are cached for every Poisson ratio. Thread-safe.
SurfaceLaw elastic_sphere(double poisson_ratio);

}  // namespace mcdem::elasticity
