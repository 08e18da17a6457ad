#include "elasticity/elastic_sphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <thread>

#include "elasticity/elastic_sphere_series.h"
#include "reference/point_force_reference.h"
#include "sim/reference/grain_reference.h"

namespace mcdem {
namespace {

using reference::point_force_on_sphere;
using reference::power_sum;
using reference::SphereSeries;
using std::numbers::pi;

double fitted_self(const SurfaceLaw& sphere, double a) {
    const auto& S = sphere.self;
    return S[0] + S[1] * std::log(a) + S[2] * a + S[3] * a * a + S[4] * a * a * a;
}

TEST(ElasticSphere, ModesSolveTheirTractions) {
    for (double nu : {0.0, 0.3, 0.49, 0.5}) {
        const SphereSeries series(nu);
        for (int n : {0, 1, 2, 3, 4, 7, 20, 100, 1000}) {
            const SurfaceMode mode = surface_mode(nu, n);
            const Eigen::Matrix2d solved = series.mode(n);
            EXPECT_NEAR(mode.radial, solved(0, 0), 1e-12) << "nu " << nu << " n " << n;
            EXPECT_NEAR(mode.coupling, solved(0, 1), 1e-11 * n) << "nu " << nu << " n " << n;
            EXPECT_NEAR(mode.coupling, n * (n + 1) * solved(1, 0), 1e-11 * n)
                << "Betti, nu " << nu << " n " << n;
            EXPECT_NEAR(mode.meridional, solved(1, 1), 1e-11) << "nu " << nu << " n " << n;
        }
    }
}

TEST(ElasticSphere, UniformPressureGivesTheBulkModulus) {
    EXPECT_DOUBLE_EQ(surface_mode(0.3, 0).radial, 1 - 2 * 0.3);  // p R (1 - 2 nu)/E
}

TEST(ElasticSphere, FilteredSeriesAgreesWithTheClosedForm) {
    for (double nu : {0.0, 0.3, 0.45, 0.5})
        for (double s : {0.1, 0.15, 0.3, 0.5, 0.7, 0.9, 1.0})
            EXPECT_NEAR(sphere_displacement(nu, s).point, point_force_on_sphere(nu, 2 * std::asin(s)), 1e-8)
                << "nu " << nu << " s " << s;
}

TEST(ElasticSphere, SizeTermIsExactAtSeveralAngles) {
    const double degrees[] = {60, 90, 120, 180};
    for (const auto& [nu, expected] :
         std::map<double, std::array<double, 4>>{{0.5, {-.15761, -.02822, .06834, .15819}},
                                                 {0.3, {-.18284, -.04189, .05726, .14749}},
                                                 {0.0, {-.21091, -.06521, .03547, .12590}}})
        for (int k = 0; k < 4; ++k)
            EXPECT_NEAR(sphere_displacement(nu, std::sin(degrees[k] / 360 * pi)).size, expected[k], 6e-6);
}

// The remainder is of fourth order in the contact radii: halving them reduces it to a sixteenth.
TEST(ElasticSphere, SizeTermIsTheSecondOrderForDistributedLoads) {
    for (double nu : {0.0, 0.3, 0.5}) {
        const SphereSeries series(nu);
        for (double s : {0.5, 0.8, 1.0}) {
            const auto left_out = [&](double a_k, double a_c) {
                const auto [point, size] = sphere_displacement(nu, s);
                return series.spread_load(a_k, a_c, s) -
                       (point + (2.0 / 5 * a_k * a_k + 2.0 / 3 * a_c * a_c) * size);
            };
            const double whole = left_out(0.24, 0.16), half = left_out(0.12, 0.08);
            EXPECT_LT(std::abs(whole), 2.5e-3) << "nu " << nu << " s " << s;
            EXPECT_NEAR(half, whole / 16, 0.02 * std::abs(whole)) << "nu " << nu << " s " << s;
        }
    }
}

TEST(ElasticSphere, SelfTermIsExactAtSeveralContactRadii) {
    for (const auto& [nu, expected] :
         std::map<double, std::array<double, 5>>{{0.5, {.30936, .29953, .28735, .27263, .25519}},
                                                 {0.3, {.41593, .41886, .40947, .39335, .37222}},
                                                 {0.0, {.27531, .36387, .40078, .41359, .41133}}})
        for (int i = 0; i < 5; ++i)  // at a/R = 0.1, 0.2, .. 0.5
            EXPECT_NEAR(fitted_self(elastic_sphere(nu), 0.1 * (i + 1)), expected[i], 6e-6)
                << "nu " << nu << " a/R " << 0.1 * (i + 1);
    EXPECT_NEAR(elastic_sphere(0.5).self[0], 0.3170, 1e-4);
}

TEST(ElasticSphere, SelfTermAgreesWithAnotherQuadrature) {
    for (double nu : {0.0, 0.3, 0.5}) {
        const SphereSeries series(nu);
        for (double a : {0.05, 0.2, 0.64})
            EXPECT_NEAR(sphere_self_displacement(nu, a), series.self(a), 1e-8) << "nu " << nu << " a " << a;
    }
}

TEST(ElasticSphere, PolynomialsHaveTheStatedErrors) {
    struct Row {
        double nu, point, size, self;  // largest errors for s from 0.15 to 1, a/R from 0.03 to 0.64
    };
    for (const Row& row :
         {Row{0.0, 1e-4, 8e-5, 5e-4}, Row{0.1, 7e-5, 7e-5, 4e-4}, Row{0.2, 5e-5, 5e-5, 3e-4},
          Row{0.3, 2e-5, 3e-5, 2e-4}, Row{0.4, 4e-6, 7e-6, 9e-5}, Row{0.45, 6e-7, 6e-7, 6e-5},
          Row{0.49, 2e-6, 4e-6, 3e-5}, Row{0.5, 2e-6, 5e-6, 3e-5}}) {
        const SurfaceLaw fitted = elastic_sphere(row.nu);
        for (int i = 0; i <= 400; ++i) {
            const double s = 0.15 + 0.85 * i / 400;
            const SphereDisplacement exact = sphere_displacement(row.nu, s);
            EXPECT_NEAR(power_sum(fitted.point, s) / s, exact.point, row.point)
                << "nu " << row.nu << " s " << s;
            EXPECT_NEAR(power_sum(fitted.size, s) / (s * s * s), exact.size, row.size)
                << "nu " << row.nu << " s " << s;
        }
        for (double a : {.03, .05, .1, .15, .25, .37, .5, .64})
            EXPECT_NEAR(fitted_self(fitted, a), sphere_self_displacement(row.nu, a), row.self)
                << "nu " << row.nu << " a " << a;
    }
}

TEST(ElasticSphere, AgreesWithAHalfSpaceCloseToTheLoad) {
    for (double nu : {0.0, 0.3, 0.5}) {
        const SurfaceLaw sphere = elastic_sphere(nu);
        const double half_space = -(1 - nu * nu) / pi;  // times F/(E d), d = 2 R s
        EXPECT_DOUBLE_EQ(sphere.point[0], half_space / 2);
        EXPECT_DOUBLE_EQ(sphere.size[0], half_space / 32);
        EXPECT_DOUBLE_EQ(sphere.self[1], (1 + nu) * (1 - 2 * nu) * (1 - 2 * nu) / (2 * pi));
    }
    EXPECT_EQ(elastic_sphere(0.5).self[1], 0) << "no logarithm, so that kernels may leave it out";
}

TEST(ElasticSphere, IsThreadSafe) {
    std::array<SurfaceLaw, 4> result;
    {
        std::array<std::jthread, 4> threads;
        for (int i = 0; i < 4; ++i) threads[i] = std::jthread([&, i] { result[i] = elastic_sphere(0.123); });
    }
    for (const auto& sphere : result) {
        EXPECT_EQ(sphere.point, result[0].point);
        EXPECT_EQ(sphere.self, result[0].self);
    }
}

}  // namespace
}  // namespace mcdem
