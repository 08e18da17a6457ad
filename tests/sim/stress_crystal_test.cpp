// A face-centred cubic crystal on various stress paths. Every contact is a bond of the deformed lattice, so
// the stress is known at any strain.
#include <cmath>

#include "core/container.h"
#include "sim/traced_programme.h"

namespace mcdem::reference::stress_crystal {
namespace {

using mcdem::Mat3;
using mcdem::Strain;

constexpr double diameter = 0.02, edge = 0.0279, youngs_modulus = 23.3e3, poisson = 0.45;

double hertz(double overlap) {
    const double modulus = youngs_modulus / (1 - poisson * poisson) / 2;
    return overlap > 0 ? 4.0 / 3 * modulus * std::sqrt(diameter / 4) * std::pow(overlap, 1.5) : 0;
}

Mat3 crystal_stress(const Strain& strain) {
    const Mat3 f = mcdem::deformation(strain);
    Mat3 sum = Mat3::Zero();
    const auto sites = thirteen(edge / std::sqrt(2.0));
    for (std::size_t n = 1; n < sites.size(); ++n) {
        const Vec3 branch = f * sites[n];
        sum += 0.5 * hertz(diameter - branch.norm()) / branch.norm() * branch * branch.transpose();
    }
    return sum * 4 / (std::pow(edge, 3) * f.determinant());
}

mcdem::Stage stresses(double x, double y, double z) {
    mcdem::Stage stage;
    stage.stress_x = x, stage.stress_y = y, stage.stress_z = z;
    stage.rate = 1;
    return stage;
}

Traced taken_along(const std::vector<mcdem::Stage>& programme, bool stop_at_scans = true) {
    constexpr int side = 2;
    Replica replica = test_replica(ContactModel::independent);
    replica.grains = {youngs_modulus, poisson, 1000, 0, 0, 0.7, 0};
    replica.protocol.stop_at_scans = stop_at_scans;
    replica.protocol.relax_time = 0.01;
    replica.box = {side * edge, side * edge, mcdem::ContainerShape::cell, side * edge};
    replica.plate.start = side * edge;
    replica.programme = programme;
    Packing packing;
    for (int i = 0; i < 4 * side * side * side; ++i) {
        const int cell = i / 4, site = i % 4;
        const Vec3 corner(cell % side, cell / side % side, cell / (side * side));
        const Vec3 face = site == 0 ? Vec3::Zero() : Vec3(0.5 * Vec3::Ones() - 0.5 * Vec3::Unit(site - 1));
        packing.position.push_back(edge * (corner + face) + Vec3(0.001, -0.003, 0.005));
        packing.diameter.push_back(diameter);
    }
    mcdem::Scene scene;
    scene.precision = finest();
    scene.replicas.push_back(replica);
    const Traced traced = trace(scene, 0, packing);
    EXPECT_EQ(traced.hindrance, "");
    EXPECT_EQ(traced.status, 0);
    return traced;
}

void expect_stress(const Traced::Scanned& scan, const mcdem::SetStress& set) {
    const double allowed = has_double() ? 1e-5 : 3e-3, pressure = scan.stress.trace() / 3;
    EXPECT_LT((scan.stress - crystal_stress(scan.strain)).cwiseAbs().maxCoeff() / pressure, allowed);
    EXPECT_LT((scan.stress - scan.stress.transpose()).cwiseAbs().maxCoeff() / pressure, allowed);
    EXPECT_TRUE(scan.tag.settled);
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isnan(set[axis])) {
            EXPECT_NEAR(scan.stress(axis, axis) / set[axis], 1, 1e-3) << axis;
        }
    const double shears[]{scan.stress(0, 1), scan.stress(0, 2), scan.stress(1, 2)};
    for (int k = 0; k < 3; ++k)
        if (!std::isnan(set[3 + k])) {
            EXPECT_NEAR(shears[k], set[3 + k], 1e-3 * std::max(std::abs(set[3 + k]), pressure / 10)) << k;
        }
}

mcdem::SetStress only(double x, double y, double z) {
    return {x, y, z, mcdem::not_given, mcdem::not_given, mcdem::not_given};
}

TEST(StressOfACrystal, UnderPressureAgreesWithHertz) {
    const Traced traced =
        taken_along({stresses(50, 50, 50), stresses(400, 400, 400), stresses(100, 100, 100)});
    ASSERT_EQ(traced.scans.size(), 3u);
    const double set[] = {50, 400, 100};
    for (int leg = 0; leg < 3; ++leg) {
        expect_stress(traced.scans[leg], only(set[leg], set[leg], set[leg]));
        double low = -0.1, high = 0.3;  // bracket of the strain at the prescribed pressure
        for (int n = 0; n < 60; ++n) {
            const double middle = (low + high) / 2;
            (crystal_stress({middle, middle, middle, 0, 0, 0})(0, 0) < set[leg] ? low : high) = middle;
        }
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(traced.scans[leg].strain[axis], low, 2e-5) << leg;
    }
}

TEST(StressOfACrystal, IsCorrectOnEveryPath) {
    std::vector<mcdem::Stage> programme{stresses(200, 200, 200), stresses(200, 200, mcdem::not_given),
                                        stresses(150, 250, 200), stresses(200, 200, 200),
                                        stresses(mcdem::not_given, mcdem::not_given, 300)};
    programme[1].strain_z = 0.03;  // triaxial
    programme[3].shear_xz = 0.02;  // simple shear at constant pressure
    programme[3].shear_yz = -0.01;
    programme[4].scans = 2;  // oedometer
    const Traced traced = taken_along(programme);
    ASSERT_EQ(traced.scans.size(), 6u);
    expect_stress(traced.scans[0], only(200, 200, 200));
    expect_stress(traced.scans[1], only(200, 200, mcdem::not_given));
    EXPECT_EQ(traced.scans[1].strain[2], 0.03);
    expect_stress(traced.scans[2], only(150, 250, 200));
    expect_stress(traced.scans[3], only(200, 200, 200));
    EXPECT_EQ(traced.scans[3].strain[4], 0.02);
    EXPECT_LT(traced.scans[3].stress(0, 2), -1) << "it resists the shear";
    expect_stress(traced.scans[4], only(mcdem::not_given, mcdem::not_given, 250));
    expect_stress(traced.scans[5], only(mcdem::not_given, mcdem::not_given, 300));
    for (const int k : {0, 1, 3, 4, 5}) EXPECT_EQ(traced.scans[5].strain[k], traced.scans[3].strain[k]) << k;
}

// All six stresses at once: the shears of a stretched lattice follow from the closed form.
TEST(StressOfACrystal, IsCorrectUnderShearStresses) {
    std::vector<mcdem::Stage> programme{stresses(200, 200, 200), stresses(200, 200, 200),
                                        stresses(200, 200, 200), stresses(200, 200, mcdem::not_given)};
    programme[1].stress_xz = -20;
    programme[1].scans = 2;
    programme[2].stress_xy = 15, programme[2].stress_xz = 10, programme[2].stress_yz = -5;
    programme[3].stress_xy = programme[3].stress_xz = programme[3].stress_yz = 0;
    programme[3].strain_z = 0.06;
    const Traced traced = taken_along(programme);
    ASSERT_EQ(traced.scans.size(), 5u);
    const double free = mcdem::not_given;
    expect_stress(traced.scans[1], {200, 200, 200, free, -10, free});
    expect_stress(traced.scans[2], {200, 200, 200, free, -20, free});
    EXPECT_GT(traced.scans[2].strain[4], 1e-3);
    EXPECT_EQ(traced.scans[2].strain[3], 0);
    expect_stress(traced.scans[3], {200, 200, 200, 15, 10, -5});
    expect_stress(traced.scans[4], {200, 200, free, 0, 0, 0});
    for (int k = 3; k < 6; ++k) EXPECT_NEAR(traced.scans[4].strain[k], 0, 1e-3) << k;
}

TEST(StressOfACrystal, IsRecordedDuringMoves) {
    std::vector<mcdem::Stage> programme{stresses(50, 50, 50), stresses(200, 200, 200),
                                        stresses(200, 200, 200)};
    programme[1].scans = 3;
    programme[2].shear_xy = 0.03;
    programme[2].scans = 3;
    const Traced traced = taken_along(programme, false);
    ASSERT_EQ(traced.scans.size(), 7u);
    for (int k = 1; k < 4; ++k) {
        const double mean = traced.scans[k].stress.trace() / 3;
        EXPECT_GE(mean, 50 * (1 + k) * (1 - 1e-3));
        EXPECT_LT(mean, 50 * (1 + k) * 1.08);
    }
    for (int k = 4; k < 7; ++k) {
        EXPECT_NEAR(traced.scans[k].strain[3], 0.01 * (k - 3), 1e-12);
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(traced.scans[k].stress(axis, axis) / 200, 1, 0.02);
        Vec3 momentum = Vec3::Zero();
        for (const Vec3& v : traced.scans[k].state.velocity) momentum += v;
        EXPECT_LT(momentum.norm() / traced.scans[k].state.velocity.size(), has_double() ? 1e-12 : 1e-6);
    }
}

}  // namespace
}  // namespace mcdem::reference::stress_crystal
