// Tables of laboratories and other programs: cut into named columns whatever they look like, and told where
// they cannot.
#include "scene/foreign_table.h"

#include <zlib.h>

#include "scene/read_packing.h"
#include "scene/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ForeignTable table(const std::string& text) { return parse_foreign_table(text, "t"); }
std::vector<std::string> table_problems(const std::string& text) {
    return problems_of([&] { table(text); });
}

/// Columns x and F of 1.5, 2 and 2.5, -4, in the middle of whatever is around.
void expect_the_table(const ForeignTable& read, const std::vector<std::string>& columns) {
    EXPECT_EQ(read.columns, columns);
    ASSERT_EQ(read.rows(), 2u);
    EXPECT_EQ(read.number(0, 0), 1.5);
    EXPECT_EQ(read.number(0, 1), 2);
    EXPECT_EQ(read.number(1, 0), 2.5);
    EXPECT_EQ(read.number(1, 1), -4);
}

TEST(ForeignText, IsCutHoweverItIsWritten) {
    const std::vector<std::string> names{"x", "F"}, none{"column 1", "column 2"};
    expect_the_table(table("x,F\n1.5,2\n2.5,-4\n"), names);
    expect_the_table(table("\xEF\xBB\xBFx;F\r\n1,5;2\r\n2,5;-4\r\n"), names);
    expect_the_table(table("x\tF\n1.5\t2\n2.5\t-4"), names);
    expect_the_table(table("  x   F\n\n  1.5  2\n# later\n  2.5 -4.0e0\n"), names);
    expect_the_table(table("x F\n1,5 2,0\n2,5 -4\n"), names);
    expect_the_table(table("\"x\",\"F\"\n\"1.5\",2\n2.5,-4\n"), names);
    expect_the_table(table("x;F;\n1,5;2;\n2,5;-4;\n"), names);
    expect_the_table(table("1.5,2\n2.5,-4\n"), none);
    expect_the_table(table("# x F\n1.5 2\n2.5 -4\n"), names);
    expect_the_table(table("Probe: 3\nDatum;gestern\nx;F\n1,5;2\n2,5;-4\n"), names);
    expect_the_table(table("Probe;17;a\nLast;0,5;N\nx;F\n1,5;2\n2,5;-4\n"), names);
    expect_the_table(table("x;F\n[mm];[mN]\n1,5;2\n2,5;-4\n"), {"x [mm]", "F [mN]"});
    expect_the_table(table("H\xF6he [\xB5m];F\n1,5;2\n2,5;-4\n"), {"H\xC3\xB6he [\xC2\xB5m]", "F"});
    expect_the_table(table("x;?\n1,5;2\n2,5;-4\n"), {"x", "column 2"});
    expect_the_table(table("x;-F\n1,5;2\n2,5;-4\n"), {"x", "column 2"});
    expect_the_table(table("x;x\n1,5;2\n2,5;-4\n"), {"x", "column 2"});
}

TEST(ForeignText, CanBeCutAsStated) {
    const ForeignTable read = parse_foreign_table("a b;c\n1 2;3\n", "t", TextForm{' ', '.'});
    EXPECT_THAT(read.columns, ElementsAre("a", "b;c"));
    EXPECT_EQ(read.cell(0, 1), "2;3");
    EXPECT_EQ(read.number(0, 1), std::nullopt);
}

TEST(ForeignText, RowsKnowTheirLines) {
    const ForeignTable read = table("x,F\n# remark\n\n1,2\n3,4\n");
    EXPECT_EQ(read.where(0), "t:4");
    EXPECT_EQ(read.where(1), "t:5");
}

TEST(ForeignText, WrongOnesAreTold) {
    EXPECT_THAT(table_problems(""),
                ElementsAre("t: must have at least one row with a number in it, got none"));
    EXPECT_THAT(table_problems("a,b\nc,d\n"), ElementsAre(HasSubstr("at least one row")));
    EXPECT_THAT(table_problems("a,b\n1,2\n1,2,3\n1\n"),
                ElementsAre("t:3: must have 2 columns as the first row, got 3",
                            "t:4: must have 2 columns as the first row, got 1"));
    EXPECT_THAT(table_problems(std::string("a,b\n1,2\n\0", 9)),
                ElementsAre(HasSubstr("got zero bytes: save it as text in UTF-8")));
    EXPECT_EQ(table_problems("a,b\n1,2\n" + std::string(10000, ',') + std::string(1000, '\n')).size(), 1u);
}

TEST(ForeignText, SeparatorsOfThousandsAreRefused) {
    for (const std::string cell : {"1.306", "-12.345", "1.306.217", "3.217,5"})
        EXPECT_THAT(
            table_problems("x;F\n0,5;1,5\n1,5;" + cell + "\n"),
            ElementsAre(HasSubstr("t:3: numbers must have no separators of thousands, got \"" + cell)));
    EXPECT_THAT(table_problems("x,F\n0.5,1.5\n1.5,\"1,306\"\n"), ElementsAre(HasSubstr("thousands")));
    EXPECT_EQ(table("x;F\n0,5;1,5\n1,5;0.306\n").number(1, 1), 0.306);
}

TEST(ForeignText, CommasThatPartThousandsAreSeenByTheWholeTable) {
    for (const std::string separator : {";", "\t"}) {
        std::string text = "x" + separator + "F\n1,306" + separator + "2\n";
        EXPECT_FALSE(table(text).decimal_clear);
        EXPECT_TRUE(parse_foreign_table(text + "0,5" + separator + "3\n", "t").decimal_clear);
        for (int row = 0; row < 200; ++row) text += "1,306" + separator + "2\n";
        EXPECT_THAT(
            table_problems(text + "1" + separator + "2.5\n"),
            ElementsAre(
                "t:2: numbers must have one decimal mark and no separators of thousands, got \"1,306\" "
                "beside \"2.5\" in line 203: write the table with points only"));
        EXPECT_THAT(table_problems(text + "0,5" + separator + "2.5\n"),
                    ElementsAre(HasSubstr("t:2: numbers must have")));
    }
    EXPECT_EQ(table("x;F\n0,5;2\n1,306;3\n").number(1, 0), 1.306);
    EXPECT_THAT(problems_of([] {
                    parse_foreign_table("x;F\n1,306;2.5\n", "t", TextForm{';', ','});
                }),
                ElementsAre(HasSubstr("must have one decimal mark")));
}

TEST(ForeignText, LinesOfAnotherKindAboveTheNamesAreNoRows) {
    const std::vector<std::string> names{"x", "F"};
    expect_the_table(table("Vorkraft;0,5\nx;F\n1,5;2\n2,5;-4\n"), names);
    expect_the_table(table("Probe;Sand\nVorkraft;0,5\nWeg;3 mm\nx;F\n[mm];[N]\n1,5;2\n2,5;-4\n"),
                     {"x [mm]", "F [N]"});
    expect_the_table(table("Vorkraft,0.5\n\n# later\nx,F\n1.5,2\n2.5,-4\n"), names);
    EXPECT_EQ(table("load;0,5;a\nload;1,5;b\npause;here;c\nunload;2;d\n").rows(), 4u)
        << "a row like those below";
    EXPECT_EQ(table("x;F\nnan;0,5\na;b\n1,5;2\n").rows(), 3u) << "nothing is no word";
}

TEST(ForeignText, YadesFormatsNameTheirColumns) {
    EXPECT_THAT(table("#format x_y_z_r\n1\t2\t3\t0.5\n").columns, ElementsAre("x", "y", "z", "r"));
    EXPECT_THAT(table("#format id_x_y_z_r_matId\n7\t1\t2\t3\t0.5\t0\n").columns,
                ElementsAre("id", "x", "y", "z", "r", "matId"));
    EXPECT_THAT(table("#format x_y_z_r_attrs\n# x y z r dist v_x\n1\t2\t3\t0.5\t9\t8\n").columns,
                ElementsAre("x", "y", "z", "r", "dist", "v_x"));
}

const std::string two_frames =
    "ITEM: UNITS\nsi\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 "
    "1\n"
    "ITEM: ATOMS id x y z diameter \n2 0.2 0.2 0.2 0.02 \n1 0.1 0.2 0.3 0.01 \n"
    "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
    "ITEM: ATOMS id x y z diameter \n1 0.4 0.5 0.6 0.01 \n";

TEST(ForeignDump, HasFramesOfRows) {
    const ForeignTable read = table(two_frames);
    EXPECT_EQ(read.format, TableFormat::dump);
    EXPECT_THAT(read.columns, ElementsAre("id", "x", "y", "z", "diameter"));
    ASSERT_EQ(read.frames.size(), 2u);
    EXPECT_EQ(read.frames[1].step, 200);
    EXPECT_EQ(read.frames[1].first_row, 2u);
    EXPECT_EQ(read.number(2, 1), 0.4);
    EXPECT_EQ(read.where(2), "t:23");
    const ForeignTable local = table(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
        "ITEM: ENTRIES c_1[1] c_1[2] c_2 \n1 2 0.5 \n");
    EXPECT_THAT(local.columns, ElementsAre("c_1[1]", "c_1[2]", "c_2"));
}

TEST(ForeignDump, WrongOnesAreTold) {
    const auto spoiled = [](const std::string& from, const std::string& to) {
        std::string text = two_frames;
        return table_problems(text.replace(text.find(from), from.size(), to));
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
        spoiled("0 1\nITEM: ATOMS id x y z diameter \n1", "0 1\nITEM: ATOMS id y x z diameter \n1"),
        ElementsAre(
            "t:22: the columns must be those of the first frame, id x y z diameter, got id y x z diameter"));
    EXPECT_THAT(
        spoiled("ITEM: ATOMS id x y z diameter \n1", "ITEM: ATOMS id x y z \n1"),
        ElementsAre("t:22: the columns must be those of the first frame, id x y z diameter, got id x y z"));
    EXPECT_THAT(table_problems("ITEM: TIMESTEP\n1\n"),
                ElementsAre("t: must hold at least one frame, got none"));
    EXPECT_THAT(table_problems("ITEM: ATOMS id\n1\n"),
                ElementsAre(HasSubstr("t:1: \"ITEM: TIMESTEP\" must come before")));
}

const std::string vtk = "# vtk DataFile Version 3.0.\ncomment\nASCII\n\nDATASET POLYDATA\n";

TEST(ForeignVtk, PointsAndLinesAreRows) {
    const ForeignTable spheres = table(vtk +
                                       "POINTS 2 double\n1 2 3\n4 5 6\n\nPOINT_DATA 2\nSCALARS radius double "
                                       "1\nLOOKUP_TABLE default\n0.5\n0.6\n"
                                       "\nVECTORS v double\n1 0 0\n0 7 0\n");
    EXPECT_THAT(spheres.columns, ElementsAre("x", "y", "z", "radius", "v_x", "v_y", "v_z"));
    EXPECT_EQ(spheres.number(1, 3), 0.6);
    EXPECT_EQ(spheres.number(1, 5), 7);
    EXPECT_EQ(spheres.where(1), "t:8");
    const ForeignTable contacts = table(vtk +
                                        "POINTS 2 double\n1 2 3\n4 5 6\nLINES 1 3\n2 0 1\n\nCELL_DATA "
                                        "1\n\nSCALARS fn double 1\nLOOKUP_TABLE default\n9\n");
    EXPECT_THAT(contacts.columns, ElementsAre("x1", "y1", "z1", "x2", "y2", "z2", "fn"));
    EXPECT_EQ(contacts.number(0, 5), 6);
    EXPECT_EQ(contacts.number(0, 6), 9);
}

TEST(ForeignVtk, WrongOnesAreTold) {
    EXPECT_THAT(table_problems("# vtk DataFile Version 3.0\nc\nBINARY\n"),
                ElementsAre("t:3: the format must be ASCII: write the file as text"));
    EXPECT_THAT(table_problems(vtk), ElementsAre("t: must hold POINTS, got none"));
    EXPECT_THAT(table_problems(vtk + "POINTS 2 double\n1 2 3\n"),
                ElementsAre(HasSubstr("3 more numbers must follow, got the file's end")));
    EXPECT_THAT(table_problems(vtk + "POINTS 99999999999 double\n1 2 3\n"),
                testing::Contains(HasSubstr("must say how many there are")));
    EXPECT_THAT(table_problems(vtk + "POINTS 1 double\n1 2 3\nLINES 1 3\n2 0 1\n"),
                testing::Contains("t: line 0 must join two of the 1 points"));
    EXPECT_THAT(table_problems(vtk + "POINTS 1 double\n1 2 3\nPOINT_DATA 2\nSCALARS r double\n1\n2\n"),
                ElementsAre(HasSubstr("r must have 1 rows, as the points or lines, got 2")));
    EXPECT_THAT(table_problems(vtk + "CELLS 1 9\n"), ElementsAre(HasSubstr("t:6: must be one of POINTS")));
}

TEST(ForeignTables, MayBePacked) {
    const TestFolder folder;
    const auto file = folder.path() / "t.csv.gz";
    const gzFile out = gzopen(file.c_str(), "wb");
    gzputs(out, "x,F\n1.5,2\n2.5,-4\n");
    gzclose(out);
    expect_the_table(read_foreign_table(file), {"x", "F"});
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 4);
    EXPECT_THAT(problems_of([&] { read_foreign_table(file); }), ElementsAre(HasSubstr("cannot be unpacked")));
    EXPECT_THAT(problems_of([&] { read_foreign_table(folder.path() / "none"); }),
                ElementsAre(HasSubstr("got no such file")));
}

TEST(PackingOfDump, IsTheLastFrameOrTheStatedOne) {
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
        ElementsAre(HasSubstr("must be a dump where packing.frame is given")));
}

TEST(PackingFrame, IsAKeyOfScenes) {
    const TestFolder folder;
    folder.write("grains.dump", two_frames);
    const std::string box =
        "[box]\nsize_x = 1\nsize_y = 1\n[plate]\nstart = 1\nend = 0.9\n[packing]\nfile = \"grains.dump\"\n";
    const auto grains = [&](const std::string& more) {
        const Scene scene = parse_scene(box + more, (folder.path() / "s.toml").string());
        const auto& source = std::get<PackingFile>(scene.replicas.at(0).packing.source);
        return read_packing(source.path, source.step).size();
    };
    EXPECT_EQ(grains(""), 1u);
    EXPECT_EQ(grains("frame = 100\n"), 2u);
    const std::string scene_file = (folder.path() / "s.toml").string();
    EXPECT_THAT(problems_of([&] { parse_scene(box + "frame = 7\n", scene_file); }),
                ElementsAre(HasSubstr("must be one of its 2 timesteps")))
        << "told with the scene's other problems";
    EXPECT_THAT(problems_of([&] { parse_scene("[packing]\nframe = 7\n", "s.toml"); }),
                ElementsAre("s.toml:2: packing.frame must be left out where no packing.file is given"));
}

}  // namespace
}  // namespace mcdem
