// Surface displacements stored by the kernels, against the reference at every slot, touching or near. The
// reference is compared with known values in tests/elasticity.
#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "core/names.h"
#include "kernels/saved_rows.h"

namespace mcdem::reference {
namespace {

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

}  // namespace
}  // namespace mcdem::reference
