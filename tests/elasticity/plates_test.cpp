// Static forces on one sphere between plates: every contact model against solutions of the elastic problem
// by finite elements and by the series of tests/truth.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <map>

#include "core/names.h"
#include "reference/truth_table.h"

namespace mcdem::plates {
namespace {

using reference::images;
using reference::images_of;
using reference::Plate;
using reference::PlateSolution;
using reference::truth_table;
using std::numbers::pi;
using Directions = std::vector<Vec3>;
using Row = reference::TruthRow;

/// One group of plates, or two groups with different overlaps (overlap1, overlap2 of the tables).
std::vector<Directions> arrangement(const std::string& name) {
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    const Directions triangle{{1, 0, 0}, {-.5, std::sqrt(.75), 0}, {-.5, -std::sqrt(.75), 0}};
    const double angle = 35 * pi / 180;
    const std::map<std::string, std::vector<Directions>> known{
        {"two_plates", {images(z)}},
        {"three_triangle", {triangle}},
        {"four_square", {images_of({x, y})}},
        {"tetrahedron", {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}}},
        {"two_plus_two", {images(z), images(x)}},
        {"two_plus_four", {images(z), images_of({x, y})}},
        {"two_plus_triangle", {images(z), triangle}},
        {"rect_70deg", {images(Vec3(std::sin(angle), 0, std::cos(angle)))}},
        {"six_plates", {images_of({z, x, y})}},
        {"eight_cube", {images(Vec3(1, 1, 1))}},
        {"twelve_fcc", {images_of({{1, 1, 0}, {1, 0, 1}, {0, 1, 1}})}}};
    return known.at(name);
}

std::optional<PlateSolution> solve(ContactModel model, double nu, const std::vector<Directions>& groups,
                                   const std::vector<double>& overlaps) {
    std::vector<Plate> plates;
    for (std::size_t g = 0; g < groups.size(); ++g)
        std::ranges::copy(reference::equal_plates(groups[g], overlaps[g]), std::back_inserter(plates));
    return solve_plates(surface_law(model, nu, 1.125), nu, plates);
}

/// Force of the model over that of the table's row; NaN if the model has no solution.
double fem_ratio(ContactModel model, const Row& row) {
    const auto solution = solve(model, row.number("poisson_ratio"), arrangement(row.at("case")),
                                {row.number("overlap_over_R")});
    return solution ? solution->force[0] / row.number("force_over_E_R2") : std::nan("");
}

class FiniteElements : public testing::Test {
protected:
    void SetUp() override {
        forces_ = truth_table("fem/sphere_between_plates.csv");
        displacements_ = truth_table("fem/equator_bulge.csv");
        ASSERT_EQ(forces_.size(), 36u);
        ASSERT_EQ(displacements_.size(), 18u);
    }
    std::vector<Row> forces_, displacements_;
};

TEST_F(FiniteElements, ElasticSphereAgreesWithinOnePerCent) {
    for (const Row& row : forces_)
        EXPECT_NEAR(fem_ratio(ContactModel::elastic_sphere, row), 1, 0.01)
            << row.at("case") << " nu " << row.at("poisson_ratio") << " overlap " << row.at("overlap_over_R");
}

TEST_F(FiniteElements, DisplacementOfTheEquatorWithinOnePerCent) {
    for (const Row& row : displacements_) {
        const double overlap = row.number("overlap_over_R");
        // the third plate is too far to touch
        const auto solution = solve(ContactModel::elastic_sphere, row.number("poisson_ratio"),
                                    {images(Vec3::UnitZ()), {Vec3::UnitX()}}, {overlap, -0.5});
        ASSERT_TRUE(solution);
        EXPECT_EQ(solution->force[2], 0);
        EXPECT_NEAR(solution->displacement[2] / row.number("outward_displacement_over_R"), 1, 0.01)
            << "nu " << row.at("poisson_ratio") << " overlap " << overlap;
    }
}

// Errors of the other models at overlap/R = 0.1; this also shows that the comparison can fail.
TEST_F(FiniteElements, OtherModelsHaveTheKnownErrors) {
    struct Known {
        ContactModel model;
        double two_at_03, two_at_049, six_at_03, six_at_049;
    };
    const std::array<Known, 4> all{Known{ContactModel::independent, 0.823, 0.886, 0.585, 0.508},
                                   Known{ContactModel::point_force_on_sphere, 0.735, 0.775, 0.653, 0.637},
                                   Known{ContactModel::sphere_to_sphere, 1.002, 1.118, 0.875, 1.127},
                                   Known{ContactModel::elastic_half_space, 1.028, 1.154, 0.932, 1.408}};
    for (const Known& known : all)
        for (const Row& row : forces_) {
            if (row.number("overlap_over_R") != 0.1) continue;
            const bool two = row.at("case") == "two_plates", soft = row.number("poisson_ratio") == 0.3;
            const double expected = two ? (soft ? known.two_at_03 : known.two_at_049)
                                        : (soft ? known.six_at_03 : known.six_at_049);
            EXPECT_NEAR(fem_ratio(known.model, row), expected, 0.002)
                << name(known.model) << ' ' << row.at("case") << " nu " << row.at("poisson_ratio");
        }
}

// Above overlap/R of about (1 - nu^2)^2/(12 c^2 gamma^2), with c = sum of delta/(F/(E R)) over the other
// contacts, a half space has no static solution. For six plates c = 4 * 0.0825 + 0.237, which gives 0.15
// with points on the sphere, and less at the deformed points. The elastic sphere has a solution.
TEST(Plates, RunAwayIsDetected) {
    const auto six = arrangement("six_plates");
    EXPECT_FALSE(solve(ContactModel::elastic_half_space, 0.49, six, {0.15}));
    EXPECT_FALSE(solve(ContactModel::sphere_to_sphere, 0.49, six, {0.15}));
    EXPECT_TRUE(solve(ContactModel::elastic_sphere, 0.49, six, {0.15}));
}

/// Prints the force of every model over that of each row; returns the largest error of each model.
std::map<std::string, double> print_table(const char* material, const std::vector<Row>& rows) {
    std::map<std::string, double> worst;
    for (const Row& row : rows) {
        fmt::print("{:11} {:11} {:>4} {:>7}", material, row.at("case"), row.at("poisson_ratio"),
                   row.at("overlap_over_R"));
        for (auto model : name_list<ContactModel>) {
            const double ratio = fem_ratio(*parse<ContactModel>(model), row);
            fmt::print(" {:>21.3f}", ratio);
            const double miss = std::isnan(ratio) ? 1 : std::abs(ratio - 1);
            worst[std::string(model)] = std::max(worst[std::string(model)], miss);
        }
        fmt::print("\n");
    }
    return worst;
}

TEST_F(FiniteElements, TableOfModels) {
    fmt::print("force of the model / finite elements (mc_dem: gamma 1.125; nan: no static solution)\n");
    fmt::print("{:11} {:11} {:>4} {:>7}", "material", "case", "nu", "overlap");
    for (auto model : name_list<ContactModel>) fmt::print(" {:>21}", model);
    fmt::print("\n");
    const auto worst = print_table("linear", forces_);
    for (const auto& [model, miss] : worst) {
        if (model == "elastic_sphere") continue;
        EXPECT_GT(miss, 10 * worst.at("elastic_sphere")) << model;
    }
    const auto at_finite_strain =
        print_table("neo-Hookean", truth_table("fem/neo_hookean_sphere_between_plates.csv"));
    EXPECT_LT(at_finite_strain.at("hyperelastic_sphere"), 0.05);
    for (const auto& [model, miss] : at_finite_strain) {
        if (model == "hyperelastic_sphere") continue;
        EXPECT_GT(miss, 0.1) << model;
    }
}

/// Tolerance of the elastic sphere. Half a per cent in general, for the second-order terms that perturbation
/// about Hertz neglects and for the error of the reference with axisymmetric caps; more for contact radii
/// near half a radius, where neighbouring caps nearly touch.
double tolerance(const std::string& name, double overlap) {
    if (name == "twelve_fcc")
        return overlap > 0.07 ? 0.025 : overlap > 0.05 ? 0.008 : 0.005;  // near run-away
    if (name == "four_square") return overlap > 0.12 ? 0.016 : overlap > 0.07 ? 0.008 : 0.005;
    if (name == "six_plates" && overlap > 0.12) return 0.008;
    return 0.005;
}

TEST(SeriesTruth, ElasticSphereAgreesInOtherArrangements) {
    const auto rows = truth_table("other_arrangements.csv");
    ASSERT_EQ(rows.size(), 218u);
    for (const Row& row : rows) {
        const std::string& name = row.at("case");
        const double nu = row.number("poisson_ratio");
        const auto groups = arrangement(name);
        std::vector<double> overlaps{row.number("overlap1")}, truth{row.number("force1")};
        if (groups.size() == 2) {
            overlaps.push_back(row.number("overlap2"));
            truth.push_back(row.number("force2"));
        }
        const auto solution = solve(ContactModel::elastic_sphere, nu, groups, overlaps);
        ASSERT_TRUE(solution) << name << " nu " << nu << " overlap " << overlaps[0];
        std::size_t plate = 0;
        for (std::size_t g = 0; g < groups.size(); plate += groups[g++].size())
            EXPECT_NEAR(solution->force[plate] / truth[g], 1, tolerance(name, overlaps[g]))
                << name << " nu " << nu << " overlap " << overlaps[g] << " group " << g;
    }
}

// Two plates at an overlap of 0.1 move the equator outward; plates at exactly R then have a force.
TEST(SeriesTruth, DisplacedSurfacesCreateContacts) {
    const auto solution = solve(ContactModel::elastic_sphere, 0.3, arrangement("two_plus_four"), {0.1, 0});
    ASSERT_TRUE(solution);
    EXPECT_NEAR(solution->force[2], 0.00134655, 0.005 * 0.00134655);
    const auto hertz = solve(ContactModel::independent, 0.3, arrangement("two_plus_four"), {0.1, 0});
    EXPECT_EQ(hertz->force[2], 0);
}

}  // namespace
}  // namespace mcdem::plates
