// Extension of the elastic sphere to finite strain, for a neo-Hookean grain. The coefficients are fitted to
// finite elements of one sphere between plates (tests/truth/fit_hyperelastic_sphere.py), not to packings.
#pragma once
#include "elasticity/surface_displacement.h"

namespace mcdem::inline elasticity {

/// Range of Poisson ratios with finite elements; outside it the coefficients of the nearer end are used.
inline constexpr double min_finite_strain_poisson_ratio = 0.3, max_finite_strain_poisson_ratio = 0.49;

/// Adds the correction of a contact's own displacement and the confinement, times `share`, to the law of an
/// elastic sphere.
void add_finite_strain(SurfaceLaw& law, double poisson_ratio, double share = 1);

}  // namespace mcdem::elasticity
