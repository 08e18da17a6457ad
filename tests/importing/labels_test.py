"""Labels of tomographs: linked from frame to frame by places; contacts without forces; tables of one tomograph joined by their labels."""
import re
import unittest

import numpy as np

from lab import ImportCase, Style
from mcdem.importing.links import LOST, link
from mcdem.importing.mapping import Known

SIDE = 6  # grains along an edge
SPACING = 0.01  # [m]


def lattice(compression=0.0, noise=0.0, seed=1):
    """Centres of grains in a box that is compressed from above [m], shifted from a lattice by up to an eighth of the spacing."""
    random, noisy = np.random.default_rng(1), np.random.default_rng(seed)
    places = np.array(np.meshgrid(*[np.arange(SIDE)] * 3)).reshape(3, -1).T + 0.5 + random.uniform(-0.12, 0.12, (SIDE**3, 3))
    return SPACING * (places * [1, 1, 1 - compression] + noise * noisy.normal(size=places.shape))


class Links(unittest.TestCase):
    def test_find_all_grains_whatever_their_order(self):
        """Moves up to a quarter of the packing's height, with a scatter of 6 % of the spacing."""
        for compression in (0.02, 0.1, 0.25):
            with self.subTest(compression=compression):
                before, now = lattice(), lattice(compression, 0.06)
                order = np.random.default_rng(2).permutation(len(now))
                found = link(before, now[order])
                np.testing.assert_array_equal(order[found.row], np.arange(len(now)))
                np.testing.assert_array_equal(found.position, now)

    def test_of_lost_grains_are_none_and_neighbours_tell_their_places(self):
        before, now = lattice(), lattice(0.1, 0.02)
        lost = [3, 77, 120]
        found = link(before, np.delete(now, lost, axis=0))
        self.assertEqual(np.flatnonzero(found.row == LOST).tolist(), lost)
        self.assertLess(np.linalg.norm(found.position[lost] - now[lost], axis=1).max(), 0.15 * SPACING)

    def test_prefer_grains_to_their_fragments(self):
        before, now = lattice(), lattice(0.05)
        fragments = now[[10, 50]] + [0.3 * SPACING, 0, 0]
        found = link(before, np.vstack([fragments, now]))
        np.testing.assert_array_equal(found.row, np.arange(len(now)) + 2)


class Tomographs(ImportCase):
    """Three frames in SPAM's format, each with labels of its own, from 1 in the order of the heights."""

    def setUp(self):
        super().setUp()
        self.known = Known(box=(SIDE * SPACING,) * 2, voxel_size=1e-4, plate_start=SIDE * SPACING)
        self.frames = [lattice(part, 0.01, seed) for seed, part in enumerate((0, 0.04, 0.08))]
        self.labels = [1 + np.argsort(np.argsort(at[:, 2] + 1e-3 * np.random.default_rng(n).normal(size=len(at)))) for n, at in enumerate(self.frames)]
        self.write("plate.csv", "frame,plate_z_mm,force_N\n" + "".join(f"{n},{600 * SPACING * (1 - part) * 10:.6g},{50 * part}\n"
                                                                       for n, part in enumerate((0, 0.04, 0.08))))

    def write_grains(self, without=(), more=()):
        files = []
        for n, (at, labels) in enumerate(zip(self.frames, self.labels)):
            rows = [[str(label), *(place / 1e-4)[::-1], 100] for i, (label, place) in enumerate(zip(labels, at)) if n == 0 or i not in without]
            rows += [[str(900 + k), *(place / 1e-4)[::-1], 30] for k, place in enumerate(more) if n == 1]
            files.append(self.write(f"grains_{n}.csv", Style(",", ".").table(["Label", "Zpos", "Ypos", "Xpos", "diameter"], rows)))
        return files

    def imported_of(self, files):
        tables = self.guess([self.path("plate.csv"), *files])
        text = re.sub('origin_([xyz]) = "[^"]*"', r'origin_\1 = "0"', self.accepted(tables))
        return tables, self.imported(self.by_mapping(text))

    def positions(self, imported):
        return imported.grains[["x_m", "y_m", "z_m"]].to_numpy().reshape(3, -1, 3)

    def truth_of(self, frame):
        return self.frames[frame][np.argsort(self.labels[0])]

    def test_are_linked(self):
        same = np.mean(self.labels[0] == self.labels[1])
        self.assertLess(same, 0.4)  # as reported of SPAM's
        tables, imported = self.imported_of(self.write_grains())
        grains = self.of(tables, "grains")
        self.assertEqual((grains.word("labels"), grains["labels"].certainty), ("linked", "likely"))
        for frame, at in enumerate(self.positions(imported)):
            np.testing.assert_allclose(at, self.truth_of(frame), atol=1e-9)
        self.assertEqual([note for note in imported.notes if "frame" in note], [])

    def test_list_who_was_lost_and_doubled(self):
        _, imported = self.imported_of(self.write_grains([7, 9], [self.frames[1][20] + [0.003, 0, 0]]))
        names = ", ".join(map(str, sorted(self.labels[0][[7, 9]])))
        notes = "\n".join(imported.notes)
        for frame in (1, 2):
            self.assertIn(f"frame {frame}: 2 grains of the first frame are lost, and are put where their neighbours' displacement says: {names}", notes)
        self.assertIn("frame 1: 1 labels are no grains of the first frame, such as doubled ones, and are left out: 900", notes)
        for frame, at in enumerate(self.positions(imported)):
            self.assertLess(np.abs(at - self.truth_of(frame)).max(), 0.15 * SPACING)

    def test_that_keep_their_numbers_are_not_linked(self):
        self.labels = [self.labels[0]] * 3
        tables, _ = self.imported_of(self.write_grains())
        self.assertNotIn("labels", self.of(tables, "grains"))

    def test_of_another_packing_are_refused(self):
        self.frames[2] = SIDE * SPACING * np.random.default_rng(5).uniform(size=(SIDE**3, 3)) * [1, 1, 0.9]
        tables = self.guess([self.path("plate.csv"), *self.write_grains()])
        text = self.accepted(tables)
        text = text if "labels = " in text.replace("# labels", "#") else text.replace("# labels =", 'labels = "linked"  #')
        self.expect_among(self.problems_of(lambda: self.imported(self.by_mapping(text))), "grains must be near the places of the frame before")

    def pairs(self, frame):
        """Labels of grains nearer than 1.1 spacings."""
        at, labels = self.frames[frame], self.labels[frame]
        off = np.linalg.norm(at[:, None] - at[None], axis=2)
        return [(i, j) for i, j in zip(*np.nonzero(np.triu(off < 1.1 * SPACING, 1)))], labels

    def test_contacts_without_forces_are_kept_with_the_numbers_of_the_first_frame(self):
        files = self.write_grains()
        for frame in range(3):
            pairs, labels = self.pairs(frame)
            files.append(self.write(f"contacts_{frame}.csv", "label1,label2,nx\n" + "".join(f"{labels[i]},{labels[j]},0.5\n" for i, j in pairs)))
        tables, imported = self.imported_of(files)
        self.assertEqual(self.of(tables, "contacts").role_why, "pairs of grains that touch, without forces")
        self.assertIsNone(imported.contacts)
        number = np.argsort(np.argsort(self.labels[0]))
        for frame in range(3):
            found = imported.topology[imported.topology.frame == frame]
            wanted = sorted(tuple(sorted((number[i], number[j]))) for i, j in self.pairs(frame)[0])
            self.assertEqual(sorted(zip(found.grain, found.partner)), wanted)

    def test_tables_of_a_tomograph_are_joined_by_their_labels(self):
        label, at = self.labels[0], self.frames[0] / 1e-4
        order = np.random.default_rng(4).permutation(len(label))
        self.write("plate.csv", "frame,plate_z_mm,force_N\n0,60,0\n")
        centres = self.write("centres.csv", Style(",", ".").table(["label", "x_vox", "y_vox", "z_vox"], [[str(n), *place] for n, place in zip(label, at)]))
        sizes = self.write("sizes.csv", Style(",", ".").table(["label", "diameter_vox"], [[str(label[i]), 90 + label[i] % 20] for i in order]))
        pairs, labels = self.pairs(0)
        contacts = self.write("touch.csv", "label1,label2\n" + "".join(f"{labels[i]},{labels[j]}\n" for i, j in pairs))
        tables, imported = self.imported_of([centres, sizes, contacts])
        self.assertEqual([table.role for table in tables], ["plate", "grains", "contacts"])
        self.assertEqual(self.of(tables, "grains").joined, [sizes])
        np.testing.assert_allclose(imported.grains.diameter_m, 1e-4 * (90 + np.sort(label) % 20), rtol=1e-9)
        self.assertEqual(len(imported.topology), len(pairs))
        self.write("sizes.csv", "label,diameter_vox\n1,90\n")
        self.expect_among(self.problems_of(lambda: self.guess([self.path("plate.csv"), centres, sizes])), "must have a row for each label of")


if __name__ == "__main__":
    unittest.main()
