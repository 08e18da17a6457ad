"""Boxes in dumps, data files and extended xyz: those that contradict the container of the experiment are refused."""
import unittest

import numpy as np

from lab import BOX, ImportCase, dump_of_grains, plain_plate
from mcdem.importing.mapping import Known

OPEN = "ff ff ff\n0 1\n0 1\n0 1"
X, Y = BOX
# bounds of a dump; shape of the container; what is found, or nothing
DUMPS = (
    (OPEN, "box", None),
    ("\n-0.01 1\n-0.01 1\n-0.01 1", "box", None),
    ("ss ms sm\n0.005 0.02\n0.005 0.02\n0.005 0.02", "box", None),
    ("pp pp pp\n-1 1\n-1 1\n-1 1", "box", None),
    *((tilted, "box", "grains.dump:6: the box must be upright, as the experiment's container is, got one with edges of 1 0 0; 0.3 1 0; 0 0 1 m")
      for tilted in ("xy xz yz ff ff ff\n0 1.3 0.3\n0 1 0\n0 1 0", "abc origin pp pp pp\n1 0 0 0\n0.3 1 0 0\n0 0 1 0")),
    (f"ff ff ff\n0 {X / 2}\n0 1\n0 1", "box",
     f"grains.dump:6: the box must hold the experiment's box, 0 to {X:.6g} m along x, got 0 to {X / 2:.6g} m"),
    ("ff ff ff\n0 1\n0 1\n0.001 1", "box", "must hold the floor, z = 0, got 0.001 to 1 m"),
    (f"\n0 {X / 2}\n0 1\n0 1", "box", "the box should hold"),
    (f"pp pp ff\n0 {X}\n-1 {Y - 1}\n0 1", "periodic", None),
    (f"pp pp ff\n0 {1.5 * X}\n0 {Y}\n0 1", "periodic",
     f"must be {X:.9g} m long along x, the period in box.size, got {1.5 * X:.9g}"),
    (OPEN, "periodic", 'must repeat along x as container.shape = "periodic"'))
UPRIGHT = "0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi"
DATA = ((UPRIGHT, None), (UPRIGHT + "\n0.3 0 0 xy xz yz", "grains.data:5: the box must be upright"),
        ("1 0 0 avec\n0 1 0 bvec\n0.3 0 1 cvec\n0 0 0 abc origin", "must be upright"))


class Boxes(ImportCase):
    def expect_found(self, found, grains, name="grains.dump", **known):
        """The only problem or note of an import of these grains into a box or another container; None: none."""
        self.known = Known(box=BOX, youngs_modulus=23300, poisson_ratio=0.5, **known)
        files = [self.write("plate.csv", plain_plate(self.truth)), self.write(name, grains)]
        notes = []
        problems = self.problems_of(lambda: notes.extend(self.imported(self.guess(files)).notes))
        lines = [line for line in problems + notes if "the box" in line]
        if found:
            self.expect_one(lines, found)
        else:
            self.assertEqual(lines, [])

    def dump(self, bounds):
        return dump_of_grains(self.truth).replace(OPEN, bounds)

    def test_of_dumps_must_hold_the_container(self):
        for bounds, shape, found in DUMPS:
            with self.subTest(bounds, shape=shape):
                self.expect_found(found, self.dump(bounds), shape=shape)

    def test_walls_where_grains_reach_through_are_refused(self):
        self.truth.scans[0].position[0][0] = 0.4 * self.truth.diameter[0]
        self.expect_found("must not repeat along x, where the experiment has walls and grains reach through its face: set container.shape",
                          self.dump(f"pp ff ff\n0 {X}\n0 1\n0 1"))

    def test_of_data_files_are_read(self):
        position, diameter = self.truth.scans[0].position, self.truth.diameter
        self.truth.scans = self.truth.scans[:1]
        rows = "".join(f"{k + 1} 1 {diameter[k]:.9g} 1000 {x:.9g} {y:.9g} {z:.9g}\n" for k, (x, y, z) in enumerate(position))
        for header, found in DATA:
            self.expect_found(found, f"packing\n\n{len(position)} atoms\n\n{header}\n\nAtoms # sphere\n\n{rows}", "grains.data")

    def test_of_extended_xyz_are_read(self):
        for lattice, found in (("1 0 0 0 1 0 0 0 1", None), ("1 0 0 0 1 0 0.3 0 1", "grains.xyz: the box must be upright")):
            frames = (f'{len(s.position)}\nLattice="{lattice}" Properties=species:S:1:pos:R:3:radius:R:1:id:I:1 frame={100 * s.frame}\n' + "".join(
                f"X {x:.9g} {y:.9g} {z:.9g} {self.truth.diameter[k] / 2:.9g} {k}\n" for k, (x, y, z) in enumerate(s.position))
                for s in self.truth.scans)
            self.expect_found(found, "".join(frames), "grains.xyz")

    def test_lines_without_numbers_are_refused(self):
        self.expect_found("grains.dump:7: a line of the box must begin with 2 numbers", self.dump("ff ff ff\n0 1\nx 1\n0 1"))

    def test_reversed_axes_are_compared_as_they_are_placed(self):
        for scan in self.truth.scans:
            scan.position = np.array([1, 1, -1]) * scan.position
        down = self.dump("ff ff fs\n0 1\n0 1\n-1 -0.001")  # the upper face follows the grains
        self.expect_found(None, down)
        self.assertEqual(self.of(self.guess([self.path("plate.csv"), self.path("grains.dump")]), "grains").word("z"), "-z")


if __name__ == "__main__":
    unittest.main()
