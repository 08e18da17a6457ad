// Tables whose z points downwards: turned round where that is certain, refused where it is not.
#include <regex>

#include "experiment/import_fixture.h"

namespace mcdem::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// The same with z counted downwards from `begin` [m].
Recording downwards(Recording recording, double begin) {
    for (Scan& scan : recording.scans) {
        scan.plate_z = begin - scan.plate_z;
        for (Vec3& at : scan.position) at.z() = begin - at.z();
        for (Contact& contact : scan.contacts) {
            contact.point.z() = begin - contact.point.z();
            contact.force.z() *= -1;
        }
    }
    return recording;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

class UpwardsTest : public ImportTest {
protected:
    /// The laboratory's tables, those named counted downwards.
    std::vector<std::string> write_downwards(double begin, const std::set<std::string>& which) {
        const Recording turned = downwards(truth_, begin);
        const auto of = [&](const std::string& name) -> const Recording& {
            return which.contains(name) ? turned : truth_;
        };
        return {write("kraft.csv", lab_plate(of("plate"), {})),
                write("koerner.csv", lab_grains(of("grains"), {})),
                write("kontakte.csv", lab_contacts(of("contacts"), {}))};
    }
};

TEST_F(UpwardsTest, DownwardsFromTheFloorIsSeen) {
    const auto tables = guess_tables(write_downwards(0, {"plate", "grains", "contacts"}), known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    EXPECT_EQ(of(tables, Role::plate).word("plate_z", ""), "-Hoehe [mm]");
    EXPECT_EQ(of(tables, Role::grains).word("z", ""), "-z [mm]");
    EXPECT_EQ(of(tables, Role::contacts).word("z", ""), "-z [mm]");
    EXPECT_EQ(of(tables, Role::contacts).word("fz", ""), "-fz [mN]");
    EXPECT_THAT(of(tables, Role::grains).aside, IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
    const auto again = read_import_tables(parse_mapping(mapping_text(mapping_of(tables)), "m"));
    expect_truth(import_tables(again, known_).experiment.recording);
}

TEST_F(UpwardsTest, DownwardsFromThePlateMustBeConfirmed) {
    const auto files = write_downwards(0.0605, {"plate", "grains", "contacts"});
    const auto tables = guess_tables(files, known_);
    EXPECT_THAT(unclear(tables),
                AllOf(Contains(AllOf(HasSubstr("z must be confirmed, got \"?-z [mm]\""),
                                     HasSubstr("gives way at its lower end: is z downwards?"))),
                      Contains(HasSubstr("origin_z must be confirmed, got \"?6"))));
    std::string text = mapping_text(mapping_of(tables));
    replace_all(text, "\"?", "\"");
    text = std::regex_replace(text, std::regex("\norigin_z = \"[0-9.]+\""), "\norigin_z = \"60.5\"");
    for (const auto& line : {"z = \"-z [mm]\"", "fz = \"-fz [mN]\"", "plate_z = \"-Hoehe [mm]\""})
        EXPECT_THAT(text, HasSubstr(line));
    expect_truth(import_tables(read_import_tables(parse_mapping(text, "m")), known_).experiment.recording);
}

TEST_F(UpwardsTest, OneTableMayBeDownwardsBesideOthersThatAreNot) {
    auto tables = guess_tables(write_downwards(0, {"plate"}), known_);
    EXPECT_EQ(of(tables, Role::plate).word("plate_z", ""), "-Hoehe [mm]");
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
    EXPECT_THAT(unclear(guess_tables({write_downwards(0, {"plate"})[0]}, known_)),
                ElementsAre(HasSubstr("where is the floor, as Hoehe [mm] counts?")))
        << "without grains";
    EXPECT_THAT(unclear(guess_tables(write_downwards(-0.03, {"plate"}), known_)),
                Contains(HasSubstr("origin_z must be confirmed")));
    tables = guess_tables(write_downwards(0, {"contacts"}), known_);
    EXPECT_EQ(of(tables, Role::contacts).word("fz", ""), "-fz [mN]");
    EXPECT_EQ(of(tables, Role::contacts).word("z", ""), "-z [mm]");
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(UpwardsTest, NamesSayItAndWallsTurnRoundToo) {
    auto files = write_downwards(0, {"plate", "grains", "contacts"});
    std::string grains = lab_grains(downwards(truth_, 0), {}),
                contacts = lab_contacts(downwards(truth_, 0), {});
    replace_all(grains, ";z [mm]", ";Tiefe [mm]");
    replace_all(contacts, "Deckel", "zmin");
    replace_all(contacts, "Boden", "zmax");
    write("koerner.csv", grains);
    write("kontakte.csv", contacts);
    const auto tables = guess_tables(files, known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    EXPECT_EQ(of(tables, Role::grains).find("z")->why, "its name says downwards");
    EXPECT_EQ(of(tables, Role::contacts).walls.at("zmin").word(), "plate");
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(UpwardsTest, OneFrameBelowZeroMayBeEither) {
    for (Scan& scan : truth_.scans)
        if (scan.frame > 0) scan.position.clear();
    const auto files = write_downwards(0, {"plate", "grains", "contacts"});
    EXPECT_THAT(
        unclear(guess_tables({files[0], files[1]}, known_)),
        Contains(AllOf(HasSubstr("z must be confirmed, got \"?-z [mm]\""), HasSubstr("is z downwards?"))));
}

TEST_F(UpwardsTest, DisplacementsThatCountUpwardsAreTurnedRound) {
    std::string plate = "Zeit [s],displacement_mm,force_N\n";
    for (const Scan& scan : truth_.scans)
        plate +=
            fmt::format("{},{},{}\n", 0.5 * scan.frame, -1e3 * (0.0605 - scan.plate_z), scan.top_force());
    auto files = write_lab({});
    write("kraft.csv", plate);
    known_.recording.plate_start = 0.0605;
    const auto tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::plate).word("displacement", ""), "-displacement_mm");
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(UpwardsTest, SignsStandBeforeColumnsOfQuantitiesOnly) {
    const auto problems = [&](const std::string& text) {
        return problems_of([&] { parse_mapping("[[table]]\nfiles = [\"a\"]\n" + text, "m"); });
    };
    const std::string grains = "role = \"grains\"\nlength_unit = \"m\"\nx = \"-x\"\n";
    EXPECT_THAT(problems(grains), IsEmpty());
    EXPECT_THAT(problems(grains + "radius = \"-r\"\n"),
                ElementsAre("m:6: radius must be a column without a sign, got \"-r\""));
    EXPECT_THAT(problems(grains + "grain = \"-id\"\n"), SizeIs(1));
    EXPECT_THAT(problems(grains + "z = \"-\"\n"), ElementsAre("m:6: z must be a column, got a sign only"));
    EXPECT_THAT(problems("role = \"plate\"\nforce_sign = \"-\"\n"), IsEmpty());
}

TEST_F(UpwardsTest, WallsOfATurnedAxisMustBeNamed) {
    auto files = write_lab({});
    std::string contacts = lab_contacts(truth_, {});
    replace_all(contacts, "links", "x_min");
    write("kontakte.csv", contacts);
    Mapping mapping = mapping_of(guess_tables(files, known_));
    for (MappedTable& table : mapping.tables)
        if (table.role == Role::grains) {
            table.entries["x"].words = {"-x [mm]"};
            table.entries["origin_x"].words = {"60"};
        }
    EXPECT_THAT(problems_of([&] { import_tables(read_import_tables(mapping), known_); }),
                ElementsAre(HasSubstr("x_min must be named in [table.walls] where x is turned round")));
}

TEST_F(UpwardsTest, SeveralColumnsHaveSignsOfTheirOwn) {
    auto files = write_lab({});
    Mapping mapping = mapping_of(guess_tables(files, known_));
    for (MappedTable& table : mapping.tables)
        if (table.role == Role::contacts) table.entries["fz"].words = {"fz [mN]", "fx [mN]", "-fx [mN]"};
    expect_truth(import_tables(read_import_tables(mapping), known_).experiment.recording);
}

}  // namespace
}  // namespace mcdem::test
