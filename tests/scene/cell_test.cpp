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
using testing::Contains;
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
    EXPECT_EQ(replica.parameters.at("plate.start"), "") << "does not apply";
    EXPECT_EQ(replica.parameters.at("walls.friction"), "");
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
    EXPECT_THAT(problems_in(cell + "height = 0.11\n" + few + one_move),
                ElementsAre(AllOf(HasSubstr("bad.toml:5: container.height must be left out"),
                                  HasSubstr("packing.packing_fraction"))));
}

TEST(Cell, RefusesKeysOfPlateAndWalls) {
    for (const char* key : {"plate.start", "plate.speed", "walls.friction", "effects.plate_compliance",
                            "effects.plate_tilt_x", "grains.excess_density"})
        EXPECT_THAT(
            problems_in(cell + few + one_move, {std::string(key) + "=0.01"}),
            ElementsAre(AllOf(HasSubstr(key), HasSubstr("left out where container.shape = \"cell\""))));
    EXPECT_THAT(problems_in(cell + few),
                ElementsAre(HasSubstr("container.shape must come with a [[programme]]")));
    EXPECT_THAT(problems_in("[container]\nheight = 0.1\n" + few),
                ElementsAre(HasSubstr("container.height must be left out where container.shape = \"box\"")));
}

TEST(Cell, RefusesStagesOfAPlate) {
    const auto problems = [](const std::string& stage) {
        return problems_in(cell + few + "[[programme]]\n" + stage);
    };
    EXPECT_THAT(problems("position = 0.1\n"),
                Contains(HasSubstr("position must be left out of a stage that is a move of a cell")));
    EXPECT_THAT(problems("strain = 0.1\nspeed = 0.1\n"), ElementsAre(HasSubstr("speed must be left out")));
    EXPECT_THAT(problems("stage = \"cycle\"\n"),
                ElementsAre(HasSubstr("must be move, hold or repeat in a cell")));
    EXPECT_THAT(problems("rate = 1\n"), ElementsAre(HasSubstr("strain must be given, or strain_x")));
    EXPECT_THAT(problems("strain = 0.1\nstrain_y = 0.1\n"),
                ElementsAre(HasSubstr("strain_y must be left out where strain is given")));
    EXPECT_THAT(problems("shear_xy = 6\n"),
                ElementsAre(HasSubstr("shear_xy must be a number between -5 and 5")));
    EXPECT_THAT(problems_in(few + "[[programme]]\nstrain_x = 0.1\n"),
                Contains(HasSubstr("strain_x must be left out of a stage that is a move of the plate")));
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
    const auto problems = [](const std::string& stage) {
        return problems_in(cell + few + "[[programme]]\n" + stage);
    };
    EXPECT_THAT(problems("strain_x = 0.1\nstress_x = 100\n"),
                ElementsAre(AllOf(HasSubstr("programme.1.stress_x must be left out where strain_x is given"),
                                  HasSubstr("a direction has a strain or a stress"))));
    EXPECT_THAT(problems("strain = 0.1\nstress_y = 100\n"),
                ElementsAre(HasSubstr("stress_y must be left out where strain is given")));
    EXPECT_THAT(problems("pressure = 10\nstress_y = 100\nstrain_z = 0.1\n"),
                ElementsAre(HasSubstr("stress_y must be left out where pressure is given"),
                            HasSubstr("strain_z must be left out where pressure is given")));
    EXPECT_THAT(problems("strain = 0.1\npressure = 100\n"),
                ElementsAre(HasSubstr("pressure must be left out where strain is given")));
    EXPECT_THAT(problems("stress_z = 0\n"), ElementsAre(HasSubstr("stress_z must be a number > 0")));
    EXPECT_THAT(problems("pressure = 1e7\n"),
                ElementsAre(AllOf(HasSubstr("pressure must be one that the grains can bear, got 10000000"),
                                  HasSubstr("numerics.overlap_limit"))));
    EXPECT_THAT(problems("stress_x = 1e7\nstress_z = 100\n"),
                ElementsAre(HasSubstr("stress_x must be one that the grains can bear")));
    EXPECT_THAT(problems_in(few + "[[programme]]\npressure = 100\n"),
                Contains(HasSubstr("pressure must be left out of a stage that is a move of the plate")));
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
    const auto problems = [](const std::string& stage) {
        return problems_in(cell + few + "[[programme]]\n" + stage);
    };
    EXPECT_THAT(problems("shear_xy = 0.1\nstress_xy = 10\n"),
                ElementsAre(AllOf(HasSubstr("programme.1.stress_xy must be left out where shear_xy is given"),
                                  HasSubstr("a direction has a strain or a stress"))));
    EXPECT_THAT(problems("pressure = 100\nstress_yz = -1e7\n"),
                ElementsAre(HasSubstr("stress_yz must be one that the grains can bear, got -10000000")));
    EXPECT_THAT(problems_in(few + "[[programme]]\nstress_xy = 100\n"),
                Contains(HasSubstr("stress_xy must be left out of a stage that is a move of the plate")));
}

TEST(Cell, ListsScansOnTheWayOfAMove) {
    const auto problems = [](const std::string& stages) { return problems_in(cell + few + stages); };
    const std::string move = "[[programme]]\n", pressure = move + "pressure = 100\n",
                      hold = move + "stage = \"hold\"\ntime = 1\n";
    const std::string good[] = {
        "strain = 0.1\nscan_at = [0.05, 0.1]\n",
        "strain_z = 0.1\nshear_xy = -0.3\nscan_at = [-0.1, -0.2]\n",
        "pressure = 200\nscan_at = [150]\n",
        "stress_x = 50\nstress_z = 50\nscan_at = [20, 50]\n",
        "strain = 0.05\n" + move + "strain_x = 0.1\nstrain_y = 0.02\nscan_at = [0.07]\n",
        "pressure = 100\n" + move + "pressure = 100\nstress_xz = 10\nscan_at = [5]\n",
        "pressure = 100\n" + move + "stress_x = 90\nstress_y = 100\nstress_z = 200\nscan_at = [150]\n",
        "pressure = 100\n" + move + "strain = 0.1\nscan_at = [0.07]\n",
    };
    for (const std::string& stages : good)
        EXPECT_NO_THROW(parse_scene(cell + few + move + stages, "good.toml", {})) << stages;
    const std::pair<std::string, std::string> wrong[] = {
        {move + "strain = 0.1\nscan_at = [0.05, 0.2]\n",
         "programme.1.scan_at must be values of strain on the way from 0 to 0.1, one after the other, got "
         "0.2 "
         "after 0.05"},
        {move + "strain_z = 0.1\nshear_xy = -0.3\nscan_at = [0.05]\n",
         "programme.1.scan_at must be values of shear_xy on the way from 0 to -0.3, one after the other, got "
         "0.05 "
         "after 0"},
        {move + "strain_x = 0.1\nscan_at = [0.08, 0.05]\n",
         "values of strain_x on the way from 0 to 0.1, one after the other, got 0.05 after 0.08"},
        {one_move + move + "strain_x = 0.2\nscan_at = [0.1]\n",
         "programme.2.scan_at must be values of strain_x on the way from 0.1 to 0.2, one after the other, "
         "got 0.1"},
        {pressure + pressure + "shear_yz = 0.1\nscan_at = [100]\n",
         "values of shear_yz on the way from 0 to 0.1"},
        {pressure + move + "pressure = 300\nscan_at = [200, 400]\n",
         "programme.2.scan_at must be values of pressure on the way from 100 to 300, one after the other, "
         "got 400 "
         "after 200"},
        {move + "stress_x = 50\nstress_z = 50\nscan_at = [60, 55, 40]\n",
         "values of the mean of stress_x, stress_z on the way to 50, one after the other, got 40 after 55"},
        {pressure + move + "strain_x = 0.2\nstrain_y = 0.1\nscan_at = [0.1]\n",
         "programme.2.scan_at must be left out: the move changes several strains or stresses, and only the "
         "run "
         "shows which one changes most"},
        {pressure + hold + pressure + "stress_xz = 10\nscan_at = [5]\n",
         "programme.3.scan_at must be left out"},
        {pressure + pressure + "scan_at = [100]\n", "or it changes none (take scans instead)"},
        {move + "strain_x = 0.1\nscans = 2\nscan_at = [0.1]\n",
         "programme.1.scan_at must be left out where scans is given"},
        {move + "strain = 0.1\nscan_at = [0.05]\n" + move + "stage = \"repeat\"\n",
         "programme.1.scan_at must be left out"},
    };
    for (const auto& [stages, told] : wrong)
        EXPECT_THAT(problems(stages), ElementsAre(HasSubstr(told))) << stages;
}

TEST(Cell, HoldsStressesOnlyIfTheMoveBeforePrescribesThem) {
    const auto problems = [](const std::string& stages) { return problems_in(cell + few + stages); };
    const std::string hold = "[[programme]]\nstage = \"hold\"\ntime = 1\nkeep = ", stress = "\"stress\"\n";
    const std::string pressure = "[[programme]]\npressure = 100\n",
                      again = "[[programme]]\nstage = \"repeat\"\n";
    EXPECT_THAT(problems(hold + stress), ElementsAre(HasSubstr("keep must be position in the first stage")));
    EXPECT_THAT(
        problems(one_move + hold + stress),
        ElementsAre(AllOf(HasSubstr("programme.2.keep must be position where the move before sets no stress"),
                          HasSubstr("set those to be held"))));
    EXPECT_THAT(problems(pressure + hold + "\"force\"\n"),
                ElementsAre(HasSubstr("keep must be position or stress in a hold of a cell, got force")));
    EXPECT_NO_THROW(parse_scene(cell + few + pressure + hold + stress + hold + stress, "good.toml", {}));
    EXPECT_THAT(problems(pressure + hold + stress + one_move + again + "stages = 2\n"),
                ElementsAre(HasSubstr("programme.2.keep must be position")))
        << "the second time it follows a strain";
    EXPECT_THAT(problems_in("[plate]\nstart = 0.09\nend = 0.05\n" + few + "[[programme]]\nforce = 1\n" +
                            hold + stress),
                Contains(HasSubstr("keep must be position or force in a hold of the plate, got stress")));
}

TEST(Cell, MustStayLargeEnoughDuringItsProgramme) {
    const std::string thin = "[container]\nshape = \"cell\"\nsize_x = 0.06\nsize_y = 0.1\n";
    EXPECT_NO_THROW(parse_scene(thin + few + "[[programme]]\nstrain_z = 0.3\n", "good.toml", {}));
    EXPECT_THAT(problems_in(thin + few + "[[programme]]\nstrain_x = 0.1\n"),
                ElementsAre(AllOf(HasSubstr("container.size_x must be at least 0.0566"),
                                  HasSubstr("at its smallest, got 0.054"))));
    EXPECT_THAT(problems_in(cell + few + "[[programme]]\nstrain_z = 0.9\n"),
                ElementsAre(HasSubstr("container.height must be at least")));
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
