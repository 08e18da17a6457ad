// One grain between rigid plates in a box: the forces to which the kernels converge, against the static
// solution of each model, which tests/elasticity compares with finite elements.
#include <fmt/core.h>

#include <cmath>

#include "core/names.h"
#include "reference/plates_reference.h"
#include "reference/test_scene.h"

namespace mcdem::reference::between_plates {
namespace {

constexpr double radius = 0.01, youngs_modulus = 1e5;
constexpr int settling_steps = 600;
constexpr double settling_drag = 200;  ///< [1/s]; a step is about 0.3 ms

/// Overlaps of all plates over R.
struct Row {
    bool six;
    double poisson_ratio, overlap;
};

/// Force on the wall over E R^2; NaN if the replica was stopped.
std::vector<double> settled_forces(const std::vector<Start>& starts, mcdem::Wall wall) {
    Batch batch(build(finest()), starts);
    std::vector<double> forces;
    for (const auto& result : batch.advance(settling_steps, settling_drag)) {
        const double force = result.wall_force[static_cast<int>(wall)].norm();
        forces.push_back(result.status ? std::nan("") : force / (youngs_modulus * radius * radius));
    }
    return forces;
}

/// Slightly off the centre, so that the grain has to settle.
Start between_plates(ContactModel model, const Row& row) {
    const double near = 1 - row.overlap, side = row.six ? near : 3;
    Start start = held_grain(model, row.poisson_ratio, 0.5, {side, side, near});
    start.packing.position[0] += Vec3(1e-5, -1e-5, 2e-5);
    return start;
}

std::vector<Plate> plates(const Row& row) {
    std::vector<Plate> all;
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)})
        for (double sign : {1, -1})
            if (row.six || axis.z() != 0) all.push_back({sign * axis, row.overlap});
    return all;
}

TEST(Plates, ForcesConvergeToTheStaticSolutionOfEveryModel) {
    for (ContactModel model : all_models) {
        // At 0.15 other models have no static solution between six plates, or do not find it.
        const bool deeper = model == ContactModel::elastic_sphere;
        std::vector<Row> rows;
        for (bool six : {false, true})
            for (double nu : {0.0, 0.3, 0.49, 0.5})
                for (double overlap : {0.01, 0.05, 0.1, 0.15})
                    if (overlap < 0.12 || deeper) rows.push_back({six, nu, overlap});
        std::vector<Start> starts;
        for (const Row& row : rows) starts.push_back(between_plates(model, row));
        const auto forces = settled_forces(starts, mcdem::Wall::plate);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const Row& row = rows[k];
            const auto law = mcdem::surface_law(model, row.poisson_ratio, 1.125);
            const auto solution = solve_plates(law, row.poisson_ratio, plates(row));
            const std::string where = fmt::format("{} {} plates nu {} overlap {}", name(model),
                                                  row.six ? 6 : 2, row.poisson_ratio, row.overlap);
            if (!solution) {
                EXPECT_TRUE(std::isnan(forces[k])) << where << ": there is no static solution";
                continue;
            }
            // near run-away the kernels' few Newton steps count
            const double tolerance = has_double() && row.overlap < 0.12 ? 1e-5 : 1e-3;
            EXPECT_NEAR(forces[k] / solution->force[0], 1, tolerance) << where;
        }
    }
}

// At a given overlap the equator expands by a known displacement. Side walls at a gap 5 % larger than that
// at an overlap have no force; at a gap 5 % smaller they have one. Gaps are as small as 1e-4 radii.
TEST(Plates, EquatorTouchesTheSideWallsAtTheExpectedOverlap) {
    std::vector<Start> without, with;
    for (double nu : {0.3, 0.49})
        for (double overlap : {0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.125, 0.15}) {
            const auto law = mcdem::surface_law(ContactModel::elastic_sphere, nu, 1);
            auto all = plates({false, nu, overlap});
            all.push_back({{1, 0, 0}, -0.5});  // too far to touch
            const double side = 1 + solve_plates(law, nu, all)->displacement[2];
            for (auto [starts, part] : {std::pair(&without, 0.95), std::pair(&with, 1.05)})
                starts->push_back(
                    held_grain(ContactModel::elastic_sphere, nu, 0.5, {side, side, 1 - part * overlap}));
        }
    for (double force : settled_forces(without, mcdem::Wall::x_max)) EXPECT_EQ(force, 0);
    for (double force : settled_forces(with, mcdem::Wall::x_max)) EXPECT_GT(force, 0);
}

}  // namespace
}  // namespace mcdem::reference::between_plates
