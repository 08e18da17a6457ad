"""Tables and mappings that cannot be imported: errors name file and line."""
import unittest

from lab import ImportCase, Style, lab_contacts, lab_grains, lab_plate
from mcdem.importing.guess import guess_tables, mapping_of, wrong_rows
from mcdem.importing.mapping import Guess, mapping_text
from mcdem.importing.read_mapping import parse_mapping


GRAINS = '[[table]]\nfiles = ["a"]\nrole = "grains"\nlength_unit = "m"\nx = "-x"\n'
LENGTH_UNIT = "length_unit must be stated: one of m, cm, mm, um, voxel"
FORCE_UNIT = "force_unit must be stated: one of N, mN, uN, kN, cN, daN, gf, kgf, lbf"
PLATE_UNIT = FORCE_UNIT + ", Pa, hPa, kPa, MPa, GPa, bar, mbar, psi, ksi, atm, torr, mmHg, N/mm2, N/cm2, N/m2, kN/m2, kN/mm2, mN/mm2, kgf/mm2, kgf/cm2, gf/cm2"
# A mapping, and its problems.
MAPPINGS = (
    ("", [" must hold at least one [[table]], got none"]),
    ('x = 1\n[[table]]\nrole = "sand"\nseparator = "|"\n', [
        '1: "x" must be a list of tables, [[table]], got something else',
        '3: role must be one of "plate" "grains" "contacts" "unused", got "sand"',
        "2: files must name at least one file, got none",
        '4: separator must be one of "," ";" "tab" "blanks", got "|"']),
    ('[[table]]\nrole = "grains"\nfiles = ["a"]\nx = 3\nlength_unit = "ft"\norigin_x = "left"\nfx = "f"\ndiameter = ["a", "b"]\n', [
        '4: "x" must be a text, or a list of texts, got something else',
        '5: length_unit must be one of "m" "cm" "mm" "um" "voxel", got "ft"',
        '6: origin_x must be a number in quotes, got "left"',
        '7: "fx" must be a key of a table of grains, got another: remove it, or choose from frame, frames_by, grain, labels, first_grain, where, x, '
        "y, z, diameter, radius, volume, size_factor, same_diameter, length_unit, voxel_size, origin_x, origin_y, origin_z",
        "8: diameter must be one text, got 2"]),
    ('[[table]]\nrole = "contacts"\nfiles = ["a"]\n[table.walls]\n1 = "roof"\n', [
        '5: a wall must be one of "x_min" "x_max" "y_min" "y_max" "floor" "plate" "by direction", got "roof"']),
    ('[[table]]\nrole = "contacts"\nfiles = ["a"]\nwalls = 3\n', ["4: walls must be a table, [table.walls], got something else"]),
    # units and signs
    ('[[table]]\nfiles = ["a"]\nrole = "plate"\nplate_z = "h"\ntop_force = "F"\n', [
        f"1: {LENGTH_UNIT}, got none", f"1: {PLATE_UNIT}, got none",
        "1: force_sign must be stated: one of +, -; +: upward force on the plate is positive; -: negative, got none"]),
    ('[[table]]\nfiles = ["a"]\nrole = "grains"\nx = "h"\n', [f"1: {LENGTH_UNIT}, got none"]),
    ('[[table]]\nfiles = ["a"]\nrole = "grains"\nx = "h"\nlength_unit = "voxel"\n', [
        "1: voxel_size must be stated: edge of a voxel [m], where length_unit is voxel, got none"]),
    ('[[table]]\nfiles = ["a"]\nrole = "grains"\nx = "h"\nlength_unit = "voxel"\nvoxel_size = "0"\n', [
        '6: voxel_size must be > 0 [m], got "0"']),
    ('[[table]]\nfiles = ["a"]\nrole = "contacts"\nfx = "F"\n', [
        f"1: {FORCE_UNIT}, got none", "1: force_on must be stated: one of grain, partner; on which of the two the force is, got none"]),
    ('[[table]]\nfiles = ["a"]\nrole = "contacts"\nforce = "F"\nx = "x"\n', [
        f"1: {LENGTH_UNIT}; of contact points, got none", f"1: {FORCE_UNIT}, got none"]),
    # signs stand before columns of quantities only
    (GRAINS, []),
    (GRAINS + 'radius = "-r"\n', ['6: radius must be a column without a sign, got "-r"']),
    (GRAINS + 'grain = "-id"\n', ['6: grain must be a column without a sign, got "-id"']),
    (GRAINS + 'z = "-"\n', ["6: z must be a column, got a sign only"]),
    ('[[table]]\nfiles = ["a"]\nrole = "plate"\nforce_sign = "-"\n', []))


class Errors(ImportCase):
    def test_invalid_rows_are_reported_with_line_numbers(self):
        self.write_lab()
        mapping = mapping_text(mapping_of(self.guess([self.path(name) for name in ("kraft.csv", "koerner.csv", "kontakte.csv")])))
        texts = {"kraft.csv": lab_plate(self.truth), "koerner.csv": lab_grains(self.truth), "kontakte.csv": lab_contacts(self.truth)}

        def problems_with(name, wrong, right):
            self.assertIn(wrong, texts[name])
            self.write(name, texts[name].replace(wrong, right, 1))
            problems = self.problems_of(lambda: self.imported(self.by_mapping(mapping)))
            self.write(name, texts[name])
            return problems

        self.assertEqual(problems_with("kraft.csv", ";0;60,5", ";null;60,5"),
                         ['kraft.csv:2: Zeit [s] must be a finite number, got "null": leave out what was not measured: a row of the plate, a contact, or the whole frame of grains'])
        self.expect_one(problems_with("kraft.csv", ";0,5;", ";-0,5;"), "kraft.csv:3: frame must rise from row to row, got -0.5 after 0")
        self.expect_among(problems_with("koerner.csv", ";2;", ";1;"),
                          "koerner.csv:3: each grain must be there once in frame 0, got 1 again: see frame in the mapping")
        self.expect_one(problems_with("kontakte.csv", "Boden", "Keller"),
                        'partner must be a grain, or a wall that [table.walls] of the mapping names, got "Keller"')
        self.expect_one(problems_with("kontakte.csv", "Korn 1", "Korn 3"),
                        'kontakte.csv: must have the column "Korn 1" that the mapping names for grain')
        lines = texts["koerner.csv"].splitlines(keepends=True)
        self.expect_one(problems_with("koerner.csv", lines[-1], ""), "frame 3 must list the 36 grains of the first frame, got 35")
        self.assertEqual(self.problems_of(lambda: self.by_mapping('[[table]]\nrole = "plate"\nfiles = ["none", "neither"]\n')),
                         ["none: must be a table, got no such file", "neither: must be a table, got no such file"])

    def test_all_errors_of_a_mapping_are_reported_together(self):
        for text, expected in MAPPINGS:
            with self.subTest(text):
                self.assertEqual(self.problems_of(lambda: parse_mapping(text, "m")), [f"m:{problem}" for problem in expected])

    def test_a_mapping_that_is_no_toml_has_its_line(self):
        self.expect_one(self.problems_of(lambda: parse_mapping("[[table]\n", "m")), "m:1: must be TOML, got: Expected")

    def test_what_wrong_rows_hide_is_unclear(self):
        style = Style(";", ".", False)
        files = self.write_lab(style)
        lines = lab_grains(self.truth, style).splitlines()
        lines[1] = "NaN" + lines[1][lines[1].index(";"):]
        self.write("koerner.csv", "\n".join(lines) + "\n")
        tables = self.guess(files)
        contacts = mapping_of(tables)[2]
        for key in ("id_offset", "force_on", "length_unit", "force_unit"):
            self.assertEqual(contacts[key].certainty, "unclear", key)
        self.expect_among(wrong_rows(tables), 'must be a finite number, got "NaN"')

    def test_a_table_of_grains_must_have_one(self):
        tables = self.guess(self.write_lab())
        self.of(tables, "grains")["where"] = Guess(["Guete"])
        text = mapping_text(mapping_of(tables))
        header, *rows = lab_grains(self.truth).splitlines()
        self.write("koerner.csv", "\n".join([header + ";Guete", *(row + ";0" for row in rows), ""]))
        self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(text))),
                        "koerner.csv: must have grains, got 0 in all rows of the column for where")

    def test_missing_tables_are_reported(self):
        self.expect_one(self.problems_of(lambda: self.imported(self.guess(self.write_lab()[1:2]))),
                        "plate: must be one table with the plate's position and force by frame, got 0")
        self.assertEqual(len(self.problems_of(lambda: self.guess([self.path("a"), self.path("b")]))), 2)

    def test_nothing_and_missing_grains_are_no_walls(self):
        files, contacts = self.write_lab(), lab_contacts(self.truth)
        self.write("kontakte.csv", contacts.replace("Boden", "NaN", 1))
        tables = self.guess(files)
        self.assertNotIn("NaN", self.of(tables, "contacts").walls)
        self.expect_one(self.problems_of(lambda: self.imported(tables)), "partner must be a grain, or a wall")
        self.write("kontakte.csv", contacts)
        self.write("koerner.csv", "".join(line for line in lab_grains(self.truth).splitlines(keepends=True) if ";17;" not in line))
        self.expect_among(self.unclear(self.guess(files)), '"17" must be confirmed, got "?by direction"')

    def test_what_is_not_a_number_in_the_plates_table_is_named_by_its_line(self):
        files = self.write_lab()
        for nothing in ("NaN", "nan", "inf", "", "-"):
            for units in (True, False):
                lines = lab_plate(self.truth, Style(named=units)).splitlines()
                lines[2] = lines[2][:lines[2].rindex(";") + 1] + nothing
                self.write("kraft.csv", "\n".join(lines) + "\n")
                self.expect_one(wrong_rows(self.guess(files)), "kraft.csv:3: Hoehe")

    def test_columns_of_text_are_not_taken_for_numbers_by_their_place(self):
        plate = self.of(self.guess([self.write("a.csv", "load;60,5;start;0\nload;59,5;;0,3\nunload;60;ende;0,1\n")]), "plate")
        self.assertEqual([plate.word("plate_z"), plate.word("top_force")], ["column 2", "column 4"])
        self.assertEqual(self.guess([self.write("b.csv", "load;a;1,5\nload;b;2,5\n")])[0].role, "unused")

    def test_commas_that_may_part_thousands_must_be_confirmed(self):
        files = self.write_lab()
        self.write("kraft.csv", "Hoehe [mm];Kraft [mN]\n" + "".join(
            f"{int(1e3 * s.plate_z)},{int(1e6 * s.plate_z) % 1000:03};{int(1e3 * s.top_force)}\n" for s in self.truth.scans))
        self.expect_one(self.unclear(self.guess(files)), 'decimal must be confirmed, got "?,": every comma has three digits')

    def test_umlauts_are_letters(self):
        files = self.write_lab()
        self.write("kraft.csv", lab_plate(self.truth).replace("Hoehe", "H\xf6he"))
        self.assertEqual(self.unclear(self.guess(files)), [])

    def test_a_table_of_nothing_known_must_be_named(self):
        files = self.write_lab() + [self.write("wetter.csv", "Tag;Regen;Wind\n1;2,5;3\n2;0;1\n")]
        self.expect_one(self.unclear(guess_tables(files, self.known)), 'role must be confirmed, got "?unused": its columns say nothing')


if __name__ == "__main__":
    unittest.main()
