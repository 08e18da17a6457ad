"""Libraries are read back as they were written; files that are not valid libraries are refused. library_test.py"""
import hashlib
import json
import math
import os
import pathlib
import tempfile
import unittest

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
from synthetic_evidence import GRID, SyntheticWorld

from mcdem.diagnosis.library import Library, apart_from_mean, library_text, read_library, scatter, write_library
from mcdem.observe.grid import Grid, HoldScans
from mcdem.errors import InputError, RunError
from mcdem.results.names import Phase


def some_library():
    world = SyntheticWorld(2, 1)
    evidence = world.evidence(2, 3)
    world.add_effect(evidence, "adhesion", world.pattern(0.1))
    world.add_nuisance(evidence, "modulus", world.pattern(1 / 3), 1)
    library = evidence.library
    library.effects[0].curvature = world.pattern(1e-17)
    library.effects[0].linear = world.noise()  # NaN beyond the first bins
    library.provenance = {"program": "0.1", "device": '"any" \N{GREEK SMALL LETTER MU}\t'}
    library.origin = {"grains.friction": "0.03", "box.size_x": "1"}
    holds = [HoldScans(3, 4, 5, "force", Phase.unload, 0.01 / 3)]
    library.grid = Grid(GRID.displacement, GRID.width, GRID.stroke, [0.1] * len(GRID.displacement), 1 / 7, holds)
    return library


class LibraryFile(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "library.json"
        self.library = some_library()
        self.assertTrue(write_library(self.file, self.library))
        self.content = json.loads(self.file.read_bytes())

    def write(self, content):
        self.file.write_text(json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False))

    def expect_refused(self, why):
        with self.assertRaises(InputError) as caught:
            read_library(self.file)
        self.assertIn(why, str(caught.exception))

    def expect_same_signatures(self, found, expected):
        self.assertEqual([(s.name, s.reach, s.pairs()) for s in found], [(s.name, s.reach, s.pairs()) for s in expected])
        for a, b in zip(found, expected):
            for name in ("linear", "curvature", "slopes"):
                assert_array_equal(getattr(a, name), getattr(b, name))

    def test_is_read_back_as_written(self):
        back = read_library(self.file)
        for name in ("grid", "packing", "provenance", "origin"):
            self.assertEqual(getattr(back, name), getattr(self.library, name))
        assert_array_equal(back.baseline, self.library.baseline)
        self.expect_same_signatures(back.effects, self.library.effects)
        self.expect_same_signatures(back.nuisances, self.library.nuisances)
        self.assertEqual(library_text(back).encode(), self.file.read_bytes())
        self.assertEqual(os.listdir(self.file.parent), [self.file.name])

    def test_has_its_digests(self):
        """Of the sorted origin, and of the compact text without the digest."""
        self.assertEqual(self.content["origin_sha256"], hashlib.sha256(b"box.size_x=1\ngrains.friction=0.03\n").hexdigest())
        digest = self.content.pop("sha256")
        self.write(self.content)
        self.assertEqual(hashlib.sha256(self.file.read_bytes()).hexdigest(), digest)

    def test_an_infinite_number_is_unknown_and_signatures_may_have_no_pairs(self):
        self.library.nuisances[0].linear[1] = math.inf
        self.library.nuisances[0].slopes = np.zeros((0, 0))
        self.file.unlink()
        write_library(self.file, self.library)
        back = read_library(self.file).nuisances[0]
        self.assertTrue(math.isnan(back.linear[1]))
        self.assertEqual(back.slopes.shape, (0, 0))

    def test_may_hold_members_that_former_programs_wrote_and_numbers_in_other_digits(self):
        self.content.pop("sha256")
        for effect in self.content["effects"]:
            effect["variance"] = effect["linear"]
        self.write(self.content)
        self.expect_same_signatures(read_library(self.file).effects, self.library.effects)
        text = self.file.read_text().replace('"reach":10.0', '"reach":1.00000000000000000e1')
        digest = hashlib.sha256(text.encode()).hexdigest()
        self.file.write_text(text.replace('"stroke"', f'"sha256":"{digest}","stroke"'))
        self.expect_same_signatures(read_library(self.file).effects, self.library.effects)

    def test_is_not_overwritten(self):
        before = self.file.read_bytes()
        self.library.packing[0] = 7
        self.assertFalse(write_library(self.file, self.library))
        self.assertEqual(self.file.read_bytes(), before)
        self.assertEqual(os.listdir(self.file.parent), [self.file.name])
        with self.assertRaisesRegex(RunError, "cannot be written"):
            write_library(self.file.parent / "nowhere" / "library.json", self.library)

    def test_is_refused_if_missing_or_damaged(self):
        text = self.file.read_text()
        for damaged in (text[: len(text) // 2], "[]", "3", '{"format":4}', text.replace('"baseline":[[', '"baseline":[["x",'), "["*100000):
            self.file.write_text(damaged)
            self.expect_refused("not a signature library")
        self.file.write_bytes(b"\xff")
        self.expect_refused("not a signature library")
        self.file.unlink()
        self.expect_refused("there is no signature library")
        self.file.mkdir()
        self.expect_refused("must be a file")

    def test_is_refused_if_it_cannot_be(self):
        def without_first(rows):
            for row in rows:
                del row[0]

        changes = (
            (lambda j: j.update(format=j["format"] + 1), "of another version"),
            (lambda j: j.pop("baseline"), "not a signature library"),
            (lambda j: j["origin"].update({"grains.friction": "0.9"}), "what it says of its origin was changed"),
            (lambda j: j["baseline"][0].__setitem__(0, 7.5), "it was changed since it was written"),
            (lambda j: j["baseline"][2].pop(0), "its rows are of unequal length"),
            (lambda j: without_first(j["baseline"]), "it has other observables than this program"),
            (lambda j: without_first(j["effects"][0]["slopes"]), "it has other observables than this program"),
            (lambda j: j["baseline"].pop(), "it has another number of replicates than packings"),
            (lambda j: j["force"].pop(), "it has another number of forces than displacements"),
            (lambda j: j["holds"][0].update(begin=6), "it has a hold that cannot be"),
            (lambda j: j["holds"][0].update(phase="sideways"), 'there is no "sideways"'),
            (lambda j: j["holds"][0].update(keep="nothing"), 'there is no "nothing"'),
            (lambda j: j["effects"][0]["linear"].pop(), "signature adhesion is of another length"),
            (lambda j: j["effects"][0]["curvature"].pop(), "signature adhesion is of another length"),
            (lambda j: j.update(packing=[]), "it has no replicates"),
        )
        for change, why in changes:
            content = json.loads(json.dumps(self.content))
            change(content)
            self.write(content)
            with self.subTest(why):
                self.expect_refused(why)


class Scatter(unittest.TestCase):
    def of(self, packing, values):
        return scatter(Library(GRID, np.array(values, float)[:, None], packing))[:, 0]

    def test_is_that_of_one_replicate_within_its_packing(self):
        two, three = math.sqrt(2), math.sqrt(1.5)
        assert_allclose(self.of([0, 1, 0, 1, 1], [1, 10, 3, 20, 30]), [-two, -10 * three, two, 0, 10 * three], atol=1e-12)

    def test_is_the_scatter_over_packings_if_replicates_are_single(self):
        assert_allclose(self.of([0, 1, 2], [1, 2, 6]), math.sqrt(1.5) * np.array([-2, -1, 3]))

    def test_a_single_row_of_a_group_has_none(self):
        rows = np.array([[1.0], [2], [5]])
        assert_allclose(apart_from_mean(rows, [0, 0, 1])[:, 0], math.sqrt(2) * np.array([-0.5, 0.5, 0]))
        assert_array_equal(rows[:, 0], [1, 2, 5])

    def test_has_the_variance_of_one_replicate(self):
        apart = scatter(SyntheticWorld(2, 5).evidence(500, 2).library)
        self.assertAlmostEqual((apart[:, 3] ** 2).sum() / 1000, 1, delta=0.25)  # 500 degrees of freedom: 0.063


if __name__ == "__main__":
    unittest.main()
