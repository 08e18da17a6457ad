#include "elasticity/surface_displacement.h"

#include <cmath>
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
        case ContactModel::elastic_sphere: {
            const ElasticSphere sphere = elastic_sphere(poisson_ratio);
            law.shape = SurfaceShape::sphere;
            law.point = sphere.point;
            law.size = sphere.size;
            law.self = sphere.self;
            if (finite_strain > 0) add_finite_strain(law, poisson_ratio, finite_strain);
            break;
        }
        case ContactModel::hyperelastic_sphere:
            law = surface_law(ContactModel::elastic_sphere, poisson_ratio, gamma);
            add_finite_strain(law, poisson_ratio);
            break;
    }
    return law;
}

double point_force_on_sphere(double poisson_ratio, double theta) {
    const double nu = poisson_ratio, s = std::sin(theta / 2), x = std::cos(theta);
    const auto coefficient = [nu](double n) {
        return (2 * n + 1) * (2 * (1 - nu) * n * n + nu * n - (1 - 2 * nu)) /
               ((n - 1) * (n * n + n + 1 + nu * (2 * n + 1)));
    };
    // For large n the coefficients are slow + slower/n: sum P_n = 1/(2 s), sum P_n/n = -ln(s (1 + s)).
    const double slow = 4 * (1 - nu), slower = 2 - 8 * nu * (1 - nu);
    double sum = slow * (1 / (2 * s) - 1 - x) - slower * (std::log(s * (1 + s)) + x);  // n >= 2
    double before = 1, legendre = x;
    for (int n = 2; n <= 4000; ++n) {
        const double next = ((2 * n - 1) * x * legendre - (n - 1) * before) / n;
        before = legendre;
        legendre = next;
        sum += (coefficient(n) - slow - slower / n) * legendre;
    }
    sum += coefficient(0);
    return -(1 + nu) / (4 * pi) * sum - 3 * (1 - 2 * nu) / (8 * pi) * x;
}

}  // namespace mcdem::elasticity
