// The contact model "hyperelastic sphere", compared with finite elements of one neo-Hookean sphere between
// plates; forces have a potential.
#include "elasticity/hyperelastic_sphere.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "reference/truth_table.h"

namespace mcdem {
namespace {

using reference::equal_plates;
using reference::images;
using reference::images_of;
using reference::Plate;
using reference::solve_plates;
using reference::truth_table;
using std::numbers::pi;

/// One load of an arrangement: every plate with its force by finite elements.
struct Load {
    std::string name;
    double poisson_ratio;
    std::vector<Plate> plates;
    std::vector<double> force;
};

/// Number of symmetry planes of an arrangement, x first.
int mirrors_of(const std::string& name) {
    return name.starts_with("asymmetric") ? 0 : name.starts_with("random") ? 2 : 3;
}

std::vector<Load> finite_elements() {
    std::map<std::string, Load> loads;
    for (const auto& row : truth_table("neo_hookean_plates.csv")) {
        if (row.at("plate") == "equator") continue;
        Load& load = loads[row.at("case") + row.at("poisson_ratio") + ' ' + row.at("load")];
        load.name = row.at("case");
        load.poisson_ratio = row.number("poisson_ratio");
        const Vec3 normal(row.number("x"), row.number("y"), row.number("z"));
        for (const Vec3& image : images(normal, mirrors_of(load.name))) {
            load.plates.push_back({image, row.number("overlap")});
            load.force.push_back(row.number("force"));
        }
    }
    std::vector<Load> all;
    for (auto& [key, load] : loads) all.push_back(load);
    return all;
}

/// Sum of the forces over 4 pi E R^2.
double mean_pressure(const Load& load) {
    double sum = 0;
    for (double force : load.force) sum += force;
    return sum / (4 * pi);
}

std::optional<reference::PlateSolution> forces(ContactModel model, double poisson_ratio,
                                               const std::vector<Plate>& plates) {
    constexpr double largest_overlap = 1.2;  // Hertz overlaps are large in filled cells
    return solve_plates(surface_law(model, poisson_ratio, 1), poisson_ratio, plates, largest_overlap);
}

/// Relative to the origin at which the forces of a model on the sphere cancel, close to that of finite
/// elements.
std::optional<reference::PlateSolution> forces_at_rest(ContactModel model, double poisson_ratio,
                                                       std::vector<Plate> plates) {
    for (int iteration = 0;; ++iteration) {
        const auto solution = forces(model, poisson_ratio, plates);
        Vec3 sum = Vec3::Zero();
        double stiffness = 0, total = 0;
        for (std::size_t c = 0; solution && c < plates.size(); ++c) {
            sum += solution->force[c] * plates[c].direction;
            stiffness += solution->force[c] / std::max(plates[c].overlap, 0.01);
            total += solution->force[c];
        }
        if (!solution || sum.norm() < 1e-6 * total || iteration == 500) return solution;
        for (Plate& plate : plates) plate.overlap -= plate.direction.dot(sum) / stiffness;
    }
}

using WorstErrors = std::map<std::string, std::array<double, 3>>;

/// Largest relative error of a model's force up to overlap/R 0.10, 0.15 and 0.20, for each arrangement, over
/// loads whose mean pressure over E is in a range. From 0.12 on the grain nearly fills its cell, where
/// forces depend strongly on the overlap.
WorstErrors worst_errors(ContactModel model, double least_pressure, double most_pressure) {
    WorstErrors worst;
    for (const Load& load : finite_elements()) {
        if (mean_pressure(load) <= least_pressure || mean_pressure(load) > most_pressure) continue;
        const auto solution = mirrors_of(load.name) == 3
                                  ? forces(model, load.poisson_ratio, load.plates)
                                  : forces_at_rest(model, load.poisson_ratio, load.plates);
        for (std::size_t c = 0; c < load.plates.size(); ++c) {
            const double overlap = load.plates[c].overlap;
            if (overlap < 0.03 || overlap > 0.2005)
                continue;  // smaller overlaps are not resolved by the mesh
            double& error = worst[load.name][overlap < 0.1005 ? 0 : overlap < 0.1505 ? 1 : 2];
            error = std::max(error, solution ? std::abs(solution->force[c] / load.force[c] - 1) : 1);
        }
    }
    return worst;
}

void print(const char* what, const WorstErrors& worst) {
    fmt::print("worst error of the force [%], overlap/R to 0.10, 0.15, 0.20: {}\n", what);
    for (const auto& [name, error] : worst)
        fmt::print("{:19}{:6.1f}{:6.1f}{:6.1f}\n", name, 100 * error[0], 100 * error[1], 100 * error[2]);
}

/// The least resolved contacts: fourteen plates at an overlap of 0.05, where finer meshes change the forces
/// by 1.4 %, and the coarser meshes of arrangements without symmetry (tests/truth/README.md).
double bar_at_small_overlap(const std::string& name) {
    return name == "fourteen" ? 0.042 : name.starts_with("asymmetric") ? 0.035 : 0.03;
}

// Seventeen of the arrangements are in the fit, twenty-one are not (tests/truth/fit_hyperelastic_sphere.py).
TEST(HyperelasticSphere, AgreesWithFiniteElementsInEveryArrangement) {
    print("elastic sphere, P to 0.12", worst_errors(ContactModel::elastic_sphere, 0, 0.12));
    const auto worst = worst_errors(ContactModel::hyperelastic_sphere, 0, 0.12);
    print("P to 0.12", worst);
    ASSERT_EQ(worst.size(), 38u);
    for (const auto& [name, error] : worst) {
        EXPECT_LT(error[0], bar_at_small_overlap(name)) << name;
        // In random_eight_c the force on plates 45 degrees apart is too small.
        EXPECT_LT(error[1], name == "random_eight_c" ? 0.04 : 0.03) << name;
        EXPECT_LT(error[2], 0.03) << name;
    }
}

/// The law fits one load of either arrangement badly (P = 0.27 and 0.16).
double bar_in_nearly_filled_cell(const std::string& name) {
    return name == "random_ten" ? 0.09 : name == "random_eight_c" ? 0.06 : 0.045;
}

// Forces are steep there: d ln F / d ln overlap is up to 7.
TEST(HyperelasticSphere, AgreesWithFiniteElementsInNearlyFilledCells) {
    const auto nearly = worst_errors(ContactModel::hyperelastic_sphere, 0.12, 0.3);
    print("P 0.12 to 0.3", nearly);
    for (const auto& [name, error] : nearly)
        EXPECT_LT(std::ranges::max(error), bar_in_nearly_filled_cell(name)) << name;
    const auto filled = worst_errors(ContactModel::hyperelastic_sphere, 0.3, 1);
    print("P 0.3 to 1", filled);
    for (const auto& [name, error] : filled) EXPECT_LT(std::ranges::max(error), 0.21) << name;
}

TEST(HyperelasticSphere, EqualsTheElasticSphereAtSmallOverlaps) {
    for (double nu : {0.0, 0.3, 0.4, 0.49, 0.5})
        for (double overlap : {1e-5, 1e-4, 1e-3}) {
            const auto plates = equal_plates(images_of({Vec3::UnitZ(), Vec3::UnitX()}), overlap);
            const auto finite = forces(ContactModel::hyperelastic_sphere, nu, plates);
            const auto small = forces(ContactModel::elastic_sphere, nu, plates);
            EXPECT_NEAR(finite->force[0] / small->force[0], 1, 0.2 * std::sqrt(overlap))
                << nu << ' ' << overlap;
        }
}

/// Work on a grain between three pairs of plates along a closed path of overlaps, over the integral of the
/// absolute power.
double work_around(ContactModel model, double poisson_ratio) {
    constexpr int points = 48;
    const std::array<Vec3, 3> axes{Vec3::UnitX(), Vec3(0.5, 0.8, 0.3).normalized(),
                                   Vec3(-0.2, 0.4, 0.9).normalized()};
    double closed = 0, absolute = 0;
    for (int i = 0; i < points; ++i) {
        const double t = 2 * pi * i / points;
        const std::array<double, 3> overlap{0.09 + 0.05 * std::cos(t), 0.09 + 0.05 * std::sin(t),
                                            0.1 + 0.02 * std::cos(2 * t)};
        const std::array<double, 3> rate{-0.05 * std::sin(t), 0.05 * std::cos(t), -0.04 * std::sin(2 * t)};
        std::vector<Plate> plates;
        for (int axis = 0; axis < 3; ++axis)
            for (double side : {1, -1}) plates.push_back({side * axes[axis], overlap[axis]});
        const auto solution = forces(model, poisson_ratio, plates);
        for (int axis = 0; axis < 3; ++axis) {
            const double power = 2 * solution->force[2 * axis] * rate[axis];
            closed += power;
            absolute += std::abs(power);
        }
    }
    return closed / absolute;
}

TEST(HyperelasticSphere, WorkAlongAClosedPathIsZero) {
    for (double nu : {0.3, 0.4, 0.49})
        EXPECT_NEAR(work_around(ContactModel::hyperelastic_sphere, nu), 0, 1e-7) << nu;
    EXPECT_GT(std::abs(work_around(ContactModel::elastic_half_space, 0.3)), 5e-6)
        << "the half space has no potential";
}

/// Hertz contact of two grains, or of a grain and a plate (other radius 0).
struct Touch {
    double overlap, radius;
};

Touch touch(double poisson_ratio, double force, double radius, double other_radius) {
    const double modulus = 1 / (1 - poisson_ratio * poisson_ratio) / (other_radius > 0 ? 2 : 1);
    const double reduced = other_radius > 0 ? radius * other_radius / (radius + other_radius) : radius;
    const double overlap = std::pow(force / (4.0 / 3 * modulus * std::sqrt(reduced)), 2.0 / 3);
    return {overlap, std::sqrt(reduced * overlap)};
}

/// Displacement of the plates at the ends of a row of two spheres, or of three spheres of which the middle
/// one is between four more plates.
class Row {
public:
    Row(ContactModel model, double poisson_ratio)
        : law_(surface_law(model, poisson_ratio, 1)), poisson_ratio_(poisson_ratio) {}

    /// Two spheres between two plates.
    double of_two(double force, double radius) const {
        const Touch between = touch(poisson_ratio_, force, 1, radius);
        return between.overlap + end(force, 1, between) + end(force, radius, between);
    }
    /// For three equal spheres: displacement at an end, and at a side plate.
    std::pair<double, double> of_three(double force, double side_force) const {
        const Touch between = touch(poisson_ratio_, force, 1, 1),
                    side = touch(poisson_ratio_, side_force, 1, 0);
        reference::Grain middle{1, 1, poisson_ratio_, {}};
        for (double sign : {1, -1}) {
            middle.slots.push_back({sign * Vec3::UnitZ(), 1, force, between.radius});
            for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0)})
                middle.slots.push_back({sign * axis, 1, side_force, side.radius});
        }
        const auto moved = reference::surface_displacement(law_, middle);
        return {between.overlap + end(force, 1, between) - moved[0], side.overlap - moved[1]};
    }

private:
    /// Overlap of the sphere at an end, including the Hertz overlap with the next one.
    double end(double force, double radius, const Touch& between) const {
        const Touch plate = touch(poisson_ratio_, force, radius, 0);
        const reference::Grain grain{
            radius,
            1,
            poisson_ratio_,
            {{Vec3::UnitZ(), radius, force, between.radius}, {-Vec3::UnitZ(), radius, force, plate.radius}}};
        const auto moved = reference::surface_displacement(law_, grain);
        return plate.overlap - moved[0] - moved[1];
    }
    SurfaceLaw law_;
    double poisson_ratio_;
};

double solve_force(double least, double most, auto&& excess) {
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = (least + most) / 2;
        (excess(middle) > 0 ? most : least) = middle;
    }
    return least;
}

// Contacts of spheres with unequal radii, or of equal spheres under unequal loads, are curved and not
// symmetric.
TEST(HyperelasticSphere, PlatesReplaceNeighbouringGrains) {
    const auto rows = truth_table("neo_hookean_chain.csv");
    EXPECT_GE(rows.size(), 12u);
    for (const auto& row : rows) {
        const std::string& arrangement = row.at("case");
        const double nu = row.number("poisson_ratio"), parameter = row.number("parameter"),
                     overlap = row.number("overlap"), force = row.number("force"),
                     side = row.number("side_overlap"), side_force = row.number("side_force");
        const Row law(ContactModel::hyperelastic_sphere, nu);
        if (overlap < 0.08) continue;  // not resolved by the mesh
        const std::string where = fmt::format("{} nu {} overlap {}", arrangement, nu, overlap);
        if (arrangement == "unequal") {
            const double found = solve_force(force / 3, 3 * force,
                                             [&](double f) { return law.of_two(f, parameter) - overlap; });
            EXPECT_NEAR(found / force, 1, 0.01) << where;
            continue;
        }
        const auto force_at = [&](double f_side) {
            return solve_force(force / 3, 3 * force,
                               [&](double f) { return law.of_three(f, f_side).first - overlap; });
        };
        const double found_side = solve_force(side_force / 3, 3 * side_force, [&](double f) {
            return law.of_three(force_at(f), f).second - side;
        });
        EXPECT_NEAR(force_at(found_side) / force, 1, 0.02) << where;
        EXPECT_NEAR(found_side / side_force, 1, 0.02) << where;
    }
}

// Two plates move the equator outward; a third plate touches it at this distance.
TEST(HyperelasticSphere, FirstContactOfTheEquatorWithinThreePerCent) {
    int judged = 0;
    for (const auto& row : truth_table("neo_hookean_plates.csv")) {
        const double nu = row.number("poisson_ratio"), load = row.number("load");
        if (row.at("plate") != "equator" || load < 0.04) continue;
        const auto solution = forces(ContactModel::hyperelastic_sphere, nu,
                                     {{Vec3::UnitZ(), load}, {-Vec3::UnitZ(), load}, {Vec3::UnitX(), -0.5}});
        ASSERT_TRUE(solution);
        EXPECT_NEAR(solution->displacement[2] / -row.number("overlap"), 1, 0.03) << nu << ' ' << load;
        ++judged;
    }
    EXPECT_EQ(judged, 21);
}

// Grains with twelve equal neighbours, compressed far beyond the available volume: forces increase and
// remain finite.
TEST(HyperelasticSphere, ForcesIncreaseWithoutRunAway) {
    for (double nu : {0.3, 0.4, 0.49}) {
        double before = 0;
        for (double overlap = 0.02; overlap < 0.14; overlap += 0.02) {
            const auto solution = forces(ContactModel::hyperelastic_sphere, nu,
                                         equal_plates(images_of({{1, 1, 0}, {1, 0, 1}, {0, 1, 1}}), overlap));
            ASSERT_TRUE(solution) << nu << ' ' << overlap;
            EXPECT_GT(solution->force[0], 1.2 * before);
            before = solution->force[0];
        }
    }
}

}  // namespace
}  // namespace mcdem
