// Experiments made of other tables: what is guessed, when it is not safe, and that it comes out right.
#include "experiment/import_fixture.h"

namespace mcdem::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(ImportTest, AGermanLaboratorysTablesWithUnitsAreSafe) {
    const auto tables = guess_tables(write_lab({}), known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    EXPECT_EQ(of(tables, Role::grains).word("length_unit", ""), "mm");
    EXPECT_EQ(of(tables, Role::grains).form, (TextForm{';', ','}));
    EXPECT_EQ(of(tables, Role::contacts).walls.at("Boden").word(), "floor");
    EXPECT_EQ(of(tables, Role::contacts).walls.at("Boden").why, "its name");
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(ImportTest, UnitsThatNobodyNamesComeFromBoxAndStiffness) {
    const auto tables = guess_tables(write_lab({'\t', '.', false, 1e3, 1e3}), known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    for (const Role role : {Role::plate, Role::grains, Role::contacts})
        EXPECT_EQ(of(tables, role).word("length_unit", ""), "mm");
    EXPECT_EQ(of(tables, Role::plate).word("force_unit", ""), "mN");
    EXPECT_EQ(of(tables, Role::contacts).word("force_unit", ""), "mN");
    expect_truth(import_tables(tables, known_).experiment.recording);
    const auto metres = guess_tables(write_lab({',', '.', false, 1, 1 / 9.80665e-3}), known_);
    EXPECT_EQ(of(metres, Role::grains).word("length_unit", ""), "m");
    EXPECT_EQ(of(metres, Role::plate).word("force_unit", ""), "gf");
}

TEST_F(ImportTest, WithoutScaleUnitsMustBeConfirmed) {
    const auto files = write_lab({';', ',', false, 1e3, 1e3});
    Experiment nothing;
    nothing.recording.box = {0, 0};
    const auto tables = guess_tables(files, nothing);
    const auto problems = unclear(tables);
    EXPECT_THAT(
        problems,
        ::testing::Contains(HasSubstr(
            "length_unit must be confirmed, got \"?mm\": no name says it, and the box is not known")));
    EXPECT_THAT(problems, ::testing::Contains(HasSubstr("force_unit must be confirmed")));
    // As it is written it is refused, line by line; confirmed it is read.
    std::string text = mapping_text(mapping_of(tables));
    EXPECT_THAT(problems_of([&] { parse_mapping(text, "m"); }),
                ::testing::Contains(::testing::MatchesRegex(
                    "m:[0-9]+: length_unit must be confirmed, got \"\\?mm\": put in what is right, .*")));
    for (const auto& [from, to] :
         {std::pair{"\"?mm\"", "\"mm\""}, std::pair{"\"?N\"", "\"mN\""}, std::pair{"\"?m\"", "\"mm\""}})
        for (auto at = text.find(from); at != std::string::npos; at = text.find(from))
            text.replace(at, std::string(from).size(), to);
    const auto read = read_import_tables(parse_mapping(text, "m"));
    expect_truth(import_tables(read, known_).experiment.recording);
}

TEST_F(ImportTest, NamesThatContradictTheNumbersMustBeConfirmed) {
    auto files = write_lab({});
    std::string text = lab_grains(truth_, {});
    for (auto at = text.find("[mm]"); at != std::string::npos; at = text.find("[mm]"))
        text.replace(at, 4, "[cm]");
    write("koerner.csv", text);
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                ::testing::Contains(
                    HasSubstr("length_unit must be confirmed, got \"?cm\": the columns' names say so, but")));
    text = lab_grains(truth_, {});
    write("koerner.csv", text.replace(text.find("Radius"), 6, "Durchmesser"));
    EXPECT_THAT(unclear(guess_tables(files, known_)), ::testing::Contains(HasSubstr("is it the radius?")));
}

TEST_F(ImportTest, DumpsWithoutTellingNamesAreToldByTheirNumbers) {
    std::string plate = "step,plate_z_m,force_N\n";
    for (const Scan& scan : truth_.scans)
        plate += fmt::format("{},{},{}\n", 100 * scan.frame, scan.plate_z, scan.top_force());
    const std::vector<std::string> files{write("pairs.dump", dump_of_contacts(truth_, false)),
                                         write("grains.dump", dump_of_grains(truth_)),
                                         write("plate.csv", plate)};
    const auto tables = guess_tables(files, known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    const MappedTable& contacts = of(tables, Role::contacts);
    EXPECT_EQ(contacts.word("grain", ""), "c_p[1]");
    EXPECT_EQ(contacts.word("partner", ""), "c_p[2]");
    EXPECT_EQ(contacts.word("fx", ""), "c_p[4]");
    Recording pairs_only = truth_;
    for (Scan& scan : pairs_only.scans)
        std::erase_if(scan.contacts, [](const Contact& c) { return is_wall(c.partner); });
    truth_ = pairs_only;
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(ImportTest, WallsOfAProgramAreNamedInTheMapping) {
    std::string plate = "step,plate_z_m,force_N\n";
    for (const Scan& scan : truth_.scans)
        plate += fmt::format("{},{},{}\n", 100 * scan.frame, scan.plate_z, scan.top_force());
    write("plate.csv", plate);
    write("grains.dump", dump_of_grains(truth_));
    write("pairs.dump", dump_of_contacts(truth_, false));
    write("walls.dump", dump_of_contacts(truth_, true));
    const std::string path = folder_.string();
    const auto text = fmt::format(R"([[table]]
role = "plate"
files = ["{0}/plate.csv"]
frame = "step"
plate_z = "plate_z_m"
top_force = "force_N"
length_unit = "m"
force_unit = "N"
force_sign = "+"
[[table]]
role = "grains"
files = ["{0}/grains.dump"]
grain = "id"
x = "x"
y = "y"
z = "z"
radius = "radius"
length_unit = "m"
[[table]]
role = "contacts"
files = ["{0}/pairs.dump"]
grain = "c_p[1]"
partner = "c_p[2]"
fx = "c_p[4]"
fy = ["c_p[5]", "c_p[3]"]
fz = "c_p[6]"
force_unit = "N"
force_on = "grain"
[[table]]
role = "contacts"
files = ["{0}/walls.dump"]
grain = "c_p[3]"
partner = "c_p[1]"
fx = "c_p[4]"
fy = "c_p[5]"
fz = "c_p[6]"
force_unit = "N"
force_on = "grain"
[table.walls]
0 = "x_min"
1 = "by direction"
2 = "y_min"
3 = "y_max"
4 = "floor"
5 = "plate"
)",
                                  path);
    expect_truth(import_tables(read_import_tables(parse_mapping(text, "m")), known_).experiment.recording);
}

TEST_F(ImportTest, OnWhomAForceIsAndBothSidesAreSeen) {
    const auto files = write_lab({});
    Recording turned = truth_;
    for (Scan& scan : turned.scans)
        for (Contact& contact : scan.contacts) contact.force = -contact.force;
    write("kontakte.csv", lab_contacts(turned, {}));
    auto tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::contacts).word("force_on", ""), "partner");
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
    Recording both = truth_;
    for (Scan& scan : both.scans)
        for (const Contact& contact : truth_.scans[static_cast<std::size_t>(scan.frame)].contacts)
            if (!is_wall(contact.partner))
                scan.contacts.push_back({contact.partner, contact.grain, contact.point, -contact.force, 0});
    write("kontakte.csv", lab_contacts(both, {}));
    tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::contacts).word("sides", ""), "both");
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(ImportTest, NumbersFromZeroBesideNumbersFromOneAreSeen) {
    auto files = write_lab({});
    std::string text = "Zeit [s],id1,id2,fx_mN,fy_mN,fz_mN\n";
    for (const Scan& scan : truth_.scans)
        for (const Contact& c : scan.contacts)
            if (!is_wall(c.partner))
                text += fmt::format("{},{},{},{},{},{}\n", 0.5 * scan.frame, c.grain, c.partner,
                                    1e3 * c.force.x(), 1e3 * c.force.y(), 1e3 * c.force.z());
    write("kontakte.csv", text);
    const auto tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::contacts).word("id_offset", ""), "1");
    EXPECT_THAT(unclear(tables), IsEmpty());
    EXPECT_EQ(import_tables(tables, known_).experiment.recording.scans[3].contacts.front().grain,
              truth_.scans[3].contacts.front().grain);
}

TEST_F(ImportTest, GrainsWithoutNamesAreToldByTheirTouching) {
    std::string text;
    for (std::size_t i = 0; i < 36; ++i) {
        const Vec3& at = truth_.scans[0].position[i];
        text +=
            fmt::format("{:.6g}\t{:.6g}\t{:.6g}\t{:.6g}\n", at.x(), at.y(), at.z(), truth_.diameter[i] / 2);
    }
    const auto tables = guess_tables({write("pack.txt", text)}, known_);
    EXPECT_EQ(tables.front().map.role, Role::grains);
    EXPECT_EQ(tables.front().map.word("radius", ""), "column 4");
    EXPECT_EQ(tables.front().map.word("length_unit", ""), "m");
    EXPECT_THAT(unclear(tables), IsEmpty());
}

TEST_F(ImportTest, FilesThatAreAlikeAreFramesInTheOrderOfTheirNumbers) {
    std::vector<std::string> files{write_lab({})[0]};
    for (const int f : {6, 5, 4, 3, 2, 1, 0}) {
        std::string text = "id;x_m;y_m;z_m;diameter_m\n";
        for (std::size_t i = 0; i < 36; ++i) {
            const Vec3& at = truth_.scans[static_cast<std::size_t>(f)].position[i];
            text += fmt::format("{};{};{};{};{}\n", i, at.x(), at.y(), at.z(), truth_.diameter[i]);
        }
        files.push_back(write(fmt::format("grains{}.csv", f + 5), text));
    }
    const auto tables = guess_tables(files, known_);
    EXPECT_EQ(tables.size(), 2u);
    EXPECT_EQ(of(tables, Role::grains).word("frames_by", ""), "order");
    for (Scan& scan : truth_.scans) scan.contacts.clear();
    expect_truth(import_tables(tables, known_).experiment.recording);
}

TEST_F(ImportTest, DisplacementsCyclesAndEarlyRowsOfThePlate) {
    std::string plate = "t,displacement_mm,force_N\n-1,-0.1,0\n";
    for (const Scan& scan : truth_.scans)
        plate +=
            fmt::format("{},{},{}\n", 0.5 * scan.frame, 1e3 * (0.0605 - scan.plate_z), -scan.top_force());
    plate += "3.5,4,-1\n4,0.1,0\n";
    std::string grains = lab_grains(truth_, {',', '.', true, 1e3, 1e3});
    const std::vector<std::string> files{
        write("plate.csv", plate), write("grains.csv", grains.replace(grains.find("Zeit [s]"), 8, "t [s]"))};
    known_.recording.plate_start = 0.0605;
    const auto tables = guess_tables(files, known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    EXPECT_EQ(of(tables, Role::plate).word("force_sign", ""), "-");
    const Imported imported = import_tables(tables, known_);
    EXPECT_THAT(imported.notes,
                ElementsAre("the plate's first 1 rows are left out: grains are known from then on"));
    const auto& scans = imported.experiment.recording.scans;
    ASSERT_EQ(scans.size(), 9u);
    EXPECT_NEAR(scans[3].plate_z, truth_.scans[3].plate_z, 1e-12);
    EXPECT_NEAR(scans[3].top_force(), truth_.scans[3].top_force(), 1e-12);
    EXPECT_EQ(scans[6].cycle, 0);
    EXPECT_EQ(scans[7].cycle, 1) << "down again";
    EXPECT_EQ(scans[7].phase, Phase::load);
    EXPECT_EQ(scans[8].phase, Phase::unload);
    known_.recording.plate_start = std::nan("");
    EXPECT_THAT(problems_of([&] { import_tables(tables, known_); }),
                ElementsAre(HasSubstr("plate.csv: displacements count downwards from plate.start")));
}

TEST_F(ImportTest, AMappingServesOtherFiles) {
    const auto tables = guess_tables(write_lab({}), known_);
    const Mapping mapping = parse_mapping(mapping_text(mapping_of(tables)), "m");
    ASSERT_EQ(mapping.tables.size(), tables.size());
    for (std::size_t t = 0; t < tables.size(); ++t)
        for (const auto& [key, guess] : tables[t].map.entries)
            EXPECT_EQ(mapping.tables[t].find(key)->words, guess.words) << key;
    for (Scan& scan : truth_.scans) scan.plate_z += 1e-4;
    const auto others = read_import_tables(
        mapping, {write("c2", lab_contacts(truth_, {})), write("p2", lab_plate(truth_, {})),
                  write("g2", lab_grains(truth_, {}))});
    expect_truth(import_tables(others, known_).experiment.recording);
    EXPECT_THAT(problems_of([&] { read_import_tables(mapping, {write("odd", "a,b\n1,2\n")}); }),
                ElementsAre("odd: must have the columns of a table of the mapping, got others"));
    EXPECT_THAT(problems_of([&] {
                    read_import_tables(
                        mapping, {write("p3", lab_plate(truth_, {})), write("g3", lab_grains(truth_, {}))});
                }),
                ElementsAre(HasSubstr("the table of contacts, kontakte.csv there, must have a file too, got "
                                      "none among those given: give it, or remove the table")));
}

}  // namespace
}  // namespace mcdem::test
