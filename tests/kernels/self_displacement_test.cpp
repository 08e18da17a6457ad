// One grain between rigid plates in a box: the forces to which the kernels converge, against the static
// solution of each model and, for the elastic sphere, against finite elements.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/names.h"
#include "reference/plates_reference.h"
#include "reference/test_scene.h"

namespace reference::between_plates {
namespace {

constexpr double radius = 0.01, youngs_modulus = 1e5;

struct Row {
    std::string arrangement;
    double poisson_ratio = 0, overlap = 0, value = 0;
};

/// Tables with the columns case, poisson_ratio, overlap_over_R and one value.
std::vector<Row> read_rows(const std::string& name) {
    std::ifstream file(MCDEM_SOURCE_DIR "/tests/truth/fem/" + name);
    std::vector<Row> rows;
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line.rfind("case,poisson_ratio,overlap_over_R,", 0), 0u) << name << ": " << line;
    while (std::getline(file, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream cells(line);
        Row row;
        cells >> row.arrangement >> row.poisson_ratio >> row.overlap >> row.value;
        EXPECT_TRUE(cells) << name << ": " << line;
        rows.push_back(row);
    }
    return rows;
}

/// A grain in a box of these half widths over its radius, slightly off the centre, so that it has to settle.
Start held_grain(ContactModel model, double poisson_ratio, const Vec3& half_width) {
    Replica replica;
    replica.grains = {youngs_modulus, poisson_ratio, 1000, 0, 0, 0.5, 0};
    replica.walls = {1e12, 0.5, 0, 0.5};
    replica.contact.model = model;
    replica.contact.gamma = 1.125;
    replica.numerics.probe_gap = 0.3;
    replica.box = {2 * radius * half_width.x(), 2 * radius * half_width.y()};
    replica.plate.start = 2 * radius * half_width.z();
    return {replica, {{radius * half_width + Vec3(1e-5, -1e-5, 2e-5)}, {2 * radius}}};
}

constexpr int settling_steps = 600;
constexpr double settling_drag = 200;  ///< [1/s]; a step is about 0.3 ms

/// Force on the plate over E R^2; NaN if the replica was stopped.
std::vector<double> settled_forces(const std::vector<Start>& starts, mcdem::Wall wall) {
    Batch batch(build(finest()), starts);
    std::vector<double> forces;
    for (const auto& result : batch.advance(settling_steps, settling_drag)) {
        const double force = result.wall_force[static_cast<int>(wall)].norm();
        forces.push_back(result.status ? std::nan("") : force / (youngs_modulus * radius * radius));
    }
    return forces;
}

Start between_plates(ContactModel model, const Row& row) {
    const double near = 1 - row.overlap, far = 3;
    const bool six = row.arrangement == "six_plates";
    return held_grain(model, row.poisson_ratio, six ? Vec3(near, near, near) : Vec3(far, far, near));
}

std::vector<Plate> plates(const Row& row) {
    std::vector<Plate> all;
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
        if (row.arrangement != "six_plates" && axis.z() == 0) continue;
        all.push_back({axis, row.overlap});
        all.push_back({-axis, row.overlap});
    }
    return all;
}

TEST(Plates, ForcesConvergeToTheStaticSolutionOfEveryModel) {
    std::vector<Row> rows;
    for (const char* arrangement : {"two_plates", "six_plates"})
        for (double nu : {0.0, 0.3, 0.5})
            for (double overlap : {0.01, 0.05, 0.1}) rows.push_back({arrangement, nu, overlap, 0});
    for (ContactModel model : all_models) {
        std::vector<Start> starts;
        for (const Row& row : rows) starts.push_back(between_plates(model, row));
        const auto forces = settled_forces(starts, mcdem::Wall::plate);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const Row& row = rows[k];
            const auto law = mcdem::surface_law(model, row.poisson_ratio, 1.125);
            const auto solution = solve_plates(law, row.poisson_ratio, plates(row));
            const std::string where = fmt::format("{} {} nu {} overlap {}", name(model), row.arrangement,
                                                  row.poisson_ratio, row.overlap);
            if (!solution) {
                EXPECT_TRUE(std::isnan(forces[k])) << where << ": there is no static solution";
                continue;
            }
            EXPECT_NEAR(forces[k] / solution->force[0], 1, has_double() ? 1e-5 : 1e-3) << where;
        }
    }
}

TEST(Plates, ElasticSphereAgreesWithFiniteElements) {
    const auto rows = read_rows("sphere_between_plates.csv");
    ASSERT_EQ(rows.size(), 36u);
    std::vector<Start> starts;
    for (const Row& row : rows) starts.push_back(between_plates(ContactModel::elastic_sphere, row));
    const auto forces = settled_forces(starts, mcdem::Wall::plate);
    double worst = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        EXPECT_NEAR(forces[k] / rows[k].value, 1, 0.01)
            << rows[k].arrangement << " nu " << rows[k].poisson_ratio << " overlap " << rows[k].overlap;
        worst = std::max(worst, std::abs(forces[k] / rows[k].value - 1));
    }
    fmt::print(
        "elastic sphere between two and six plates, overlap/R 0.005 to 0.15: within {:.2f} % of finite "
        "elements\n",
        100 * worst);
}

/// A grain compressed between floor and plate, with side walls at `gap` from its undeformed equator.
Start beside_walls(const Row& row, double overlap) {
    return held_grain(ContactModel::elastic_sphere, row.poisson_ratio,
                      Vec3(1 + row.value, 1 + row.value, 1 - overlap));
}

// At a given overlap the equator expands by a known displacement. Side walls at a gap 5 % larger than this
// have no force; at a gap 5 % smaller they have one. The grain is in the middle, since gaps are as small as
// 1e-4 radii.
TEST(Plates, EquatorTouchesTheSideWallsAtTheExpectedOverlap) {
    const auto rows = read_rows("equator_bulge.csv");
    ASSERT_EQ(rows.size(), 18u);
    std::vector<Start> below, above;
    for (const Row& row : rows) {
        for (auto [starts, part] : {std::pair(&below, 0.95), std::pair(&above, 1.05)}) {
            starts->push_back(beside_walls(row, part * row.overlap));
            auto& centre = starts->back().packing.position[0];
            centre.x() = centre.y() = radius * (1 + row.value);
        }
    }
    const auto nothing = settled_forces(below, mcdem::Wall::x_max),
               something = settled_forces(above, mcdem::Wall::x_max);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const std::string where = fmt::format("nu {} overlap {}", rows[k].poisson_ratio, rows[k].overlap);
        EXPECT_EQ(nothing[k], 0) << where;
        EXPECT_GT(something[k], 0) << where;
    }
}

}  // namespace
}  // namespace reference::between_plates
