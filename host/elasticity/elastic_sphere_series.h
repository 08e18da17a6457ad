// How a free elastic sphere answers to loads on its surface, by exact Legendre series; what the contact
// model "elastic sphere" is fitted to. Radius and Young's modulus are 1; displacements are in F/(E R).
//
// The reference problem at every contact is Hertz: a half space, a parabolic gap. A small displacement w
// added over the contact disc shifts the overlap by its average under the weight 1/sqrt(a^2 - r^2) of a
// flat punch (reciprocity), and that average of everything Hertz leaves out is what is computed here:
// the displacement by the other contacts, each spread as a Hertz pressure, and for a contact's own
// pressure the answer of the sphere less that of the half space. Loads and displacements are along the
// normal of the touching plate, not along the local radius: over a cap the difference counts.
#pragma once

namespace mcdem::inline elasticity {

/// Answer of the sphere's surface to Legendre order n. Tractions t_r P_n (radial) and t_t dP_n/dtheta
/// (meridional) give displacements U P_n and V dP_n/dtheta:
///   U = radial t_r + coupling t_t,   V = coupling/(n(n+1)) t_r + meridional t_t   (Betti's reciprocity)
/// n = 1 is balanced by a uniform body force with the centre held, less the rigid translation that
/// would break reciprocity.
struct SurfaceMode {
    double radial = 0;
    double coupling = 0;
    double meridional = 0;
};
SurfaceMode surface_mode(double poisson_ratio, int n);

/// Displacement at s = sin(theta/2) from a loaded contact k, to second order in the contact radii:
/// point + (2/5 (a_k/R)^2 + 2/3 (a_c/R)^2) size. Holds for s >= 0.05: point to 1e-9, size to 4e-6 of
/// its value.
struct SphereDisplacement {
    double point = 0;
    double size = 0;
};
SphereDisplacement sphere_displacement(double poisson_ratio, double s);

/// What a contact of radius a, relative_radius = a/R in (0, 0.8], moves its own point beyond Hertz: sphere
/// less half space, and the true gap 1 - cos(theta) less Hertz's parabola.
double sphere_self_displacement(double poisson_ratio, double relative_radius);

}  // namespace mcdem::elasticity
