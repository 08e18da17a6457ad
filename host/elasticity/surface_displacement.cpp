#include "elasticity/surface_displacement.h"

#include <numbers>

#include "elasticity/elastic_sphere.h"
#include "elasticity/hyperelastic_sphere.h"

namespace mcdem::inline elasticity {
namespace {

using std::numbers::pi;

/// Gonzalez & Cuitino 2012: the half space with both points on the sphere; exactly a polynomial.
std::array<double, point_terms> sphere_to_sphere(double nu) {
    const double scale = (1 + nu) / (4 * pi);
    return {-2 * (1 - nu) * scale, -2 * (1 - 2 * nu) * scale, (7 - 8 * nu) * scale};
}

}  // namespace

SurfaceLaw surface_law(ContactModel model, double poisson_ratio, double gamma, double finite_strain) {
    SurfaceLaw law;
    switch (model) {
        case ContactModel::independent:
            break;
        case ContactModel::point_force_on_sphere:
            law.shape = SurfaceShape::sphere;
            law.point = elastic_sphere(poisson_ratio).point;
            break;
        case ContactModel::sphere_to_sphere:
            law.shape = SurfaceShape::sphere;
            law.point = sphere_to_sphere(poisson_ratio);
            break;
        case ContactModel::elastic_half_space:
            law.shape = SurfaceShape::half_space;
            law.gamma = 1;
            break;
        case ContactModel::mc_dem:
            law.shape = SurfaceShape::half_space;
            law.gamma = gamma;
            break;
        case ContactModel::elastic_sphere:
            law = elastic_sphere(poisson_ratio);
            if (finite_strain > 0) add_finite_strain(law, poisson_ratio, finite_strain);
            break;
        case ContactModel::hyperelastic_sphere:
            law = elastic_sphere(poisson_ratio);
            add_finite_strain(law, poisson_ratio);
            break;
    }
    return law;
}

}  // namespace mcdem::elasticity
