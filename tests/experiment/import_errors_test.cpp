// Tables and mappings that cannot be imported: told with file and line.
#include "experiment/import_fixture.h"

namespace mcdem::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(ImportTest, WrongRowsAreToldWithTheirLines) {
    const auto files = write_lab({});
    const auto tables = guess_tables(files, known_);
    const Mapping mapping = mapping_of(tables);
    const auto problems_with = [&](const std::string& name, const std::string& from, const std::string& to) {
        const std::string before = name == "kraft.csv"     ? lab_plate(truth_, {})
                                   : name == "koerner.csv" ? lab_grains(truth_, {})
                                                           : lab_contacts(truth_, {});
        std::string text = before;
        EXPECT_NE(text.find(from), std::string::npos) << from;
        write(name, text.replace(text.find(from), from.size(), to));
        const auto problems = problems_of([&] { import_tables(read_import_tables(mapping), known_); });
        write(name, before);
        return problems;
    };
    EXPECT_THAT(problems_with("kraft.csv", ";0;60,5", ";null;60,5"),
                ElementsAre("kraft.csv:2: Zeit [s] must be a finite number, got \"null\": leave the row out "
                            "where nothing was measured"));
    EXPECT_THAT(problems_with("kraft.csv", ";0,5;", ";-0,5;"),
                ElementsAre(HasSubstr("kraft.csv:3: frame must rise from row to row, got -0.5 after 0")));
    EXPECT_THAT(problems_with("koerner.csv", ";2;", ";1;"),
                ::testing::Contains(HasSubstr("koerner.csv:3: each grain must be there once in frame 0, got "
                                              "1 again: see frame in the mapping")));
    EXPECT_THAT(
        problems_with("kontakte.csv", "Boden", "Keller"),
        ElementsAre(HasSubstr(
            "partner must be a grain, or a wall that [table.walls] of the mapping names, got \"Keller\"")));
    EXPECT_THAT(problems_with("kontakte.csv", "Korn 1", "Korn 3"),
                ElementsAre(HasSubstr(
                    "kontakte.csv: must have the column \"Korn 1\" that the mapping names for grain")));
    std::string grains = lab_grains(truth_, {});
    write("koerner.csv", grains.substr(0, grains.rfind('\n', grains.size() - 2) + 1));
    EXPECT_THAT(problems_of([&] { import_tables(read_import_tables(mapping), known_); }),
                ElementsAre(HasSubstr("frame 3 must list the 36 grains of the first frame, got 35")));
    write("koerner.csv", grains);
    EXPECT_THAT(
        problems_of([&] {
            read_import_tables(
                parse_mapping("[[table]]\nrole = \"plate\"\nfiles = [\"none\", \"neither\"]\n", "m"));
        }),
        ElementsAre("none: must be a table, got no such file", "neither: must be a table, got no such file"));
}

TEST_F(ImportTest, WrongMappingsAreToldAtOnce) {
    const auto problems = [&](const std::string& text) {
        return problems_of([&] { parse_mapping(text, "m"); });
    };
    EXPECT_THAT(problems(""), ElementsAre("m: must hold at least one [[table]], got none"));
    EXPECT_THAT(problems("[[table]\n"), ElementsAre(HasSubstr("m:1: must be TOML, got")));
    EXPECT_THAT(problems("x = 1\n[[table]]\nrole = \"sand\"\nseparator = \"|\"\n"),
                ElementsAre("m:1: \"x\" must be a list of tables, [[table]], got something else",
                            "m:3: role must be one of plate, grains, contacts, aside, got \"sand\"",
                            "m:2: files must name at least one file, got none",
                            "m:4: separator must be one of \",\", \";\", tab, blanks, got \"|\""));
    EXPECT_THAT(problems("[[table]]\nrole = \"grains\"\nfiles = [\"a\"]\nx = 3\nlength_unit = "
                         "\"ft\"\norigin_x = \"left\"\nfx = \"f\"\ndiameter = [\"a\", \"b\"]\n"),
                ElementsAre("m:8: diameter must be one text, got 2",
                            HasSubstr("m:7: \"fx\" must be a key of a table of grains, got another"),
                            "m:5: length_unit must be one of m cm mm um, got \"ft\"",
                            "m:6: origin_x must be a number in quotes, got \"left\"",
                            HasSubstr("m:4: \"x\" must be a text, or a list of texts")));
    EXPECT_THAT(problems("[[table]]\nrole = \"contacts\"\nfiles = [\"a\"]\n[table.walls]\n1 = \"roof\"\n"),
                ElementsAre("m:5: a wall must be one of x_min, x_max, y_min, y_max, floor, plate, by "
                            "direction, got \"roof\""));
}

TEST_F(ImportTest, UnitsAndSignsMustBeStated) {
    const auto problems = [&](const std::string& text) {
        return problems_of([&] { parse_mapping("[[table]]\nfiles = [\"a\"]\n" + text, "m"); });
    };
    EXPECT_THAT(problems("role = \"plate\"\nplate_z = \"h\"\ntop_force = \"F\"\n"),
                ElementsAre("m:1: length_unit must be stated, one of m cm mm um, got none",
                            "m:1: force_unit must be stated, one of N mN uN kN cN daN gf kgf lbf, got none",
                            HasSubstr("m:1: force_sign must be stated, one of + -: +: upward force")));
    EXPECT_THAT(problems("role = \"grains\"\nx = \"h\"\n"), ElementsAre(HasSubstr("length_unit must")));
    EXPECT_THAT(problems("role = \"contacts\"\nfx = \"F\"\n"),
                ElementsAre(HasSubstr("force_unit must"),
                            HasSubstr("force_on must be stated, one of grain partner: on which")));
    EXPECT_THAT(problems("role = \"contacts\"\nforce = \"F\"\nx = \"x\"\n"),
                ElementsAre(HasSubstr("length_unit must"), HasSubstr("force_unit must")));
}

TEST_F(ImportTest, WhatWrongRowsHideIsUnclear) {
    const auto files = write_lab({';', '.', false, 1e3, 1e3});
    std::string grains = lab_grains(truth_, {';', '.', false, 1e3, 1e3});
    const auto cell = grains.find('\n') + 1;
    write("koerner.csv", grains.replace(cell, grains.find(';', cell) - cell, "NaN"));
    const auto tables = guess_tables(files, known_);
    for (const std::string key : {"id_offset", "force_on", "length_unit", "force_unit"})
        EXPECT_EQ(mapping_of(tables).tables[2].find(key)->sure, Sure::unclear) << key;
    EXPECT_THAT(wrong_rows(tables), ::testing::Contains(HasSubstr("must be a finite number, got \"NaN\"")));
}

TEST_F(ImportTest, WhatIsMissingIsTold) {
    EXPECT_THAT(problems_of([&] { import_tables(guess_tables({write_lab({})[1]}, known_), known_); }),
                ElementsAre(HasSubstr(
                    "plate: must be one table with the plate's position and force by frame, got 0")));
    EXPECT_THAT(problems_of([&] {
                    guess_tables({(folder_ / "a").string(), (folder_ / "b").string()}, known_);
                }),
                ::testing::SizeIs(2));
}

TEST_F(ImportTest, NothingAndMissingGrainsAreNoWalls) {
    const auto files = write_lab({});
    const std::string contacts = lab_contacts(truth_, {}), grains = lab_grains(truth_, {});
    std::string text = contacts;
    write("kontakte.csv", text.replace(text.find("Boden"), 5, "NaN"));
    const auto tables = guess_tables(files, known_);
    EXPECT_FALSE(of(tables, Role::contacts).walls.contains("NaN"));
    EXPECT_THAT(problems_of([&] { import_tables(tables, known_); }),
                ElementsAre(HasSubstr("partner must be a grain, or a wall")));
    write("kontakte.csv", contacts);
    std::string fewer;
    for (std::size_t first = 0; first < grains.size(); first = grains.find('\n', first) + 1)
        if (const std::string line = grains.substr(first, grains.find('\n', first) + 1 - first);
            line.find(";17;") == line.npos)
            fewer += line;
    write("koerner.csv", fewer);
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                Contains(HasSubstr("\"17\" must be confirmed, got \"?by direction\"")));
}

TEST_F(ImportTest, UnitsThatAreNotKnownMustBeConfirmed) {
    const auto files = write_lab({});
    std::string text = lab_plate(truth_, {});
    write("kraft.csv", text.replace(text.find("[mN]"), 4, "[MPa]"));
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                Contains(HasSubstr("a name says [MPa], which is none of")));
}

TEST_F(ImportTest, WhatIsNotANumberInThePlatesTableIsNamedByItsLine) {
    const auto files = write_lab({});
    for (const std::string nothing : {"NaN", "nan", "inf", "", "-"})
        for (const bool units : {true, false}) {
            std::string text = lab_plate(truth_, {';', ',', units, 1e3, 1e3});
            const auto second = text.find('\n', text.find('\n') + 1) + 1,
                       cell = text.rfind(';', text.find('\n', second)) + 1;
            write("kraft.csv", text.replace(cell, text.find('\n', cell) - cell, nothing));
            const auto tables = guess_tables(files, known_);
            EXPECT_THAT(wrong_rows(tables), ElementsAre(HasSubstr("kraft.csv:3: Hoehe"))) << nothing;
        }
}

TEST_F(ImportTest, ColumnsOfTextAreNotTakenForNumbersByTheirPlace) {
    const auto tables =
        guess_tables({write("a.csv", "load;60,5;start;0\nload;59,5;;0,3\nunload;60;ende;0,1\n")}, known_);
    const MappedTable& plate = of(tables, Role::plate);
    EXPECT_EQ(plate.word("plate_z", ""), "column 2");
    EXPECT_EQ(plate.word("top_force", ""), "column 4");
    EXPECT_EQ(guess_tables({write("b.csv", "load;a;1,5\nload;b;2,5\n")}, known_).front().map.role,
              Role::aside);
}

TEST_F(ImportTest, CommasThatMayPartThousandsMustBeConfirmed) {
    auto files = write_lab({});
    std::string text = "Hoehe [mm];Kraft [mN]\n";
    for (const Scan& scan : truth_.scans)
        text += fmt::format("{},{:03};{}\n", static_cast<int>(1e3 * scan.plate_z),
                            static_cast<int>(1e6 * scan.plate_z) % 1000,
                            static_cast<int>(1e3 * scan.top_force()));
    files[0] = write("kraft.csv", text);
    auto problems = unclear(guess_tables(files, known_));
    EXPECT_THAT(
        problems,
        ElementsAre(HasSubstr("decimal must be confirmed, got \"?,\": every comma has three digits")));
}

TEST_F(ImportTest, UmlautsAreLetters) {
    const auto files = write_lab({});
    std::string text = lab_plate(truth_, {});
    write("kraft.csv", text.replace(text.find("Hoehe"), 5, "H\xC3\xB6he"));
    EXPECT_THAT(unclear(guess_tables(files, known_)), ::testing::IsEmpty());
}

}  // namespace
}  // namespace mcdem::test
