#include "elasticity/surface_displacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "reference/point_force_reference.h"
#include "sim/reference/grain_reference.h"

namespace mcdem {
namespace {

using reference::Grain;
using reference::point_force_on_sphere;
using reference::Slot;
using std::numbers::pi;

constexpr double degree = pi / 180;
constexpr double rounding = 1e-13;

Vec3 at(double theta) { return {std::sin(theta), 0, std::cos(theta)}; }

/// R = E = 1, a unit force at the pole, and one probed point on the undeformed sphere at the angle `theta`.
Grain probed_at(double theta, double poisson_ratio) {
    return {1, 1, poisson_ratio, {{at(0), 1, 1, 0}, {at(theta), 1, 0, 0}}};
}

double displacement(ContactModel model, double poisson_ratio, double theta, double gamma = 1) {
    return surface_displacement(surface_law(model, poisson_ratio, gamma), probed_at(theta, poisson_ratio))[1];
}

TEST(SurfaceDisplacement, IsExactAtKnownAngles) {
    const auto sphere_to_sphere = [](double nu, double theta) {
        return displacement(ContactModel::sphere_to_sphere, nu, theta);
    };
    const auto half_space = [](double nu, double theta) {
        return displacement(ContactModel::elastic_half_space, nu, theta);
    };
    const struct {
        double (*of)(double, double), nu, degrees, expected;
    } all[] = {{point_force_on_sphere, 0.5, 60, 0.1420},
               {point_force_on_sphere, 0.5, 90, 0.1036},
               {point_force_on_sphere, 0.5, 120, -0.0171},
               {point_force_on_sphere, 0.5, 180, -0.1765},
               {point_force_on_sphere, 0.49, 90, 0.1025},
               {point_force_on_sphere, 0.45, 90, 0.0980},
               {point_force_on_sphere, 0.30, 90, 0.0808},
               {sphere_to_sphere, 0.5, 60, -0.0597},
               {sphere_to_sphere, 0.5, 90, 0.0844},
               {sphere_to_sphere, 0.5, 120, 0.1723},
               {sphere_to_sphere, 0.5, 180, 0.2387},
               {half_space, 0.49, 90, 0.0825},
               {half_space, 0.45, 90, 0.0748},
               {half_space, 0.30, 90, 0.0489}};
    for (const auto& known : all)
        EXPECT_NEAR(known.of(known.nu, known.degrees * degree), known.expected, 5e-5)
            << known.nu << ' ' << known.degrees;
}

// Averages of u P_n over the sphere. The average of u itself is the change of volume, which for forces f at
// x is (1 - 2 nu)/E sum(f . x) in any elastic body; here -(1 - 2 nu) over 4 pi.
TEST(SurfaceDisplacement, PointForceHasTheMomentsOfItsSeries) {
    for (double nu : {0.0, 0.2, 0.3, 0.45, 0.5}) {
        double mean = 0, first = 0, second = 0;
        constexpr int intervals = 2000;  // midpoint rule in s; dOmega/(4 pi) = 2 s ds, and s u is finite
        for (int i = 0; i < intervals; ++i) {
            const double s = (i + 0.5) / intervals, x = 1 - 2 * s * s;
            const double u = point_force_on_sphere(nu, 2 * std::asin(s)) * 2 * s / intervals;
            mean += u;
            first += u * x;
            second += u * (3 * x * x - 1) / 2;
        }
        EXPECT_NEAR(mean, -(1 - 2 * nu) / (4 * pi), 2e-6) << nu;
        EXPECT_NEAR(first, -(1 - 2 * nu) / (8 * pi), 2e-6) << nu;
        EXPECT_NEAR(second, -(1 + nu) / (4 * pi) * (7 - 4 * nu) / (7 + 5 * nu), 2e-6) << nu;
    }
}

TEST(SurfaceDisplacement, PointForceModelAgreesWithTheSeries) {
    for (double nu : {0.0, 0.1, 0.25, 0.3, 0.4, 0.45, 0.49, 0.5})
        for (double theta = 18 * degree; theta <= pi; theta += degree)
            EXPECT_NEAR(displacement(ContactModel::point_force_on_sphere, nu, theta),
                        point_force_on_sphere(nu, theta), 1.1e-4)
                << "nu " << nu << " theta " << theta / degree;
}

TEST(SurfaceDisplacement, SphereToSphereOfIncompressibleGrainsIsExact) {
    for (double s : {0.2, 0.5, 0.9})
        EXPECT_NEAR(displacement(ContactModel::sphere_to_sphere, 0.5, 2 * std::asin(s)),
                    3 / (8 * pi) * (3 * s * s - 1) / s, rounding);
}

// The paper states this for nu = 1/2; it is true for all nu.
TEST(SurfaceDisplacement, HalfSpaceWithPointsOnTheSphereEqualsSphereToSphere) {
    for (double nu : {0.5, 0.49, 0.3, 0.0})
        for (double theta = 18 * degree; theta <= pi; theta += degree)
            EXPECT_NEAR(displacement(ContactModel::elastic_half_space, nu, theta),
                        displacement(ContactModel::sphere_to_sphere, nu, theta), rounding)
                << "nu " << nu << " theta " << theta / degree;
}

TEST(SurfaceDisplacement, McDemIsTheHalfSpaceTimesGamma) {
    for (double gamma : {0.0, 1.0, 1.125})
        EXPECT_NEAR(displacement(ContactModel::mc_dem, 0.4, 1.0, gamma),
                    gamma * displacement(ContactModel::elastic_half_space, 0.4, 1.0), rounding);
    EXPECT_EQ(surface_law(ContactModel::elastic_half_space, 0.4, 7.0).gamma, 1.0)
        << "gamma is mc_dem's alone";
}

TEST(SurfaceDisplacement, IndependentContactsHaveNone) {
    const SurfaceLaw law = surface_law(ContactModel::independent, 0.5, 1.125);
    EXPECT_EQ(law.shape, SurfaceShape::rigid);
    EXPECT_EQ(surface_displacement(law, probed_at(1.0, 0.5)), (std::vector<double>{0, 0}));
}

TEST(SurfaceDisplacement, OnlyTheElasticSphereHasSelfDisplacements) {
    for (auto model : {ContactModel::point_force_on_sphere, ContactModel::sphere_to_sphere,
                       ContactModel::elastic_half_space, ContactModel::mc_dem})
        EXPECT_EQ(surface_displacement(surface_law(model, 0.4, 1), probed_at(1, 0.4))[0], 0) << name(model);
    Grain grain = probed_at(1, 0.5);
    grain.slots[0].contact_radius = 1e-3;
    const SurfaceLaw law = surface_law(ContactModel::elastic_sphere, 0.5, 1);
    EXPECT_NEAR(surface_displacement(law, grain)[0], 0.3170, 1e-4);
}

/// Unequal forces, radii, arms and directions, so that nothing cancels.
Grain crowded_grain(double poisson_ratio, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    Grain grain{0.01, 2e4, poisson_ratio, {}};
    while (grain.slots.size() < 7) {
        const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
        bool near = false;
        for (const Slot& slot : grain.slots) near |= (slot.direction - direction).norm() < 0.6;
        if (near) continue;
        const bool contact = grain.slots.size() < 5;
        const double overlap = 0.001 * uniform(random);
        grain.slots.push_back({direction, 0.01 - overlap, contact ? 0.3 * uniform(random) : 0,
                               contact ? std::sqrt(0.01 * overlap) : 0});
    }
    return grain;
}

TEST(SurfaceDisplacement, LawsAgreeWithTheirModels) {
    for (double nu : {0.1, 0.3, 0.5})
        for (std::size_t m = 0; m < name_list<ContactModel>.size(); ++m) {
            const auto model = static_cast<ContactModel>(m);
            if (model == ContactModel::hyperelastic_sphere) continue;  // no series exists for it
            const Grain grain = crowded_grain(nu, 5);
            const auto by_law = surface_displacement(surface_law(model, nu, 1.125), grain);
            const auto by_series = surface_displacement_by_series(model, 1.125, grain);
            for (std::size_t c = 0; c < by_law.size(); ++c)  // up to 1 N/(E R) = 5 mm, and five contacts
                EXPECT_NEAR(by_law[c], by_series[c], 5e-4 * 5 * 0.3 * 0.005) << name(model) << " slot " << c;
        }
}

TEST(SurfaceDisplacement, RotatesWithTheGrain) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -3).normalized()).toRotationMatrix();
    for (auto model : {ContactModel::elastic_half_space, ContactModel::elastic_sphere}) {
        const SurfaceLaw law = surface_law(model, 0.35, 1);
        Grain grain = crowded_grain(0.35, 9);
        const auto before = surface_displacement(law, grain);
        for (Slot& slot : grain.slots) slot.direction = turn * slot.direction;
        const auto after = surface_displacement(law, grain);
        for (std::size_t c = 0; c < before.size(); ++c) EXPECT_NEAR(before[c], after[c], 1e-14);
    }
}

}  // namespace
}  // namespace mcdem
