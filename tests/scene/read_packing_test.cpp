// Packings from files: the measured packing, both formats, and wrong files.
#include "scene/packing/read_packing.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "authors_data.h"
#include "scene/packing/make_packing.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

Packing lammps(const std::string& text) { return read_lammps_packing(text, "p.data"); }
Packing csv(const std::string& text) { return read_csv_packing(text, "p.csv"); }
std::vector<std::string> lammps_problems(const std::string& text) {
    return problems_of([&] { lammps(text); });
}
std::vector<std::string> csv_problems(const std::string& text) {
    return problems_of([&] { csv(text); });
}

const std::string title = "a title with 3 atoms in it\n\n";

TEST(MeasuredPacking, HasTheStatisticsOfTheExperiment) {
    SKIP_WITHOUT_AUTHORS_DATA("input.data");
    const std::string file = (reference::authors_folder / "input.data").string();
    const Packing packing = read_packing(file);
    ASSERT_EQ(packing.size(), 514u);
    double mean = 0, square = 0, volume = 0;
    for (double d : packing.diameter) {
        mean += d / 514;
        volume += std::numbers::pi / 6 * d * d * d;
    }
    for (double d : packing.diameter) square += (d - mean) * (d - mean);
    EXPECT_NEAR(mean, 21.490e-3, 0.5e-6);
    EXPECT_NEAR(std::sqrt(square / 513), 1.199e-3, 0.5e-6);
    EXPECT_NEAR(volume, 2695.88e-6, 0.005e-6);
    EXPECT_EQ(packing.diameter[0], 0.0192777);
    EXPECT_EQ(packing.position[513], Vec3(0.0514528, 0.053274, 0.150855));
    EXPECT_THAT(packing_problems(packing, {0.165191, 0.165834}, {0.167643}, file), SizeIs(0));
}

TEST(LammpsPacking, GrainsAreOrderedByTheirIds) {
    const Packing packing = lammps(title +
                                   "2 atoms\n1 atom types\n0 1 xlo xhi\n\nAtoms # sphere\n\n"
                                   "7 1 0.02 1000 0.3 0.2 0.1  # seventh\r\n"
                                   "3 1 0.01 1000 +1e-1 0.2 0.3 0 0 -1\n"
                                   "\nVelocities\n\n1 0 0 0 0 0 0\n");
    ASSERT_EQ(packing.size(), 2u);
    EXPECT_EQ(packing.position[0], Vec3(0.1, 0.2, 0.3));
    EXPECT_EQ(packing.diameter[0], 0.01);
    EXPECT_EQ(packing.position[1], Vec3(0.3, 0.2, 0.1));
}

TEST(LammpsPacking, WrongFilesAreRefused) {
    EXPECT_THAT(lammps_problems("1 1 0.02 1 0.1 0.1 0.1\n"), SizeIs(2)) << "no header at all";
}

TEST(LammpsPacking, NumberOfProblemsIsLimited) {
    std::string text = title + "1000 atoms\nAtoms\n";
    for (int i = 1; i <= 1000; ++i) text += "x y z\n" + std::to_string(i) + " 1 0 1 0 0 0\n";
    EXPECT_LE(lammps_problems(text).size(), 20u);
    EXPECT_FALSE(lammps_problems(std::string(1 << 20, '\0')).empty());
}

TEST(CsvPacking, ColumnsMayBeInAnyOrder) {
    const Packing packing =
        csv("\xEF\xBB\xBF"
            "grain, diameter_m, z_m, y_m, x_m\r\n# remark\n9, 0.1234567890123456789, 3, 2, 1\n\n8,0.5,6,5,4");
    ASSERT_EQ(packing.size(), 2u);
    EXPECT_EQ(packing.position[0], Vec3(1, 2, 3)) << "in the order of the lines";
    EXPECT_EQ(packing.diameter[0], 0.1234567890123456789) << "to the last bit";
    EXPECT_EQ(packing.position[1], Vec3(4, 5, 6));
}

TEST(CsvPacking, QuotationMarksOfSpreadsheetsAreNoPartOfACell) {
    const Packing packing = csv("\"x_m\",\"y_m\",\"z_m\",\"diameter_m\"\n1,\"2\",3,0.5\n");
    ASSERT_EQ(packing.size(), 1u);
    EXPECT_EQ(packing.position[0], Vec3(1, 2, 3));
}

TEST(CsvPacking, WrongFilesAreRefused) {
    EXPECT_FALSE(csv_problems(std::string(100000, '\0')).empty());
    EXPECT_FALSE(csv_problems(std::string(100000, ',')).empty());
}

TEST(PackingFiles, FormatFollowsFromTheExtension) {
    const TestFolder folder;
    EXPECT_EQ(read_packing(folder.write("a.csv", "x_m,y_m,z_m,diameter_m\n1,2,3,4\n")).size(), 1u);
    EXPECT_EQ(read_packing(folder.write("b.data", title + "1 atoms\nAtoms\n1 1 0.02 1 0.1 0.1 0.1\n")).size(),
              1u);
    EXPECT_THAT(problems_of([&] { read_packing(folder.path / "none.csv"); }),
                ElementsAre(HasSubstr("got no such file")));
    EXPECT_THAT(problems_of([&] { read_packing(folder.path); }), ElementsAre(HasSubstr("not a file")));
}

TEST(PackingProblems, GrainsOutsideTheBoxAreReported) {
    const Packing packing{{{0.05, 0.05, 0.05}, {-0.01, 0.05, 0.05}, {0.05, 0.11, 0.05}, {0.05, 0.05, 0.3}},
                          {0.02, 0.02, 0.02, 0.02}};
    EXPECT_THAT(packing_problems(packing, {0.1, 0.1}, {0.2}, "p"),
                ElementsAre(HasSubstr("p: the centre of grain 1 must be in the box of 0.1 x 0.1 m below the "
                                      "plate at 0.2 m, got -0.01, 0.05, 0.05"),
                            HasSubstr("grain 2"), HasSubstr("grain 3")));
    EXPECT_THAT(packing_problems({}, {0.1, 0.1}, {0.2}, "p"), SizeIs(1));
    Packing many;
    many.position.assign(100000, Vec3(5, 5, 5));
    many.diameter.assign(100000, 0.01);
    EXPECT_THAT(packing_problems(many, {0.1, 0.1}, {0.2}, "p"), SizeIs(11));
}

TEST(PackingProblems, MillimetresAreDetected) {
    const Packing packing{{{50, 50, 50}, {70, 50, 50}}, {20, 21}};
    EXPECT_THAT(packing_problems(packing, {0.1, 0.1}, {0.2}, "p"),
                ElementsAre(HasSubstr("millimetres? divide by 1000")));
}

}  // namespace
}  // namespace mcdem
