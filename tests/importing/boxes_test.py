"""Boxes in dumps, data files and extended xyz: those that contradict the container of the experiment are refused."""
import unittest

import numpy as np

from lab import BOX, ImportCase, dump_of_grains, plain_plate
from mcdem.importing.assemble import Known

OPEN = "ff ff ff\n0 1\n0 1\n0 1"


class Boxes(ImportCase):
    def findings(self, grains, name="grains.dump", **known):
        """Problems and notes of an import of these grains into a box or another container."""
        self.known = Known(box=BOX, youngs_modulus=23300, poisson_ratio=0.5, **known)
        files = [self.write("plate.csv", plain_plate(self.truth)), self.write(name, grains)]
        notes = []
        problems = self.problems_of(lambda: notes.extend(self.imported(self.guess(files)).notes))
        return [line for line in problems + notes if "the box" in line]

    def dump(self, bounds):
        return dump_of_grains(self.truth).replace(OPEN, bounds)

    def test_a_box_around_the_walls_is_accepted(self):
        for bounds in (OPEN, "\n-0.01 1\n-0.01 1\n-0.01 1", "ss ms sm\n0.005 0.02\n0.005 0.02\n0.005 0.02",
                       "pp pp pp\n-1 1\n-1 1\n-1 1"):
            self.assertEqual(self.findings(self.dump(bounds)), [], bounds)

    def test_a_tilted_box_is_refused(self):
        for bounds in ("xy xz yz ff ff ff\n0 1.3 0.3\n0 1 0\n0 1 0", "abc origin pp pp pp\n1 0 0 0\n0.3 1 0 0\n0 0 1 0"):
            found = self.findings(self.dump(bounds))
            self.expect_one(found, "grains.dump:6: the box must be upright, as the experiment's container is, got one with edges of 1 0 0; "
                                   "0.3 1 0; 0 0 1 m")

    def test_a_box_that_cuts_the_container_is_refused(self):
        found = self.findings(self.dump(f"ff ff ff\n0 {BOX[0] / 2}\n0 1\n0 1"))
        self.expect_one(found, f"grains.dump:6: the box must hold the experiment's box, 0 to {BOX[0]:.6g} m along x, got 0 to {BOX[0] / 2:.6g} m")
        self.expect_one(self.findings(self.dump("ff ff ff\n0 1\n0 1\n0.001 1")), "must hold the floor, z = 0, got 0.001 to 1 m")
        self.expect_one(self.findings(self.dump(f"\n0 {BOX[0] / 2}\n0 1\n0 1")), "the box should hold")

    def test_walls_where_grains_reach_through_are_refused(self):
        self.truth.scans[0].position[0][0] = 0.4 * self.truth.diameter[0]
        found = self.findings(self.dump(f"pp ff ff\n0 {BOX[0]}\n0 1\n0 1"))
        self.expect_one(found, "must not repeat along x, where the experiment has walls and grains reach through its face: set container.shape")

    def test_periods_must_be_those_of_the_container(self):
        own = f"pp pp ff\n0 {BOX[0]}\n-1 {BOX[1] - 1}\n0 1"
        self.assertEqual(self.findings(self.dump(own), shape="periodic"), [])
        found = self.findings(self.dump(f"pp pp ff\n0 {1.5 * BOX[0]}\n0 {BOX[1]}\n0 1"), shape="periodic")
        self.expect_one(found, f"must be {BOX[0]:.9g} m long along x, the period in box.size, got {1.5 * BOX[0]:.9g}")
        self.expect_one(self.findings(self.dump(OPEN), shape="periodic"), 'must repeat along x as container.shape = "periodic"')

    def data(self, header):
        """The first frame as a data file."""
        scan = self.truth.scans[0]
        self.truth.scans = self.truth.scans[:1]
        rows = "".join(f"{k + 1} 1 {self.truth.diameter[k]:.9g} 1000 {x:.9g} {y:.9g} {z:.9g}\n" for k, (x, y, z) in enumerate(scan.position))
        return f"packing\n\n{len(scan.position)} atoms\n\n{header}\n\nAtoms # sphere\n\n{rows}"

    def test_of_data_files_are_read(self):
        upright = "0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi"
        self.assertEqual(self.findings(self.data(upright), "grains.data"), [])
        self.expect_one(self.findings(self.data(upright + "\n0.3 0 0 xy xz yz"), "grains.data"), "grains.data:5: the box must be upright")
        self.expect_one(self.findings(self.data("1 0 0 avec\n0 1 0 bvec\n0.3 0 1 cvec\n0 0 0 abc origin"), "grains.data"), "must be upright")

    def test_of_extended_xyz_are_read(self):
        def xyz(lattice):
            return "".join(f'{len(s.position)}\nLattice="{lattice}" Properties=species:S:1:pos:R:3:radius:R:1:id:I:1 frame={100 * s.frame}\n' + "".join(
                f"X {x:.9g} {y:.9g} {z:.9g} {self.truth.diameter[k] / 2:.9g} {k}\n" for k, (x, y, z) in enumerate(s.position))
                for s in self.truth.scans)
        self.assertEqual(self.findings(xyz("1 0 0 0 1 0 0 0 1"), "grains.xyz"), [])
        self.expect_one(self.findings(xyz("1 0 0 0 1 0 0.3 0 1"), "grains.xyz"), "grains.xyz: the box must be upright")

    def test_lines_without_numbers_are_refused(self):
        self.assertIn("grains.dump:7: a line of the box must begin with 2 numbers", "".join(self.problems_of(
            lambda: self.guess([self.write("plate.csv", plain_plate(self.truth)), self.write("grains.dump", self.dump("ff ff ff\n0 1\nx 1\n0 1"))]))))

    def test_reversed_axes_are_compared_as_they_are_placed(self):
        for scan in self.truth.scans:
            scan.position = np.array([1, 1, -1]) * scan.position
        down = self.dump("ff ff fs\n0 1\n0 1\n-1 0")
        self.known = Known(box=BOX, youngs_modulus=23300, poisson_ratio=0.5)
        tables = self.guess([self.write("plate.csv", plain_plate(self.truth)), self.write("grains.dump", down)])
        self.assertEqual(self.of(tables, "grains").word("z"), "-z")
        self.assertFalse([line for line in self.problems_of(lambda: self.imported(tables)) if "the box" in line])


if __name__ == "__main__":
    unittest.main()
