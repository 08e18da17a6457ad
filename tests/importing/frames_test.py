"""Which frames of a laboratory's tables belong together: by numbers, times or order; or an error if none is
reliable."""
import unittest

import numpy as np

from lab import ImportCase


class Frames(ImportCase):
    def plate(self, frame, first=0.0, step=1.0, rows=None):
        """Adds a column of frames with this name, starting at `first`, `step` apart."""
        names = f"{frame},plate_z [m],force [N]\n" if frame else "plate_z [m],force [N]\n"
        scans = rows or self.truth.scans
        return self.write("plate.csv", names + "".join(
            (f"{first + step * n:g}," if frame else "") + f"{s.plate_z:.9g},{s.top_force:.9g}\n" for n, s in enumerate(scans)))

    def rows(self, f, first):
        return "".join(f"{first}{i},{x:.9g},{y:.9g},{z:.9g},{self.truth.diameter[i]:.9g}\n"
                       for i, (x, y, z) in enumerate(self.truth.scans[f].position))

    def grains(self, frame, step, which):
        return self.write("grains.csv", frame + ",id,x_m,y_m,z_m,d_m\n" + "".join(self.rows(f, f"{step * f!r},") for f in which))

    def grain_files(self, names):
        """One file per frame."""
        return [self.write(name, "id,x_m,y_m,z_m,d_m\n" + self.rows(f, "")) for f, name in names]

    def contacts(self, frame, first, start):
        return self.write("contacts.csv", frame + ",id1,id2,f_N\n" + "".join(
            f"{first + f},{c.grain},{c.partner_text(0)},{np.linalg.norm(c.force):.9g}\n"
            for f in range(start, len(self.truth.scans)) for c in self.truth.scans[f].contacts))

    def position(self, imported, frame):
        grains = imported.grains
        return grains[grains.frame == frame][["x_m", "y_m", "z_m"]].values

    def test_frames_of_a_table_without_rows_are_unclear(self):
        dump = self.write("grains.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
                          "ITEM: ATOMS id x y z radius\n")
        tables = self.guess([self.plate("frame [s]"), dump])
        frames = self.of(tables, "grains")["frames_by"]
        self.assertEqual(frames.certainty, "unclear")
        self.assertIn("there are 0 frames here", frames.why)
        self.expect_among(self.problems_of(lambda: self.imported(tables)), "grains.dump: must have rows")
        grains = self.write("grains.csv", "time,id,x_m,y_m,z_m,d_m\n" + self.rows(0, "none,"))
        self.expect_one(self.unclear(self.guess([self.plate("time"), grains])), "there are 0 frames here")

    def test_numbers_in_file_names_are_those_of_the_plate(self):
        files = [self.plate("frame")] + self.grain_files([(2, "grains_002.txt"), (3, "grains_003.txt"), (5, "grains_005.txt")])
        tables = self.guess_surely(files)
        self.assertEqual(self.of(tables, "grains")["frames_by"].certainty, "likely")
        imported = self.imported(tables)
        self.assertEqual(len(imported.plate), 5, "two rows before the first grains are left out")
        for f in (2, 3, 5):
            np.testing.assert_allclose(self.position(imported, f - 2), self.truth.scans[f].position, atol=1e-9)
        self.assertEqual([*imported.grains.frame.unique()], [0, 1, 3])

    def test_files_that_only_count_themselves_or_have_no_number_must_be_confirmed(self):
        plate = [self.plate("frame")]
        counted = self.grain_files([(2, "grains_1.txt"), (3, "grains_2.txt"), (5, "grains_3.txt")])
        self.expect_one(self.unclear(self.guess(plate + counted)), "frames_by must be confirmed")
        named = self.grain_files([(2, "a.txt"), (3, "b.txt"), (5, "c.txt")])
        self.expect_one(self.unclear(self.guess(plate + named)), "there are 3 frames here and 7 rows of the plate")
        numbered = self.grain_files([(2, "d_2.txt"), (3, "d_3.txt"), (5, "d_5.txt")])
        self.expect_one(self.unclear(self.guess([self.plate("time [s]")] + numbered)), "numbers in file names here, time numbers [s] there")

    def test_files_are_numbered_by_the_plates_rows(self):
        """Frames of a tomograph at every twelfth row of a plate that is measured more often."""
        heights = np.interp(np.arange(37), 6 * np.arange(7), [s.plate_z for s in self.truth.scans])
        forces = np.interp(np.arange(37), 6 * np.arange(7), [s.top_force for s in self.truth.scans])

        class Row:
            def __init__(self, z, force):
                self.plate_z, self.top_force = z, force

        files = self.grain_files([(0, "tomo_000.csv"), (2, "tomo_012.csv"), (4, "tomo_024.csv")])
        for frame in ("", "time [s]"):
            plate = self.plate(frame, 0, 0.7, [Row(*row) for row in zip(heights, forces)])
            tables = self.guess_surely([plate] + files, grains={"frames_by": "rows" if frame else "plate"})
            self.assertEqual(self.of(tables, "grains")["frames_by"].certainty, "likely")
            imported = self.imported(tables)
            self.assertEqual([*imported.grains.frame.unique()], [0, 12, 24])
            np.testing.assert_allclose(self.position(imported, 24), self.truth.scans[4].position, atol=1e-9)
        several = self.plate("time [s]", 0, 1, [Row(*row) for row in zip(heights, forces)])
        self.expect_one(self.unclear(self.guess([several] + files)), "numbers in file names here, time numbers [s] there")

    def test_contacts_go_by_the_plate_beside_files_in_order(self):
        for first in (0, 1):
            files = [self.plate("frame", 1), self.contacts("frame", 1, 1)]
            files += self.grain_files([(f, f"grains_{f + first:03}.txt") for f in range(7)])
            imported = self.imported(self.guess_surely(files, contacts={"frames_by": "plate"}))
            for scan in self.truth.scans[1:]:
                self.expect_contacts(imported, scan)

    def test_frame_numbers_among_times_must_be_confirmed(self):
        files = [self.plate("time [s]"), self.grains("frame", 1, (0, 1, 3))]
        self.expect_one(self.unclear(self.guess(files)), 'frames_by must be confirmed, got "?plate": scan numbers here, time numbers [s] '
                        "there: are they the same?")
        self.grains("time [d]", 1, (0, 1, 3))
        self.expect_one(self.unclear(self.guess(files)), "time numbers [d] here, time numbers [s] there")
        self.plate("time")
        self.grains("time [min]", 1 / 60, (0, 1, 3))
        self.expect_one(self.unclear(self.guess(files)), "frames_by must be confirmed")

    def test_times_in_other_units_are_converted(self):
        tables = self.guess_surely([self.plate("time [s]", 0, 60), self.grains("time [min]", 1, (0, 1, 3))])
        np.testing.assert_allclose(self.position(self.imported(tables), 3), self.truth.scans[3].position, atol=1e-9)

    def test_frame_numbers_start_at_0_or_must_be_confirmed_if_the_plate_has_none(self):
        files = [self.plate(""), self.grains("frame", 1, (0, 2, 3))]
        self.assertEqual(self.unclear(self.guess(files)), [])
        self.grains("frame", 1, (1, 2, 3))
        self.expect_among(self.unclear(self.guess(files)), "frames_by must be confirmed")


if __name__ == "__main__":
    unittest.main()
