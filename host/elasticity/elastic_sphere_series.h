// Response of a free elastic sphere to loads on its surface, by exact Legendre series. The contact model
// "elastic sphere" is fitted to it. Radius and Young's modulus are 1; displacements are in F/(E R).
//
// The reference problem at every contact is Hertz: a half space with a parabolic gap. A small additional
// displacement w over the contact disc changes the overlap by its average with the weight 1/sqrt(a^2 - r^2)
// of a flat punch (reciprocity). This file computes that average for everything that Hertz neglects: the
// displacement by the other contacts, each distributed as a Hertz pressure, and for a contact's own pressure
// the response of the sphere minus that of the half space. Loads and displacements are along the normal of
// the plate, not along the local radius; over a cap the difference matters.
#pragma once

namespace mcdem::inline elasticity {

/// Response of the sphere's surface at Legendre order n. Tractions t_r P_n (radial) and t_t dP_n/dtheta
/// (meridional) give displacements U P_n and V dP_n/dtheta:
///   U = radial t_r + coupling t_t,   V = coupling/(n(n+1)) t_r + meridional t_t   (Betti's reciprocity)
/// n = 1 is balanced by a uniform body force with the centre fixed, minus the rigid translation that would
/// violate reciprocity.
struct SurfaceMode {
    double radial = 0;
    double coupling = 0;
    double meridional = 0;
};
SurfaceMode surface_mode(double poisson_ratio, int n);

/// Displacement at s = sin(theta/2) from a loaded contact k, to second order in the contact radii: point +
/// (2/5 (a_k/R)^2 + 2/3 (a_c/R)^2) size. Valid for s >= 0.05: point within 1e-9, size within 4e-6 of its
/// value.
struct SphereDisplacement {
    double point = 0;
    double size = 0;
};
SphereDisplacement sphere_displacement(double poisson_ratio, double s);

/// Displacement of a contact of radius a by its own force beyond Hertz, for relative_radius = a/R in (0,
/// 0.8]: sphere minus half space, and the true gap 1 - cos(theta) minus Hertz's parabola.
double sphere_self_displacement(double poisson_ratio, double relative_radius);

}  // namespace mcdem::elasticity
