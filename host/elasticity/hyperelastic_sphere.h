// What finite strain adds to the elastic sphere, for a neo-Hookean grain. Its coefficients are fitted to
// finite elements of one sphere between plates (tests/truth/fit_hyperelastic_sphere.py); no packing enters.
#pragma once
#include "elasticity/surface_displacement.h"

namespace mcdem::inline elasticity {

/// Poisson ratios for which there are finite elements; outside, the nearer end's coefficients hold.
inline constexpr double min_finite_strain_poisson_ratio = 0.3, max_finite_strain_poisson_ratio = 0.49;

/// Adds the correction of a contact's own displacement and the confinement to the law of an elastic sphere,
/// or a `share` of them.
void add_finite_strain(SurfaceLaw& law, double poisson_ratio, double share = 1);

}  // namespace mcdem::elasticity
