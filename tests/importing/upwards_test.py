"""Tables whose z axis points down: inverted if this is certain, otherwise refused."""
import copy
import re
import unittest

from lab import ImportCase, Style, lab_contacts, lab_grains, lab_plate
from mcdem.importing.guess import mapping_of
from mcdem.importing.mapping import mapping_text


def downwards(truth, begin):
    """The same tables with z measured downwards from `begin` [m]."""
    truth = copy.deepcopy(truth)
    for scan in truth.scans:
        scan.plate_z = begin - scan.plate_z
        if len(scan.position):
            scan.position[:, 2] = begin - scan.position[:, 2]
        for contact in scan.contacts:
            contact.point[2] = begin - contact.point[2]
            contact.force[2] *= -1
    return truth


class Upwards(ImportCase):
    def write_downwards(self, begin, *which):
        """The laboratory's tables; those named have z measured downwards."""
        truth = {True: downwards(self.truth, begin), False: self.truth}
        return [self.write("kraft.csv", lab_plate(truth["plate" in which])), self.write("koerner.csv", lab_grains(truth["grains" in which])),
                self.write("kontakte.csv", lab_contacts(truth["contacts" in which]))]

    def test_downwards_from_the_floor_is_seen(self):
        tables = self.expect_import(self.write_downwards(0, "plate", "grains", "contacts"), plate={"plate_z": "-Hoehe [mm]"},
                                    grains={"z": "-z [mm]"}, contacts={"z": "-z [mm]", "fz": "-fz [mN]"})
        self.assertEqual(self.of(tables, "grains").unused, [])
        self.expect_truth(self.by_mapping(mapping_text(mapping_of(tables))))

    def test_downwards_from_the_plate_must_be_confirmed(self):
        tables = self.guess(self.write_downwards(0.0605, "plate", "grains", "contacts"))
        unclear = self.unclear(tables)
        self.expect_among(unclear, 'z must be confirmed, got "?-z [mm]"', "moves at its lower end: is z downwards?")
        self.expect_among(unclear, 'origin_z must be confirmed, got "?6')
        text = mapping_text(mapping_of(tables)).replace('"?', '"')
        text = re.sub(r'\norigin_z = "[0-9.]+"', '\norigin_z = "60.5"', text)
        for line in ('z = "-z [mm]"', 'fz = "-fz [mN]"', 'plate_z = "-Hoehe [mm]"'):
            self.assertIn(line, text)
        self.expect_truth(self.by_mapping(text))

    def test_one_table_may_be_downwards_beside_others_that_are_not(self):
        self.expect_import(self.write_downwards(0, "plate"), plate={"plate_z": "-Hoehe [mm]"})
        self.expect_one(self.unclear(self.guess(self.write_downwards(0, "plate")[:1])), "where is the floor, as Hoehe [mm] counts?")
        self.expect_among(self.unclear(self.guess(self.write_downwards(-0.03, "plate"))), "origin_z must be confirmed")
        self.expect_import(self.write_downwards(0, "contacts"), contacts={"z": "-z [mm]", "fz": "-fz [mN]"})

    def test_a_column_name_can_reverse_z_and_the_walls(self):
        files, turned = self.write_downwards(0, "plate"), downwards(self.truth, 0)
        self.write("koerner.csv", lab_grains(turned).replace(";z [mm]", ";Tiefe [mm]"))
        self.write("kontakte.csv", lab_contacts(turned).replace("Deckel", "zmin").replace("Boden", "zmax"))
        tables = self.expect_import(files)
        self.assertEqual(self.of(tables, "grains")["z"].why, "its name says downwards")
        self.assertEqual(self.of(tables, "contacts").walls["zmin"].word, "plate")

    def test_one_frame_below_zero_may_be_either(self):
        for scan in self.truth.scans[1:]:
            scan.position = scan.position[:0]
        files = self.write_downwards(0, "plate", "grains", "contacts")
        self.expect_among(self.unclear(self.guess(files[:2])), 'z must be confirmed, got "?-z [mm]"', "is z downwards?")

    def test_upward_displacements_are_reversed(self):
        files = self.write_lab()
        self.write("kraft.csv", Style(",", ".").table(["Zeit [s]", "displacement_mm", "force_N"], (
            (0.5 * s.frame, repr(float(-1e3 * (0.0605 - s.plate_z))), repr(float(s.top_force))) for s in self.truth.scans)))
        self.known.plate_start = 0.0605
        self.expect_import(files, plate={"displacement": "-displacement_mm"})

    def test_walls_of_a_turned_axis_must_be_named(self):
        files = self.write_lab()
        self.write("kontakte.csv", lab_contacts(self.truth).replace("links", "x_min"))
        text = mapping_text(mapping_of(self.guess(files)))
        text = text.replace('\nx = "x [mm]"', '\nx = "-x [mm]"', 1).replace('origin_x = "0"', 'origin_x = "60"')
        self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(text))),
                        "x_min must be named in [table.walls] where x is reversed")

    def test_several_columns_have_signs_of_their_own(self):
        text = mapping_text(mapping_of(self.guess(self.write_lab())))
        self.expect_truth(self.by_mapping(re.sub(r'\nfz = ".*?"', '\nfz = ["fz [mN]", "fx [mN]", "-fx [mN]"]', text)))


if __name__ == "__main__":
    unittest.main()
