// Surface displacements stored by the kernels: against the reference at every slot, touching or near, and at
// angles with known values.
#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/names.h"
#include "kernels/saved_rows.h"

namespace reference {
namespace {

using std::numbers::pi;

/// Difference at all slots after six steps, which fill the history, over the largest displacement.
double worst_displacement(const KernelBuild& kernels, const Start& start) {
    Batch batch(kernels, start);
    StepReference reference = reference_of(batch.engine(), 0, start);
    batch.advance(6);
    for (int step = 0; step < 6; ++step) reference.step();
    const SavedRows rows(batch, kernels, {start});
    double worst = 0, largest = 0;
    for (std::size_t grain = 0; grain < start.packing.size(); ++grain) {
        const auto found = rows.by_partner("displacement", 0, grain);
        EXPECT_EQ(found.size(), reference.memory[grain].size());
        for (const auto& [partner, memory] : reference.memory[grain]) {
            worst = std::max(worst, std::abs(found.at(partner) - memory.predicted));
            largest = std::max(largest, std::abs(memory.predicted));
        }
    }
    EXPECT_GT(largest, 1e-5);
    return worst / largest;
}

/// Float: forces have an error of about 3e-5 (advance_test.cpp), and the extrapolation adds errors with the
/// weights 10/6, 5/6 and 1/6. At nu = 0 the sphere's polynomials have coefficients up to 40 that cancel to
/// about 0.1: another 3e-4. The elastic sphere's overlaps from Newton's method have an error of 1e-6.
double tolerance(Precision precision, ContactModel model, double poisson_ratio) {
    if (precision == Precision::single_precision) return poisson_ratio == 0 ? 5e-4 : 1e-4;
    const bool by_newton =
        model == ContactModel::elastic_sphere || model == ContactModel::hyperelastic_sphere;
    return by_newton ? 3e-5 : 1e-12;
}

TEST(SurfaceDisplacement, FollowsTheReferenceAtEverySlot) {
    for (ContactModel model : all_models) {
        if (model == ContactModel::independent) continue;
        for (double nu : {0.0, 0.3, 0.5}) {
            Replica replica = test_replica(model);
            replica.grains.poisson_ratio = nu;
            replica.numerics.probe_gap = 0.2;
            const Start start = jittered_lattice(replica, 65, 3);
            for (Precision precision : {Precision::single_precision, finest()})
                EXPECT_LT(worst_displacement(build(precision), start), tolerance(precision, model, nu))
                    << name(model) << " nu " << nu << ' ' << name(precision);
        }
    }
}

/// Fills slots without contact with NaN.
void spoil_empty_slots(std::map<std::string, std::vector<std::byte>>& saved) {
    const auto partner = saved_values<int>(saved, "partner");
    for (const char* const name : {"displacement", "displacement_history"}) {
        auto values = saved_values<float>(saved, name);
        const std::size_t copies = values.size() / partner.size();
        for (std::size_t slot = 0; slot < partner.size(); ++slot)
            for (std::size_t copy = 0; copy < copies && partner[slot] == NO_PARTNER; ++copy)
                values[copy * (values.size() / copies) + slot] = std::numeric_limits<float>::quiet_NaN();
        std::memcpy(saved.at(name).data(), values.data(), saved.at(name).size());
    }
}

// A vector of grains includes the empty slots of grains with fewer neighbours.
TEST(SurfaceDisplacement, EmptySlotsHaveNoEffect) {
    for (ContactModel model : {ContactModel::mc_dem, ContactModel::elastic_sphere}) {
        const Start start = jittered_lattice(test_replica(model), 65, 3);
        const KernelBuild kernels = build(Precision::single_precision);
        Batch clean(kernels, start), spoiled(kernels, start);
        clean.advance(6);
        auto saved = clean.engine().save();
        spoil_empty_slots(saved);
        spoiled.engine().restore(saved);
        clean.advance(9);
        spoiled.advance(9);
        EXPECT_EQ(saved_values<float>(clean.engine().save(), "motion"),
                  saved_values<float>(spoiled.engine().save(), "motion"))
            << name(model);
    }
}

/// One grain pressed on the floor, and small grains near it at 60, 90, 120 and 180 degrees from the loaded
/// point.
Start pressed_grain(ContactModel model, double overlap) {
    constexpr double radius = 0.01, small = 0.003, gap = 0.0005;
    Replica replica = test_replica(model);
    replica.grains.poisson_ratio = 0.5;
    replica.grains.excess_density = 0;
    replica.walls.youngs_modulus = 1e12;
    replica.numerics.time_step = 1e-3;
    replica.box = {0.1, 0.1};
    replica.plate.start = 0.1;
    const Vec3 centre(0.05, 0.05, radius - overlap);
    Packing packing{{centre}, {2 * radius}};
    for (int k = 0; k < 4; ++k) {
        const double angle = std::array{60, 90, 120, 180}[k] * pi / 180, turn = k * pi / 2;
        const Vec3 direction(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                             -std::cos(angle));
        packing.position.push_back(centre + (radius + small + gap) * direction);
        packing.diameter.push_back(2 * small);
    }
    return {replica, packing};
}

/// In F/(E R), at 60, 90, 120 and 180 degrees.
std::array<double, 4> displacements(ContactModel model) {
    constexpr double radius = 0.01, overlap = 1e-6;
    const KernelBuild kernels = build(finest());
    const Start start = pressed_grain(model, overlap);
    Batch batch(kernels, start);
    // long enough to fill the history of displacements, too short for the grain to move
    const double force = batch.advance(8).front().wall_force[int(mcdem::Wall::floor)].z();
    const double modulus = start.replica.grains.youngs_modulus;
    const double hertz = 4.0 / 3 * modulus / 0.75 * std::sqrt(radius) * std::pow(overlap, 1.5);
    EXPECT_NEAR(-force / hertz, 1, 0.01);
    const auto displacement = SavedRows(batch, kernels, {start}).by_partner("displacement", 0, 0);
    std::array<double, 4> found;
    for (int k = 0; k < 4; ++k) found[k] = displacement.at(k + 1) / (hertz / (modulus * radius));
    return found;
}

// The exact solution for nu = 1/2; the kernels' polynomial is within 1e-4 of the series.
TEST(SurfaceDisplacement, PointForceOnSphereIsExactAtKnownAngles) {
    const std::array expected{0.1420, 0.1036, -0.0171, -0.1765};
    const auto found = displacements(ContactModel::point_force_on_sphere);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], 2e-4) << k;
}

TEST(SurfaceDisplacement, SphereToSphereIsExactAtKnownAngles) {
    const auto found = displacements(ContactModel::sphere_to_sphere);
    for (int k = 0; k < 4; ++k) {
        const double s = std::sin(std::array{60, 90, 120, 180}[k] * pi / 360);
        EXPECT_NEAR(found[k], 3 / (8 * pi) * (3 * s * s - 1) / s, 1e-4) << k;
    }
}

// With contact points very close to the sphere, the half space has the same formula. The slots of the small
// grains are probed at R; the contact is at R minus the overlap, 1e-4 R.
TEST(SurfaceDisplacement, HalfSpaceOnTheSphereEqualsSphereToSphere) {
    const auto half_space = displacements(ContactModel::elastic_half_space);
    const auto sphere = displacements(ContactModel::sphere_to_sphere);
    const auto fitted = displacements(ContactModel::mc_dem);
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(half_space[k], sphere[k], 2e-4) << k;
        EXPECT_NEAR(fitted[k], 1.1 * half_space[k], 1e-6) << k;
    }
}

}  // namespace
}  // namespace reference
