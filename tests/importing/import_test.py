"""Experiments from foreign tables: the guess, what it marks as uncertain, and the imported values."""
import re
import unittest

import numpy as np

from lab import (Contact, ImportCase, Style, dump_of_contacts, dump_of_grains, lab_contacts, lab_grains, lab_plate,
                 plain_plate)
from mcdem.importing.assemble import Known, import_tables
from mcdem.importing.guess import guess_tables, mapping_of
from mcdem.importing.mapping import mapping_text
from mcdem.importing.read_mapping import parse_mapping
from mcdem.importing.text import Form


class Import(ImportCase):
    def test_german_names_with_units_need_no_confirmation(self):
        tables = self.guess(self.write_lab())
        self.assertEqual(self.unclear(tables), [])
        self.assertEqual(self.of(tables, "grains").word("length_unit"), "mm")
        self.assertEqual(self.of(tables, "grains").form, Form(";", ","))
        self.assertEqual(self.of(tables, "contacts").walls["Boden"].word, "floor")
        self.assertEqual(self.of(tables, "contacts").walls["Boden"].why, "its name")
        self.expect_truth(tables)

    def test_missing_units_are_derived_from_box_and_stiffness(self):
        tables = self.guess(self.write_lab(Style("\t", ".", False)))
        self.assertEqual(self.unclear(tables), [])
        for role in ("plate", "grains", "contacts"):
            self.assertEqual(self.of(tables, role).word("length_unit"), "mm")
        self.assertEqual(self.of(tables, "plate").word("force_unit"), "mN")
        self.assertEqual(self.of(tables, "contacts").word("force_unit"), "mN")
        self.expect_truth(tables)
        metres = self.guess(self.write_lab(Style(",", ".", False, 1, 1 / 9.80665e-3)))
        self.assertEqual(self.of(metres, "grains").word("length_unit"), "m")
        self.assertEqual(self.of(metres, "plate").word("force_unit"), "gf")

    def test_without_scale_units_must_be_confirmed(self):
        tables = guess_tables(self.write_lab(Style(named=False)), Known())
        problems = self.unclear(tables)
        self.expect_among(problems, 'length_unit must be confirmed, got "?mm": no name says it, and the box is not known')
        self.expect_among(problems, "force_unit must be confirmed")
        # The guess as written is refused, line by line; when confirmed it is accepted.
        text = mapping_text(mapping_of(tables))
        self.assertTrue(any(re.match(r'm:[0-9]+: length_unit must be confirmed, got "\?mm": put in what is right, ', problem)
                            for problem in self.problems_of(lambda: parse_mapping(text, "m"))))
        for wrong, right in (('"?mm"', '"mm"'), ('"?N"', '"mN"'), ('"?m"', '"mm"')):
            text = text.replace(wrong, right)
        self.expect_truth(self.by_mapping(text))

    def test_names_that_contradict_the_numbers_must_be_confirmed(self):
        files = self.write_lab()
        self.write("koerner.csv", lab_grains(self.truth).replace("[mm]", "[cm]"))
        self.expect_among(self.unclear(self.guess(files)), 'length_unit must be confirmed, got "?cm": the columns\' names say so, but')
        self.write("koerner.csv", lab_grains(self.truth).replace("Radius", "Durchmesser"))
        self.expect_among(self.unclear(self.guess(files)), "is it the radius?")

    def test_dump_columns_without_clear_names_are_identified_by_values(self):
        tables = self.guess([self.write("pairs.dump", dump_of_contacts(self.truth, False)),
                             self.write("grains.dump", dump_of_grains(self.truth)), self.write("plate.csv", plain_plate(self.truth))])
        self.assertEqual(self.unclear(tables), [])
        contacts = self.of(tables, "contacts")
        self.assertEqual([contacts.word(key) for key in ("grain", "partner", "fx")], ["c_p[1]", "c_p[2]", "c_p[4]"])
        for scan in self.truth.scans:
            scan.contacts = [contact for contact in scan.contacts if not contact.is_wall]
        self.expect_truth(tables)

    def test_walls_of_a_program_are_named_in_the_mapping(self):
        for name, text in (("plate.csv", plain_plate(self.truth)), ("grains.dump", dump_of_grains(self.truth)),
                           ("pairs.dump", dump_of_contacts(self.truth, False)), ("walls.dump", dump_of_contacts(self.truth, True))):
            self.write(name, text)
        contacts = 'force_unit = "N"\nforce_on = "grain"\nfx = "c_p[4]"\nfz = "c_p[6]"\n'
        self.expect_truth(self.by_mapping(f"""[[table]]
role = "plate"
files = ["{self.folder}/plate.csv"]
frame = "step"
plate_z = "plate_z_m"
top_force = "force_N"
length_unit = "m"
force_unit = "N"
force_sign = "+"
[[table]]
role = "grains"
files = ["{self.folder}/grains.dump"]
grain = "id"
x = "x"
y = "y"
z = "z"
radius = "radius"
length_unit = "m"
[[table]]
role = "contacts"
files = ["{self.folder}/pairs.dump"]
grain = "c_p[1]"
partner = "c_p[2]"
fy = ["c_p[5]", "c_p[3]"]
{contacts}
[[table]]
role = "contacts"
files = ["{self.folder}/walls.dump"]
grain = "c_p[3]"
partner = "c_p[1]"
fy = "c_p[5]"
{contacts}
[table.walls]
0 = "x_min"
1 = "by direction"
2 = "y_min"
3 = "y_max"
4 = "floor"
5 = "plate"
"""))

    def test_the_grain_a_force_acts_on_and_pairs_listed_twice_are_detected(self):
        files = self.write_lab()
        for scan in self.truth.scans:
            for contact in scan.contacts:
                contact.force = -contact.force
        self.write("kontakte.csv", lab_contacts(self.truth))
        for scan in self.truth.scans:
            for contact in scan.contacts:
                contact.force = -contact.force
        tables = self.guess(files)
        self.assertEqual(self.of(tables, "contacts").word("force_on"), "partner")
        self.assertEqual(self.unclear(tables), [])
        self.expect_truth(tables)
        once = [list(scan.contacts) for scan in self.truth.scans]
        for scan in self.truth.scans:
            scan.contacts += [Contact(c.partner, c.grain, c.point, -c.force) for c in scan.contacts if not c.is_wall]
        self.write("kontakte.csv", lab_contacts(self.truth))
        for scan, contacts in zip(self.truth.scans, once):
            scan.contacts = contacts
        tables = self.guess(files)
        self.assertEqual(self.of(tables, "contacts").word("sides"), "both")
        self.expect_truth(tables)

    def test_numbers_from_zero_beside_numbers_from_one_are_seen(self):
        files = self.write_lab()
        pairs = [(scan, c) for scan in self.truth.scans for c in scan.contacts if not c.is_wall]
        self.write("kontakte.csv", Style(",", ".").table(["Zeit [s]", "id1", "id2", "fx_mN", "fy_mN", "fz_mN"], (
            (0.5 * scan.frame, c.grain, c.partner, *(1e3 * c.force)) for scan, c in pairs)))
        tables = self.guess(files)
        self.assertEqual(self.of(tables, "contacts").word("id_offset"), "1")
        self.assertEqual(self.unclear(tables), [])
        contacts = self.imported(tables).contacts
        self.assertEqual([*contacts.grain], [c.grain for _, c in pairs])

    def test_grains_without_column_names_are_identified_by_touching_neighbours(self):
        rows = np.column_stack([self.truth.scans[0].position, self.truth.diameter / 2])
        tables = self.guess([self.write("pack.txt", "".join("\t".join(f"{x:.6g}" for x in row) + "\n" for row in rows))])
        self.assertEqual(tables[0].role, "grains")
        self.assertEqual(tables[0].map.word("radius"), "column 4")
        self.assertEqual(tables[0].map.word("length_unit"), "m")
        self.assertEqual(self.unclear(tables), [])

    def test_files_that_are_alike_are_frames_in_the_order_of_their_numbers(self):
        files = [self.write_lab()[0]]
        for scan in reversed(self.truth.scans):
            files.append(self.write(f"grains{scan.frame + 5}.csv", Style(";", ".").table(
                ["id", "x_m", "y_m", "z_m", "diameter_m"], ((i, *at, self.truth.diameter[i]) for i, at in enumerate(scan.position)))))
        tables = self.guess(files)
        self.assertEqual(len(tables), 2)
        self.assertEqual(self.of(tables, "grains").word("frames_by"), "order")
        for scan in self.truth.scans:
            scan.contacts = []
        self.expect_truth(tables)

    def test_displacements_cycles_and_early_rows_of_the_plate(self):
        plate = "t,displacement_mm,force_N\n-1,-0.1,0\n" + "".join(
            f"{0.5 * scan.frame},{1e3 * (0.0605 - scan.plate_z)},{-scan.top_force}\n" for scan in self.truth.scans) + "3.5,4,-1\n4,0.1,0\n"
        files = [self.write("plate.csv", plate), self.write("grains.csv", lab_grains(self.truth, Style(",", ".")).replace("Zeit [s]", "t [s]"))]
        self.known.plate_start = 0.0605
        tables = self.guess(files)
        self.assertEqual(self.unclear(tables), [])
        self.assertEqual(self.of(tables, "plate").word("force_sign"), "-")
        imported = self.imported(tables)
        self.assertEqual(imported.notes, ["the plate's first 1 rows are left out: grains are known from then on"])
        self.assertEqual(imported.plate_start, 0.0605)
        self.assertEqual(len(imported.plate), 9)
        self.assertAlmostEqual(imported.plate.plate_z_m[3], self.truth.scans[3].plate_z, 12)
        self.assertAlmostEqual(imported.plate.top_force_N[3], self.truth.scans[3].top_force, 12)
        self.assertEqual([*imported.plate.cycle[6:]], [0, 1, 1])
        self.assertEqual([*imported.plate.phase[6:]], ["unload", "load", "unload"], "down again")
        self.known.plate_start = np.nan
        self.expect_one(self.problems_of(lambda: import_tables(tables, self.known)),
                        "plate.csv: displacements count downwards from plate.start")

    def test_a_mapping_serves_other_files(self):
        tables = self.guess(self.write_lab())
        text = mapping_text(mapping_of(tables))
        mapping = parse_mapping(text, "m")
        self.assertEqual([{key: of.words for key, of in table.entries.items()} for table in mapping],
                         [{key: of.words for key, of in table.map.entries.items()} for table in tables])
        for scan in self.truth.scans:
            scan.plate_z += 1e-4
        files = [self.write("c2", lab_contacts(self.truth)), self.write("p2", lab_plate(self.truth)), self.write("g2", lab_grains(self.truth))]
        self.expect_truth(self.by_mapping(text, files))
        self.assertEqual(self.problems_of(lambda: self.by_mapping(text, [self.write("odd", "a,b\n1,2\n")])),
                         ["odd: must have the columns of a table of the mapping, got others"])
        self.expect_one(self.problems_of(lambda: self.by_mapping(text, files[1:])),
                        "the table of contacts, kontakte.csv there, must have a file too, got none among those given: give it, or "
                        "remove the table")


if __name__ == "__main__":
    unittest.main()
