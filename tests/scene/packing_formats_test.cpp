// Packings from dumps, from Yade's text format, and from one of several frames; errors are reported by line.
#include <fstream>

#include "scene/packing/packing_state.h"
#include "scene/packing/read_packing.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string two_frames =
    "ITEM: UNITS\nsi\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
    "1\n"
    "ITEM: ATOMS id x y z diameter \n2 0.2 0.2 0.2 0.02 \n1 0.1 0.2 0.3 0.01 \n"
    "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
    "ITEM: ATOMS id x y z diameter \n1 0.4 0.5 0.6 0.01 \n";

TEST(PackingOfDump, WrongFilesAreRefused) {
    const auto spoiled = [](const std::string& from, const std::string& to) {
        std::string text = two_frames;
        text.replace(text.find(from), from.size(), to);
        return problems_of([&] { read_dump_packing(text, "t"); });
    };
    EXPECT_THAT(spoiled("\n2 0.2 0.2 0.2 0.02 ", ""),
                ElementsAre("t:11: must have the 2 rows that the frame promises, got 1; truncated?"));
    EXPECT_THAT(spoiled("0.2 0.02 ", "0.02"),
                ElementsAre("t:12: must have 5 columns as line 11 says, got 4"));
    EXPECT_THAT(spoiled("\n100\n", "\nx\n"),
                testing::Contains("t:4: the timestep must be a whole number >= 0, got \"x\""));
    EXPECT_THAT(spoiled("\n2\nITEM", "\n-2\nITEM"),
                testing::Contains(HasSubstr("t:6: the number of rows must be a whole number >= 0")));
    EXPECT_THAT(
        spoiled("x y z diameter \n1 0.4", "x y z d \n1 0.4"),
        ElementsAre(
            "t: the columns must be x, y, z and diameter or radius, among others, got id, x, y, z, d"));
    std::string twice = two_frames;
    twice.replace(twice.find("\n2 0.2"), 2, "\n1");
    EXPECT_THAT(problems_of([&] { read_dump_packing(twice, "t", 100); }),
                ElementsAre("t:13: each grain must have its own id, got 1 again (first in line 12)"));
}

TEST(PackingOfDump, IsTheLastFrameOrTheGivenOne) {
    const TestFolder folder;
    const auto file = folder.write("grains.dump", two_frames);
    EXPECT_EQ(read_packing(file).size(), 1u);
    EXPECT_EQ(read_packing(file).position[0], Vec3(0.4, 0.5, 0.6));
    const Packing first = read_packing(file, 100);
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(first.position[0], Vec3(0.1, 0.2, 0.3)) << "in the order of the ids";
    EXPECT_EQ(first.diameter[1], 0.02);
    EXPECT_THAT(problems_of([&] { read_packing(file, 150); }),
                ElementsAre(HasSubstr("the frame must be one of its 2 timesteps, 100 to 200, got 150")));
}

TEST(PackingOfYade, HasRadii) {
    const TestFolder folder;
    for (const std::string head : {"#format x_y_z_r\n", "# from elsewhere\n", ""}) {
        const Packing packing =
            read_packing(folder.write("yade.txt", head + "0.1\t0.2\t0.3\t0.01\n0.2\t0.2\t0.3\t0.02\n"));
        ASSERT_EQ(packing.size(), 2u);
        EXPECT_EQ(packing.position[0], Vec3(0.1, 0.2, 0.3));
        EXPECT_EQ(packing.diameter[1], 0.04);
    }
    EXPECT_THAT(problems_of([&] {
                    read_packing(folder.write("bad.txt", "#format x_y_z_r\n0.1 0.2 0.3 -1\n0.1 nan 0.3 1\n"));
                }),
                ElementsAre(HasSubstr("bad.txt:2: r must be a finite number > 0 [m], got \"-1\""),
                            HasSubstr("bad.txt:3: y must be a finite number [m], got \"nan\"")));
    EXPECT_THAT(
        problems_of([&] { read_packing(folder.write("one.txt", "#format x_y_z_r\n0.1 0.2 0.3 1\n"), 5); }),
        ElementsAre(HasSubstr("must be a dump, grains.csv or run.h5 where packing.frame is given")));
}

TEST(PackingOfYade, OtherColumnsAreIgnored) {
    const Packing packing =
        read_yade_packing("#format id_x_y_z_r_matId\n7\t1\t2\t3\t0.5\t0\n3\t4\t5\t6\t0.5\t0\n", "t");
    ASSERT_EQ(packing.size(), 2u);
    EXPECT_EQ(packing.position[0], Vec3(4, 5, 6)) << "in the order of the ids";
    EXPECT_EQ(
        read_yade_packing("#format x_y_z_r_attrs\n# x y z r dist v_x\n1\t2\t3\t0.5\t9\t8\n", "t").diameter[0],
        1);
}

TEST(PackingOfYade, AnyCommentThatNamesTheCoordinatesNamesTheColumns) {
    const Packing packing = read_yade_packing("# id z y x radius\n1 3 2 1 0.5\n", "t");
    EXPECT_EQ(packing.position[0], Vec3(1, 2, 3));
    EXPECT_EQ(packing.diameter[0], 1);
    EXPECT_EQ(read_yade_packing("# x y z d diameter\n1 2 3 4 0.5\n", "t").diameter[0], 0.5);
}

TEST(PackingOfYade, AFormatLineBetweenRowsIsIgnored) {
    const Packing packing = read_yade_packing("#format x_y_z_r\n1 2 3 0.5\n#format 0.0\n4 5 6 0.5\n", "t");
    ASSERT_EQ(packing.size(), 2u);
    EXPECT_EQ(packing.position[1], Vec3(4, 5, 6));
}

TEST(PackingOfGrainsCsv, IsOneFrame) {
    const TestFolder folder;
    const auto file =
        folder.write("grains.csv",
                     "frame,grain,x_m,y_m,z_m,diameter_m\n0,0,0.1,0.2,0.3,0.01\n0,1,0.2,0.2,0.3,0.01\n"
                     "4,0,0.1,0.2,0.2,0.01\n4,1,0.2,0.2,0.2,0.01\n");
    ASSERT_EQ(read_packing(file).size(), 2u);
    EXPECT_EQ(read_packing(file).position[1], Vec3(0.2, 0.2, 0.3)) << "the first: the packing at rest";
    ASSERT_EQ(read_packing(file, 4).size(), 2u);
    EXPECT_EQ(read_packing(file, 4).position[1], Vec3(0.2, 0.2, 0.2));
    EXPECT_THAT(problems_of([&] { read_packing(file, 1); }),
                ElementsAre(HasSubstr("grains.csv: the frame must be one of its 2 frames, 0 to 4, got 1")));
    const auto plain = folder.write("plain.csv", "x_m,y_m,z_m,diameter_m\n0.1,0.2,0.3,0.01\n");
    EXPECT_THAT(problems_of([&] { read_packing(plain, 1); }),
                ElementsAre(HasSubstr("must have a column frame where packing.frame is given, got none")));
    const auto wrong = folder.write("wrong.csv", "frame,x_m,y_m,z_m,diameter_m\nx,0.1,0.2,0.3,0.01\n");
    EXPECT_THAT(problems_of([&] { read_packing(wrong); }),
                ElementsAre(HasSubstr("wrong.csv:2: frame must be a whole number from 0 on, got \"x\"")));
    EXPECT_THAT(problems_of([&] { read_packing(folder.write("grains.csv.gz", "\x1f\x8b")); }),
                ElementsAre(HasSubstr("must not be packed")));
}

TEST(PackingOfCsv, MayHaveVelocitiesAndSpins) {
    const auto read = [](const std::string& text) { return read_csv_packing(text, "t.csv"); };
    const Packing moving = read(
        "spin_z_1_s,vx_m_s,x_m,y_m,z_m,diameter_m,spin_x_1_s,vz_m_s,vy_m_s,spin_y_1_s\n"
        "9,1,0.1,0.2,0.3,0.01,7,-3,2e-1,8\n-9,-1,0.1,0.2,0.5,0.01,-7,3,0,-8\n");
    EXPECT_THAT(moving.velocity, ElementsAre(Vec3(1, 0.2, -3), Vec3(-1, 0, 3)));
    EXPECT_THAT(moving.angular_velocity, ElementsAre(Vec3(7, 8, 9), Vec3(-7, -8, -9)));
    const Packing spinning = read("x_m,y_m,z_m,diameter_m,spin_x_1_s,spin_y_1_s,spin_z_1_s\n0,0,0,1,1,2,3\n");
    EXPECT_TRUE(spinning.velocity.empty());
    EXPECT_THAT(spinning.angular_velocity, ElementsAre(Vec3(1, 2, 3)));
    const Packing resting = read("x_m,y_m,z_m,diameter_m,vx\n0,0,0,1,5\n");
    EXPECT_TRUE(resting.velocity.empty() && resting.angular_velocity.empty());
}

TEST(PackingFrame, IsAKeyOfScenes) {
    const TestFolder folder;
    folder.write("grains.dump", two_frames);
    const std::string box =
        "[box]\nsize_x = 1\nsize_y = 1\n[plate]\nstart = 1\nend = 0.9\n[packing]\nfile = \"grains.dump\"\n";
    const auto grains = [&](const std::string& more) {
        const Scene scene = parse_scene(box + more, (folder.path / "s.toml").string());
        const auto& source = std::get<PackingFile>(scene.replicas.at(0).packing.source);
        return read_packing(source.path, source.step).size();
    };
    EXPECT_EQ(grains(""), 1u);
    EXPECT_EQ(grains("frame = 100\n"), 2u);
    const std::string scene_file = (folder.path / "s.toml").string();
    EXPECT_THAT(problems_of([&] { parse_scene(box + "frame = 7\n", scene_file); }),
                ElementsAre(HasSubstr("must be one of its 2 timesteps")))
        << "told with the scene's other problems";
    EXPECT_THAT(problems_of([&] { parse_scene("[packing]\nframe = 7\n", "s.toml"); }),
                ElementsAre("s.toml:2: packing.frame must be left out where no packing.file is given"));
}

TEST(PackingState, CountsContactsAndFindsTheDeepest) {
    // Two grains overlap by 1 mm; the lower one overlaps the floor by 0.5 mm, the upper one the plate by 2
    // mm.
    const Packing packing{{Vec3(0.5, 0.5, 0.0095), Vec3(0.5, 0.5, 0.0335)}, {0.02, 0.03}};
    const Box box{1, 1};
    const PlateFace plate{0.0465, 0, 0, 0.5, 0.5};
    const PackingState state = packing_state(packing, box, plate);
    EXPECT_DOUBLE_EQ(state.coordination_number, 2) << "a pair counts for both";
    EXPECT_NEAR(state.deepest_overlap, 2e-3, 1e-12);
    EXPECT_NEAR(state.relative_overlap, 2e-3 / 0.03, 1e-12);
    const PackingState loose = packing_state(packing, box, {0.1, 0, 0, 0.5, 0.5});
    EXPECT_DOUBLE_EQ(loose.coordination_number, 1.5);
    EXPECT_NEAR(loose.deepest_overlap, 1e-3, 1e-12);
    EXPECT_NEAR(loose.relative_overlap, 1e-3 / 0.02, 1e-12) << "of the smaller grain";
    const DeepestPair deepest = deepest_pair(packing, box, 0.0465);
    EXPECT_EQ(deepest.first, 0u);
    EXPECT_EQ(deepest.second, 1u);
    EXPECT_NEAR(deepest.overlap, 1e-3 / 0.025 * 1.5, 1e-12)
        << "of the sum of the radii, times the ratio of the radii";
    const Packing across{{Vec3(0.01, 0.5, 0.5), Vec3(0.995, 0.5, 0.5)}, {0.03, 0.03}};
    EXPECT_NEAR(deepest_pair(across, {1, 1, ContainerShape::periodic}, 1).overlap, 0.5, 1e-12)
        << "over the periodic side";
    EXPECT_EQ(deepest_pair(across, box, 1).overlap, 0);
}

TEST(PackingState, GrainsInOnePlaceAreRefused) {
    const TestFolder folder;
    folder.write("p.csv", "x_m,y_m,z_m,diameter_m\n0.1,0.1,0.1,0.02\n0.2,0.2,0.2,0.02\n0.1,0.1,0.1,0.02\n");
    const std::string scene =
        "[box]\nsize_x = 0.3\nsize_y = 0.3\n[packing]\nfile = \"p.csv\"\n[plate]\nstart = "
        "0.3\nend = 0.25\n[numerics]\noverlap_limit = ";
    const std::string file = (folder.path / "s.toml").string();
    EXPECT_THAT(
        problems_of([&] { parse_scene(scene + "0.4\n", file); }),
        ElementsAre(HasSubstr("overlap_limit = 0.4 of the sum of their radii, got 1 (of unequal grains times "
                              "the ratio of the radii) for grains 0 and 2, counted from 0")));
    EXPECT_NO_THROW(parse_scene(scene + "1\n", file));
}

}  // namespace
}  // namespace mcdem
