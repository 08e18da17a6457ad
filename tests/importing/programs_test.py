"""Tables in the formats of Yade, scikit-image, trackpy and SPAM, and tables with less than a full force vector."""
import unittest

import numpy as np

from lab import BOX, ImportCase, Style, lab_plate, plain_plate
from mcdem.importing.mapping import Known
from mcdem.importing.guess import mapping_of
from mcdem.importing.mapping import mapping_text

YADE_WALLS = 6  # bodies 0 to 5 in the order of WALLS; grains follow
VTK = "# vtk DataFile Version 3.0.\ncomment\nASCII\n\nDATASET POLYDATA\nPOINTS {} double\n"
VOXEL = 5e-5  # [m]


def vectors(rows):
    return "".join(" ".join(f"{x:.9g}" for x in np.atleast_1d(row)) + "\n" for row in rows)


def vtk_of_spheres(truth, scan):
    return (VTK.format(len(scan.position)) + vectors(scan.position) + f"\nPOINT_DATA {len(scan.position)}\nSCALARS radius double 1\n"
            "LOOKUP_TABLE default\n" + vectors(truth.diameter / 2))


def vtk_of_interactions(scan):
    """exportInteractions(what={'id1': .., 'id2': .., 'force': ..}): the smaller id first, the force on it."""
    n = len(scan.contacts)
    ids = [(-1 - c.partner, c.grain + YADE_WALLS) if c.is_wall else (c.grain + YADE_WALLS, c.partner + YADE_WALLS) for c in scan.contacts]
    forces = [-c.force if c.is_wall else c.force for c in scan.contacts]
    scalars = "\nSCALARS {} double 1\nLOOKUP_TABLE default\n"
    return (VTK.format(2 * n) + n * "0 0 0\n1 1 1\n" + f"LINES {n} {3 * n}\n" + vectors((2, 2 * k, 2 * k + 1) for k in range(n))
            + f"\nCELL_DATA {n}\n" + scalars.format("id1") + vectors(one for one, _ in ids)
            + scalars.format("id2") + vectors(two for _, two in ids) + "\nVECTORS f double\n" + vectors(forces))


class Yade(ImportCase):
    def test_vtk_files_one_a_frame_with_walls_that_count_first(self):
        files = [self.write("plate.txt", plain_plate(self.truth, " ", "").replace("force_N", "top_force").replace("_m", ""))]
        for scan in self.truth.scans:
            files += [self.write(f"y-spheres-{scan.frame:04}.vtk", vtk_of_spheres(self.truth, scan)),
                      self.write(f"y-intrs-{scan.frame:04}.vtk", vtk_of_interactions(scan))]
        tables = self.expect_import(files, contacts={"id_offset": "-6", "fx": "f_x"})
        self.assertEqual((len(tables), len(self.of(tables, "contacts").walls)), (3, 6))


class Forces(ImportCase):
    def test_magnitudes_without_directions_are_imported(self):
        files = self.write_lab()
        self.write("kontakte.csv", Style(",", ".").table(["Zeit [s]", "id1", "id2", "force_N"], (
            (0.5 * s.frame, str(c.grain + 1), c.partner_text(), f"{np.linalg.norm(c.force):.12g}") for s in self.truth.scans for c in s.contacts)))
        self.expect_import(files)

    def test_of_a_plate_are_measured_by_its_contacts(self):
        files = self.write_lab()
        self.write("kraft.csv", lab_plate(self.truth).replace(" [mN]", "", 1))
        self.known = Known(box=BOX)  # without Hertz's law
        self.guess_surely(files, plate={"force_unit": "mN"})
        for unit, certainty in (("cN", "sure"), ("daN", "unclear")):
            self.write("kraft.csv", lab_plate(self.truth, Style(force=100)).replace("mN", unit))
            self.assertEqual(self.of(self.guess(files), "plate")["force_unit"].certainty, certainty)

    def test_of_several_columns_with_one_name_must_be_confirmed(self):
        files = self.write_lab()
        self.write("kraft.csv", Style(",", ".").table(["height_mm", "Force (N)", "Force (N)"], (
            (1e3 * s.plate_z, s.top_force, 3 * s.top_force) for s in self.truth.scans)))
        tables = self.guess(files)
        self.assertEqual(self.of(tables, "plate").word("top_force"), "Force (N)")
        self.expect_among(self.unclear(tables), "several columns have this very name")

    def test_of_a_testing_machine_say_what_is_missing(self):
        files = self.write_lab()
        rows = [(1e3 * s.plate_z, s.top_force) for s in self.truth.scans]
        self.write("kraft.csv", Style(",", ".").table(["Platen position (mm)", "Load (N)"], rows))
        self.assertEqual(self.of(self.guess(files), "plate").word("plate_z"), "Platen position (mm)")
        self.write("kraft.csv", Style(",", ".").table(["Jaw (mm)", "Load (N)"], rows))
        self.expect_among(self.unclear(self.guess(files)), "no column is named as plate_z or displacement or strain or fraction or void_ratio or porosity, which a plate's table must have; "
                                                           "other columns: Jaw (mm)")


class Images(ImportCase):
    """Grains of every frame in voxels, as written by image analysis programs, and the plate's table of the
    laboratory."""

    def setUp(self):
        super().setUp()
        for scan in self.truth.scans:
            scan.contacts = []

    def frames(self, name, columns, row):
        """One file per frame; `row` gives the cells of grain i at x, y, z in voxels."""
        files = [self.write("plate.csv", lab_plate(self.truth))]
        for scan in self.truth.scans:
            rows = (row(i, *at) for i, at in enumerate(scan.position / VOXEL))
            files.append(self.write(f"{name}_{scan.frame:03}.csv", Style(",", ".").table(columns, rows)))
        return files

    def scikit_image(self):
        columns = ["label", "area", "centroid-0", "centroid-1", "centroid-2", "equivalent_diameter_area"]
        return self.frames("regions", columns, lambda i, x, y, z: (
            str(i + 1), np.pi / 6 * (self.truth.diameter[i] / VOXEL) ** 3, z, y, x, self.truth.diameter[i] / VOXEL))

    def test_regions_of_scikit_image_are_z_y_x_in_voxels(self):
        self.known.voxel_size = VOXEL
        tables = self.expect_import(self.scikit_image(), grains={"x": "centroid-2", "y": "centroid-1", "z": "centroid-0", "length_unit": "voxel"})
        again = self.by_mapping(mapping_text(mapping_of(tables)))
        self.known.voxel_size = np.nan
        self.expect_truth(again)

    def test_the_size_of_a_voxel_must_be_confirmed(self):
        tables = self.guess(self.scikit_image())
        self.expect_one(self.unclear(tables), "voxel_size must be confirmed")
        self.assertAlmostEqual(self.of(tables, "grains").number("voxel_size"), VOXEL, delta=0.1 * VOXEL)
        text = mapping_text(mapping_of(tables))
        at = text.index('voxel_size = "?')
        self.expect_truth(self.by_mapping(text[:at] + f'voxel_size = "{VOXEL}"' + text[text.index('"', at + 15) + 1:]))

    def test_a_stated_size_that_does_not_fit_is_unclear(self):
        self.known.voxel_size = 3 * VOXEL
        self.expect_among(self.unclear(self.guess(self.scikit_image())), 'length_unit must be confirmed, got "?voxel"', "the box 0.06 by 0.08 m")

    def test_units_may_be_named_voxels(self):
        self.known.voxel_size = VOXEL
        self.expect_import(self.frames("grains", ["id", "x [px]", "y [px]", "z [px]", "d [px]"], lambda i, x, y, z: (
            str(i), x, y, z, self.truth.diameter[i] / VOXEL)))

    def test_volumes_are_those_of_spheres(self):
        """Labels of Avizo."""
        mm = VOXEL * 1e3
        columns = ["index", "BaryCenterX (mm)", "BaryCenterY (mm)", "BaryCenterZ (mm)", "Volume3d (mm^3)"]
        tables = self.expect_import(self.frames("labels", columns, lambda i, x, y, z: (
            str(i + 1), x * mm, y * mm, z * mm, np.pi / 6 * (1e3 * self.truth.diameter[i]) ** 3)), grains={"volume": "Volume3d (mm^3)"})
        self.expect_truth(self.by_mapping(mapping_text(mapping_of(tables))))

    def test_plates_of_testing_machines(self):
        for named in (["Time (s)", "Compressive extension (mm)", "Compressive load (N)"], ["Zeit [s]", "Standardweg [mm]", "Standardkraft [N]"],
                      ["Time [s]", "Crosshead (mm)", "Axial force (Newtons)"]):
            with self.subTest(named):
                files = self.frames("grains", ["id", "x_mm", "y_mm", "z_mm", "d_mm"], lambda i, x, y, z: (
                    str(i), *(1e3 * VOXEL * np.array([x, y, z])), 1e3 * self.truth.diameter[i]))
                start = self.truth.scans[0].plate_z
                self.known.plate_start = start
                files[0] = self.write("machine.csv", Style(",", ".").table(named, (
                    (0.5 * s.frame, 1e3 * (start - s.plate_z), s.top_force) for s in self.truth.scans)))
                self.expect_import(files)

    def test_trackpys_size_is_no_radius(self):
        """Features of all frames in one table; mass and size refer to the brightness."""
        self.known.voxel_size = VOXEL
        columns = ["", "z", "y", "x", "mass", "size", "ecc", "signal", "raw_mass", "ep", "frame", "particle"]
        rows = ((str(i), *(at[::-1] / VOXEL), 900.5, 0.77 * self.truth.diameter[i] / VOXEL / 2, 0.1, 30.5, 1000.5, 0.05, str(scan.frame), str(i))
                for scan in self.truth.scans for i, at in enumerate(scan.position))
        plate = Style(",", ".").table(["frame", "height_mm", "force_N"], ((s.frame, 1e3 * s.plate_z, s.top_force) for s in self.truth.scans))
        tables = self.guess([self.write("features.csv", Style(",", ".").table(columns, rows)), self.write("plate.csv", plate)])
        grains = self.of(tables, "grains")
        self.assertEqual([grains.word(key) for key in ("grain", "frame", "frames_by")], ["particle", "frame", "plate"])
        self.expect_one(self.unclear(tables), "same_diameter must be confirmed")
        self.assertIn("radius of gyration", grains["same_diameter"].why)
        diameter = grains.number("same_diameter") * VOXEL
        self.assertAlmostEqual(diameter, 0.02, delta=0.001)
        text = mapping_text(mapping_of(tables)).replace('same_diameter = "?', 'same_diameter = "')
        self.truth.diameter[:] = diameter
        self.expect_truth(self.by_mapping(text))

    def spam_labels(self, radius=True):
        """Positions in the first image and displacements relative to it; label 0 is the background."""
        columns = ["Label", "Zpos", "Ypos", "Xpos", "Zdisp", "Ydisp", "Xdisp", "returnStatus"] + (["EquivRadius"] if radius else [])
        first, files = self.truth.scans[0].position / VOXEL, [self.write("plate.csv", lab_plate(self.truth))]
        for scan in self.truth.scans:
            rows = [["0"] + ["nan"] * 6 + ["0"] + ["0"] * radius]
            for i, at in enumerate(scan.position / VOXEL):
                rows.append([float(i + 1), *first[i][::-1], *(at - first[i])[::-1], 2] + [self.truth.diameter[i] / VOXEL / 2] * radius)
            files.append(self.write(f"ddic-{scan.frame:02}.tsv", Style("\t", ".").table(columns, rows)))
        return files

    def test_spams_positions_and_displacements_are_added(self):
        self.known.voxel_size = VOXEL
        tables = self.expect_import(self.spam_labels())
        self.assertEqual(self.of(tables, "grains")["z"].words, ["Zpos", "Zdisp"])

    def test_contacts_of_spam_without_forces_tell_who_touches(self):
        self.known.voxel_size = VOXEL
        pairs = [(i, i + 1, 0.5, 0.5, 0.7, 12) for i in range(1, 30)]
        contacts = self.write("contacts.csv", Style(",", ".").table(["label1", "label2", "orientZ", "orientY", "orientX", "voxels"], pairs))
        tables = self.guess(self.spam_labels() + [contacts])
        found = self.of(tables, "contacts")
        self.assertEqual((found.role_certainty, found.role_why), ("likely", "pairs of grains that touch, without forces"))

    def test_spams_contacts_with_forces_are_contacts(self):
        from lab import PRESSED

        self.known.voxel_size = VOXEL
        for scan, pressed in zip(self.truth.scans, PRESSED.scans):
            scan.contacts = [c for c in pressed.contacts if not c.is_wall]
        files = self.spam_labels()
        for scan in self.truth.scans:
            rows = ((str(c.grain + 1), str(c.partner + 1), *(c.point[::-1] / VOXEL), *c.force[::-1]) for c in scan.contacts)
            files.append(self.write(f"forces-{scan.frame:02}.tsv", Style("\t", ".").table(
                ["label1", "label2", "Zpos", "Ypos", "Xpos", "fz_N", "fy_N", "fx_N"], rows)))
        self.expect_import(files, contacts={"length_unit": "voxel"})
        self.known.voxel_size = np.nan
        tables = self.guess(files)
        self.assertEqual(self.of(tables, "contacts")["voxel_size"].certainty, "unclear")
        self.assertEqual(self.of(tables, "contacts")["voxel_size"], self.of(tables, "grains")["voxel_size"])

    def test_spams_labels_without_radii_ask_for_one(self):
        self.known.voxel_size = VOXEL
        self.expect_one(self.unclear(self.guess(self.spam_labels(False))), "same_diameter must be confirmed")


if __name__ == "__main__":
    unittest.main()
