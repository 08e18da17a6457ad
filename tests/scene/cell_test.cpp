// Fully periodic cells: keys, errors, packings, and the strain path of their programmes.
#include "core/container.h"
#include "core/errors.h"
#include "largest_overlap.h"
#include "scene/packing/make_packing.h"
#include "scene/programme/cell_path.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string cell = "[container]\nshape = \"cell\"\nsize_x = 0.12\nsize_y = 0.1\n";
const std::string few = "[packing]\ncount = 200\npacking_fraction = 0.6\n";
const std::string one_move = "[[programme]]\nstrain = 0.1\n";

Replica read_one(const std::string& text) { return parse_scene(text, "good.toml", {}).replicas.at(0); }

TEST(Cell, HeightFollowsFromTheVolumeOfItsGrains) {
    const Replica replica = read_one(cell + few + one_move);
    EXPECT_EQ(replica.box.shape, ContainerShape::cell);
    EXPECT_EQ(replica.plate.start, replica.box.height);
    const Packing packing = make_packing(replica);
    double volume = 0;
    for (const double d : packing.diameter) volume += std::numbers::pi / 6 * d * d * d;
    EXPECT_NEAR(volume / (0.12 * 0.1 * replica.box.height), 0.6, 1e-3);
    EXPECT_LT(largest_overlap(packing, replica.box, replica.box.height), 0.05);
    double low = 1, high = 0;
    for (const Vec3& p : packing.position) low = std::min(low, p.z()), high = std::max(high, p.z());
    EXPECT_GE(low, 0);
    EXPECT_LT(high, replica.box.height);
    EXPECT_LT(low + replica.box.height - high, 0.01) << "no wall keeps grains off";
    EXPECT_EQ(parameter_text(replica.parameters.at("plate.start")), "") << "does not apply";
    EXPECT_EQ(parameter_text(replica.parameters.at("walls.friction")), "");
}

TEST(Cell, PackingFilesRequireItsHeight) {
    const TestFolder folder;
    const auto two =
        folder.write("two.csv", "x_m,y_m,z_m,diameter_m\n0.2,-0.3,0.02,0.024\n0.1,0.1,0.9,0.02\n");
    const std::string file = "[packing]\nfile = \"" + two.string() + "\"\n";
    EXPECT_THAT(problems_in(cell + file + one_move),
                ElementsAre(HasSubstr("container.height must be given")));
    const Replica replica = read_one(cell + "height = 0.11\n" + file + one_move);
    EXPECT_EQ(replica.box.height, 0.11);
    EXPECT_NEAR(make_packing(replica).position[1].z(), 0.9 - 8 * 0.11, 1e-12);
}

TEST(Cell, RefusesKeysOfPlateAndWalls) {
    for (const char* key : {"plate.start", "plate.speed", "walls.friction", "effects.plate_compliance",
                            "effects.plate_tilt_x", "grains.excess_density"})
        EXPECT_THAT(
            problems_in(cell + few + one_move, {std::string(key) + "=0.01"}),
            ElementsAre(AllOf(HasSubstr(key), HasSubstr("left out where container.shape = \"cell\""))));
}

TEST(Cell, EachDirectionHasAStrainOrAStress) {
    const Replica replica =
        read_one(cell + few + one_move +
                 "[[programme]]\npressure = 100\nshear_xz = 0.1\n[[programme]]\nstress_x = "
                 "50\nstrain_z = 0.2\n[[programme]]\nstage = \"hold\"\nkeep = "
                 "\"stress\"\ntime = 1\n");
    const auto& programme = replica.programme;
    EXPECT_FALSE(sets_stress(programme[0]));
    EXPECT_EQ(set_stress(programme[1])[1], 100);
    EXPECT_TRUE(std::isnan(set_stress(programme[1])[4]));
    EXPECT_EQ(set_stress(programme[2])[0], 50);
    EXPECT_TRUE(std::isnan(set_stress(programme[2])[1]));
    EXPECT_FALSE(sets_stress(programme[3])) << "a hold keeps what was set before";
    EXPECT_EQ(controlled(programme[0]), Controlled::position);
    for (int stage = 1; stage < 4; ++stage) EXPECT_EQ(controlled(programme[stage]), Controlled::stress);
    EXPECT_THAT(problems_in(cell + few + "[[programme]]\npressure = 10\nstress_y = 100\nstrain_z = 0.1\n"),
                ElementsAre(HasSubstr("stress_y must be left out where pressure is given"),
                            HasSubstr("strain_z must be left out where pressure is given")));
}

TEST(Cell, EachShearHasAStrainOrAStress) {
    const auto& programme = read_one(cell + few +
                                     "[[programme]]\npressure = 100\nstress_xz = -20\nshear_xy = 0.1\n"
                                     "[[programme]]\nstress_yz = 0\n")
                                .programme;
    EXPECT_EQ(set_stress(programme[0])[4], -20);
    EXPECT_EQ(set_stress(programme[0])[2], 100);
    EXPECT_TRUE(std::isnan(set_stress(programme[0])[3]));
    EXPECT_TRUE(sets_stress(programme[1]));
}

TEST(Cell, IsNoPlainStroke) {
    EXPECT_THROW(expect_plain_strokes(parse_scene(cell + few + one_move, "good.toml", {}), "a diagnosis"),
                 InputError);
}

TEST(CellMove, IsLinearBetweenMoves) {
    std::vector<Stage> stages(4);
    stages[0].strain = 0.1;
    stages[1].shear_xz = 0.4;
    stages[1].strain_y = 0.2;
    stages[2].kind = StageKind::hold;
    stages[3].strain_x = 0;
    std::vector<CellMove> moves;
    for (const Stage& stage : stages)
        moves.push_back(
            {stage, moves.empty() ? Strain{} : moves.back().to, moves.empty() ? 0 : moves.back().end});
    EXPECT_NEAR(moves[0].end, 0.1, 1e-15);
    EXPECT_NEAR(moves[1].end, 0.5, 1e-15);
    EXPECT_EQ(moves[2].end, moves[1].end);
    EXPECT_NEAR(moves[3].end, 0.6, 1e-15);
    EXPECT_EQ(moves[0].strain(0), (Strain{}));
    EXPECT_EQ(moves[1].strain(moves[1].end), (Strain{0.1, 0.2, 0.1, 0, 0.4, 0}));
    EXPECT_EQ(moves[2].strain(moves[2].end), moves[1].to);
    const Strain half = moves[1].strain(0.3);
    EXPECT_NEAR(half[1], 0.15, 1e-15);
    EXPECT_NEAR(half[4], 0.2, 1e-15);
    EXPECT_NEAR(moves[1].direction()[1], 0.25, 1e-12);
    EXPECT_NEAR(moves[3].direction()[0], -1, 1e-12);
    EXPECT_TRUE(moves[0].loads() && moves[1].loads());
    EXPECT_FALSE(moves[3].loads());
    Replica replica;
    replica.box = {1, 1, ContainerShape::cell, 2};
    replica.programme = stages;
    EXPECT_NEAR(smallest_cell(replica).size_x, 0.9, 1e-15);
    EXPECT_NEAR(smallest_cell(replica).size_y, 0.8, 1e-15);
    EXPECT_NEAR(smallest_cell(replica).height, 1.8, 1e-15);
}

TEST(CellImages, AreTheNearestAtAnyShear) {
    const Box start{0.1, 0.2, ContainerShape::cell, 0.3};
    const Box now = deformed(start, {0.1, 0, -0.1, 1.3, -0.7, 2.1});
    const Vec3 edges[]{
        {now.size_x, 0, 0}, {now.tilt_xy, now.size_y, 0}, {now.tilt_xz, now.tilt_yz, now.height}};
    const Vec3 near(0.02, -0.03, 0.04), from(0.5, 0.1, -0.2);
    for (int n = 0; n < 27; ++n) {
        const Vec3 to =
            from + near + (n % 3 - 1) * edges[0] + (n / 3 % 3 - 1) * edges[1] + (n / 9 - 1) * edges[2];
        EXPECT_LT((apart(now, from, to) - near).norm(), 1e-15);
        const Vec3 inside = into_cell(now, to);
        EXPECT_LT(apart(now, inside, to).norm(), 1e-15);
        EXPECT_TRUE((inside.array() >= 0).all() && inside.x() < now.size_x && inside.y() < now.size_y &&
                    inside.z() < now.height);
    }
}

}  // namespace
}  // namespace mcdem
