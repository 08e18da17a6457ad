// What Yade writes, and tables that state less than a force: they come out like the rest.
#include "experiment/import_fixture.h"

namespace mcdem::test {
namespace {

using ::testing::IsEmpty;

constexpr int yade_walls = 6;  // bodies 0 to 5 in the order of Wall; grains follow

std::string vtk_of_spheres(const Recording& recording, const Scan& scan) {
    std::string text =
        fmt::format("# vtk DataFile Version 3.0.\ncomment\nASCII\n\nDATASET POLYDATA\nPOINTS {} double\n",
                    scan.position.size());
    for (const Vec3& at : scan.position)
        text += fmt::format("{:.9g} {:.9g} {:.9g}\n", at.x(), at.y(), at.z());
    text +=
        fmt::format("\nPOINT_DATA {}\nSCALARS radius double 1\nLOOKUP_TABLE default\n", scan.position.size());
    for (const double diameter : recording.diameter) text += fmt::format("{:.9g}\n", diameter / 2);
    return text;
}

/// exportInteractions(what={'id1': .., 'id2': .., 'force': ..}), the smaller id first, the force on it.
std::string vtk_of_interactions(const Scan& scan) {
    std::string points, lines, first, second, force;
    long n = 0;
    for (const Contact& c : scan.contacts) {
        const bool wall = is_wall(c.partner);
        points += "0 0 0\n1 1 1\n";  // of no use: the ids tell
        lines += fmt::format("2 {} {}\n", 2 * n, 2 * n + 1);
        first += fmt::format("{}\n", wall ? static_cast<int>(wall_of(c.partner)) : c.grain + yade_walls);
        second += fmt::format("{}\n", (wall ? c.grain : c.partner) + yade_walls);
        const Vec3 on_first = wall ? Vec3(-c.force) : c.force;
        force += fmt::format("{:.9g} {:.9g} {:.9g}\n", on_first.x(), on_first.y(), on_first.z());
        ++n;
    }
    return fmt::format(
        "# vtk DataFile Version 3.0.\ncomment\nASCII\n\nDATASET POLYDATA\nPOINTS {} double\n{}LINES {} "
        "{}\n{}\nCELL_DATA {}\n"
        "\nSCALARS id1 double 1\nLOOKUP_TABLE default\n{}\nSCALARS id2 double 1\nLOOKUP_TABLE "
        "default\n{}\nVECTORS f double\n{}",
        2 * n, points, n, 3 * n, lines, n, first, second, force);
}

std::string plain_plate(const Recording& recording) {
    std::string text = "plate_z top_force\n";
    for (const Scan& scan : recording.scans) text += fmt::format("{} {}\n", scan.plate_z, scan.top_force());
    return text;
}

TEST_F(ImportTest, YadesVtkFilesOneAFrameWithWallsThatCountFirst) {
    std::vector<std::string> files{write("plate.txt", plain_plate(truth_))};
    for (const Scan& scan : truth_.scans) {
        files.push_back(write(fmt::format("y-spheres-{:04}.vtk", scan.frame), vtk_of_spheres(truth_, scan)));
        files.push_back(write(fmt::format("y-intrs-{:04}.vtk", scan.frame), vtk_of_interactions(scan)));
    }
    const auto tables = guess_tables(files, known_);
    ASSERT_EQ(tables.size(), 3u);
    EXPECT_EQ(of(tables, Role::contacts).word("id_offset", ""), "-6");
    EXPECT_EQ(of(tables, Role::contacts).walls.size(), 6u);
    EXPECT_EQ(of(tables, Role::contacts).word("fx", ""), "f_x");
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(ImportTest, ForcesOfWhichOnlyTheSizeIsKnown) {
    auto files = write_lab({});
    std::string text = "Zeit [s],id1,id2,force_N\n";
    for (const Scan& scan : truth_.scans)
        for (const Contact& c : scan.contacts)
            text += fmt::format(
                "{},{},{},{:.12g}\n", 0.5 * scan.frame, c.grain + 1,
                is_wall(c.partner) ? std::string(name(wall_of(c.partner))) : std::to_string(c.partner + 1),
                c.force.norm());
    write("kontakte.csv", text);
    const auto tables = guess_tables(files, known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(ImportTest, APlatesForceIsMeasuredByItsContacts) {
    auto files = write_lab({});
    std::string plate = lab_plate(truth_, {});
    write("kraft.csv", plate.replace(plate.find(" [mN]"), 5, ""));
    known_.materials.clear();  // no Hertz's law
    const auto tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::plate).word("force_unit", ""), "mN");
    EXPECT_THAT(unclear(tables), IsEmpty());
}

TEST_F(ImportTest, ATableOfNothingKnownMustBeNamed) {
    auto files = write_lab({});
    files.push_back(write("wetter.csv", "Tag;Regen;Wind\n1;2,5;3\n2;0;1\n"));
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                ::testing::ElementsAre(
                    ::testing::HasSubstr("role must be confirmed, got \"?aside\": its columns say nothing")));
}

}  // namespace
}  // namespace mcdem::test
