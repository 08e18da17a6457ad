"""Experiments from foreign tables: the guess, what it marks as uncertain, and the imported values."""
import copy
import re
import unittest
from dataclasses import replace

import numpy as np

from lab import (Contact, ImportCase, Style, dump_of_contacts, dump_of_grains, lab_contacts, lab_grains, lab_plate, mapped,
                 plain_plate)
from mcdem.importing.assemble import import_tables
from mcdem.importing.guess import guess_tables, mapping_of
from mcdem.importing.mapping import Known, mapping_text
from mcdem.importing.read_mapping import parse_mapping
from mcdem.importing.text import Form


class Import(ImportCase):
    def test_german_names_with_units_need_no_confirmation(self):
        tables = self.expect_import(self.write_lab(), grains={"length_unit": "mm"})
        self.assertEqual(self.of(tables, "grains").form, Form(";", ","))
        self.assertEqual(self.of(tables, "contacts").walls["Boden"].word, "floor")
        self.assertEqual(self.of(tables, "contacts").walls["Boden"].why, "its name")

    def test_missing_units_are_derived_from_box_and_stiffness(self):
        units = {"length_unit": "mm", "force_unit": "mN"}
        self.expect_import(self.write_lab(Style("\t", ".", False)), plate=units, grains={"length_unit": "mm"}, contacts=units)
        metres = self.guess(self.write_lab(Style(",", ".", False, 1, 1 / 9.80665e-3)))
        self.assertEqual((self.of(metres, "grains").word("length_unit"), self.of(metres, "plate").word("force_unit")), ("m", "gf"))

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
        files = [self.write("pairs.dump", dump_of_contacts(self.truth, False)), self.write("grains.dump", dump_of_grains(self.truth)),
                 self.write("plate.csv", plain_plate(self.truth))]
        for scan in self.truth.scans:
            scan.contacts = [contact for contact in scan.contacts if not contact.is_wall]
        self.expect_import(files, contacts={"grain": "c_p[1]", "partner": "c_p[2]", "fx": "c_p[4]"})

    def test_walls_of_a_program_are_named_in_the_mapping(self):
        plate, grains, pairs, walls = (self.write(name, text) for name, text in (
            ("plate.csv", plain_plate(self.truth)), ("grains.dump", dump_of_grains(self.truth)),
            ("pairs.dump", dump_of_contacts(self.truth, False)), ("walls.dump", dump_of_contacts(self.truth, True))))
        forces = {"force_unit": "N", "force_on": "grain", "fx": "c_p[4]", "fz": "c_p[6]"}
        self.expect_truth(self.by_mapping(
            mapped("plate", plate, frame="step", plate_z="plate_z_m", top_force="force_N", length_unit="m", force_unit="N", force_sign="+")
            + mapped("grains", grains, grain="id", x="x", y="y", z="z", radius="radius", length_unit="m")
            + mapped("contacts", pairs, grain="c_p[1]", partner="c_p[2]", fy=["c_p[5]", "c_p[3]"], **forces)
            + mapped("contacts", walls, {0: "x_min", 1: "by direction", 2: "y_min", 3: "y_max", 4: "floor", 5: "plate"},
                     grain="c_p[3]", partner="c_p[1]", fy="c_p[5]", **forces)))

    def test_the_grain_a_force_acts_on_and_pairs_listed_twice_are_detected(self):
        files, listed = self.write_lab(), copy.deepcopy(self.truth)
        for scan in listed.scans:
            scan.contacts = [replace(contact, force=-contact.force) for contact in scan.contacts]
        self.write("kontakte.csv", lab_contacts(listed))
        self.expect_import(files, contacts={"force_on": "partner"})
        for scan, truth in zip(listed.scans, self.truth.scans):
            scan.contacts = truth.contacts + [Contact(c.partner, c.grain, c.point, -c.force) for c in truth.contacts if not c.is_wall]
        self.write("kontakte.csv", lab_contacts(listed))
        self.expect_import(files, contacts={"sides": "both"})

    def test_numbers_from_zero_beside_numbers_from_one_are_seen(self):
        files = self.write_lab()
        pairs = [(scan, c) for scan in self.truth.scans for c in scan.contacts if not c.is_wall]
        self.write("kontakte.csv", Style(",", ".").table(["Zeit [s]", "id1", "id2", "fx_mN", "fy_mN", "fz_mN"], (
            (0.5 * scan.frame, c.grain, c.partner, *(1e3 * c.force)) for scan, c in pairs)))
        contacts = self.imported(self.guess_surely(files, contacts={"id_offset": "1"})).contacts
        self.assertEqual([*contacts.grain], [c.grain for _, c in pairs])

    def test_grains_without_column_names_are_identified_by_touching_neighbours(self):
        rows = np.column_stack([self.truth.scans[0].position, self.truth.diameter / 2])
        self.guess_surely([self.write("pack.txt", "".join("\t".join(f"{x:.6g}" for x in row) + "\n" for row in rows))],
                          grains={"radius": "column 4", "length_unit": "m"})

    def test_files_that_are_alike_are_frames_in_the_order_of_their_numbers(self):
        files = [self.write_lab()[0]]
        for scan in reversed(self.truth.scans):
            files.append(self.write(f"grains{scan.frame + 5}.csv", Style(";", ".").table(
                ["id", "x_m", "y_m", "z_m", "diameter_m"], ((i, *at, self.truth.diameter[i]) for i, at in enumerate(scan.position)))))
        for scan in self.truth.scans:
            scan.contacts = []
        self.assertEqual(len(self.expect_import(files, grains={"frames_by": "order"})), 2)

    def test_displacements_cycles_and_early_rows_of_the_plate(self):
        plate = "t,displacement_mm,force_N\n-1,-0.1,0\n" + "".join(
            f"{0.5 * scan.frame},{1e3 * (0.0605 - scan.plate_z)},{-scan.top_force}\n" for scan in self.truth.scans) + "3.5,4,-1\n4,0.1,0\n"
        files = [self.write("plate.csv", plate), self.write("grains.csv", lab_grains(self.truth, Style(",", ".")).replace("Zeit [s]", "t [s]"))]
        self.known.plate_start = 0.0605
        tables = self.guess_surely(files, plate={"force_sign": "-"})
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
                        "plate.csv: displacement counts downwards from plate.start")

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
