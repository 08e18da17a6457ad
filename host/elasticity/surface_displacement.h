// delta_kc of the contact models: displacement of a grain's surface by a force at one of its contacts.
#pragma once
#include <array>

#include "core/names.h"

namespace mcdem::inline elasticity {

/// Terms of the polynomials in s = sin(theta / 2) and in a/R (the same constants in kernels/replica.h).
inline constexpr int point_terms = 9;
inline constexpr int size_terms = 7;
inline constexpr int self_terms = 5;

/// The three families of contact models in the kernels (SURFACE_* of kernels/replica.h).
enum class SurfaceShape { rigid = 0, half_space = 1, sphere = 2 };

/// Effect of a grain's mean pressure P = sum F/(4 pi E R^2) at finite strain (kernels/confinement.h). Zero at
/// small strain.
struct Confinement {
    double hertz = 0;     ///< c_h, stiffens the Hertz part
    double coupling = 0;  ///< c, stiffens displacements of contacts by themselves beyond Hertz and by others
    double size = 0;      ///< c_z, stiffens the contribution of contact sizes and the terms q and t
    double volume = 0;    ///< q
    double shear = 0;     ///< t
    std::array<double, 3>
        bulk{};  ///< uniform compression in powers of P; `point` and `self` do not include it
};

/// A contact model for one Poisson ratio, as the kernels evaluate it. Sphere: with s = sin(theta / 2) and
/// contact radii a, the force F_k moves the surface at c outward by F_k/(E R) times
///   P(s)/s + m T(s)/s^3,  m = 2/5 (a_k/R)^2 + 2/3 (a_c/R)^2   (k other than c)
///   S0 + S1 ln(a_c/R) + S2 (a_c/R) + S3 (a_c/R)^2 + S4 (a_c/R)^3   (k = c)
struct SurfaceLaw {
    SurfaceShape shape = SurfaceShape::rigid;
    double gamma = 0;                         ///< half space: prefactor of Eq. 1
    std::array<double, point_terms> point{};  ///< P, lowest order first
    std::array<double, size_terms> size{};    ///< T; zero if contacts are points
    std::array<double, self_terms> self{};    ///< S0..S4; zero without self term
    Confinement confinement;
};

/// `gamma` is used by mc_dem only; `finite_strain` (weight of the extension to hyperelastic_sphere) by
/// elastic_sphere only.
SurfaceLaw surface_law(ContactModel model, double poisson_ratio, double gamma, double finite_strain = 0);

}  // namespace mcdem::elasticity
