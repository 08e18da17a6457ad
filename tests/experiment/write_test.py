"""Written experiments are read back to the last digit. write_test.py"""
import gzip
import hashlib
import os
import pathlib
import tempfile
import unittest
from dataclasses import replace

import numpy as np
from numpy.testing import assert_array_equal
from recordings import recording_of

from mcdem.errors import RunError
from mcdem.experiment.experiment import Experiment, Measurement
from mcdem.experiment.read import read_experiment
from mcdem.experiment.write import experiment_files, sums_text, write_experiment
from mcdem.results.names import ContainerShape, Phase, Wall
from mcdem.results.recording import Box, Contacts

SIDE = -1 - Wall.x_min
PLATE = """frame,cycle,phase,plate_z_m,top_force_N
0,0,load,0.014285714285714287,0
1,0,unload,0.0125,0.3333333333333333
2,1,load,0.011111111111111112,0.6666666666666666
3,1,unload,0.01,1
"""
FIRST_GRAINS = """frame,grain,x_m,y_m,z_m,diameter_m
0,0,0,0.01,0.005,0.006666666666666667
0,1,0.0033333333333333335,0.01,0.005,0.01
"""
FIRST_CONTACTS = """frame,grain,partner,x_m,y_m,z_m,fx_N,fy_N,fz_N
1,0,1,0.0033333333333333335,0,0.001,1,0.3333333333333333,0.001
1,0,2,0.0033333333333333335,0,0.001,1,0.6666666666666666,0.001
1,0,x_min,0.0033333333333333335,0,0.001,1,-0.3333333333333333,0.001
1,0,plate,0.0033333333333333335,0,0.001,1,-2,0.001
"""


def contacts_of(scan):
    partner = np.array([1, 2, SIDE, -1 - Wall.plate])
    force = np.column_stack([np.full(4, float(scan)), partner / 3, np.full(4, 1e-3)])
    return Contacts(np.zeros(4, np.int64), partner, np.tile([0.01 / 3, 0, 0.001], (4, 1)), force, np.zeros(4))


def awkward(box=Box(0.1 / 3, 0.2 / 3), y=0.01):
    """Numbers without a short decimal representation, all kinds of contacts, and a frame without grains."""
    position = [[[0.01 * grain / 3, y, 0.005 / (scan + 1)] for grain in range(3)] if scan != 2 else [] for scan in range(4)]
    recording = recording_of(
        "", box, 0.1 / 7, [0.02 / 3, 0.01, 0.011], plate_z=[0.1 / (7 + scan) for scan in range(4)],
        top_force=[scan / 3 for scan in range(4)], cycle=[0, 0, 1, 1], phase=[Phase.load, Phase.unload] * 2, position=position,
        contacts={scan: contacts_of(scan) for scan in (1, 2, 3)})
    return Experiment("quotes \" and \\ and µ", recording, {"grains.youngs_modulus": 1e5 / 3, "walls.friction": 0.1 + 0.2},
                      {"grains.friction": 0.01, "walls.youngs_modulus": 1e6}, Measurement(1e-4 / 3, 5e-5, 0.05, 1e-3), 1e-4 / 7, 100 / 3,
                      200 / 3)


def changed(experiment, **scans):
    recording = experiment.recording
    return replace(experiment, recording=replace(recording, scans=replace(recording.scans, **scans)))


class Written(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="mcdem-test-")))

    def expect_same(self, a, b):
        for name in ("name", "materials", "uncertainty", "measurement", "plate_speed", "plate_pause", "plate_hold"):
            self.assertEqual(getattr(a, name), getattr(b, name), name)
        x, y = a.recording, b.recording
        self.assertEqual((x.box, x.plate_start), (y.box, y.plate_start))
        assert_array_equal(x.diameter, y.diameter)
        for name in ("cycle", "phase", "plate_z", "top_force"):
            assert_array_equal(getattr(x.scans, name), getattr(y.scans, name))
        for p, q in zip(x.scans.position, y.scans.position, strict=True):
            assert_array_equal(p.reshape(-1, 3), q.reshape(-1, 3))
        for p, q in zip(x.scans.contacts, y.scans.contacts, strict=True):
            for name in ("grain", "partner", "point", "force"):
                assert_array_equal(getattr(p, name).ravel(), getattr(q, name).ravel(), name)

    def expect_read_back(self, experiment, **how):
        write_experiment(self.folder, experiment, **how)
        self.expect_same(experiment, read_experiment(self.folder))

    def test_experiments_are_read_back_to_the_last_digit(self):
        for packed in (False, True, False):
            self.expect_read_back(awkward(), gzip=packed)
            self.assertEqual(set(os.listdir(self.folder)),
                             {"experiment.toml", *(name + ".gz" * packed for name in ("plate.csv", "grains.csv", "contacts.csv"))})

    def test_tables_have_the_shortest_digits(self):
        plain, packed = (experiment_files(awkward(), gzip) for gzip in (False, True))
        self.assertEqual(list(plain), ["contacts.csv", "experiment.toml", "grains.csv", "plate.csv"])
        self.assertEqual(plain["plate.csv"].decode(), PLATE)
        self.assertTrue(plain["grains.csv"].decode().startswith(FIRST_GRAINS), plain["grains.csv"])
        self.assertTrue(plain["contacts.csv"].decode().startswith(FIRST_CONTACTS), plain["contacts.csv"])
        for name in ("contacts.csv", "grains.csv", "plate.csv"):
            self.assertEqual(packed[name + ".gz"][:10], b"\x1f\x8b\x08\0\0\0\0\0\0\x03", "no time stamp and no name")
            self.assertEqual(gzip.decompress(packed[name + ".gz"]), plain[name])

    def test_sums_are_those_of_sha256sum(self):
        self.assertEqual(sums_text({"b": b"x", "a": b""}), f"{hashlib.sha256(b'x').hexdigest()}  b\n{hashlib.sha256().hexdigest()}  a\n")

    def test_containers_are_read_back_with_their_walls(self):
        for shape in (ContainerShape.cylinder, ContainerShape.periodic):
            experiment = awkward(Box(0.1 / 3, 0.1 / 3, shape), 0.05 / 3)
            contacts = experiment.recording.scans.contacts
            if shape == ContainerShape.periodic:
                contacts = tuple(one.rows(one.partner != SIDE) for one in contacts)
            self.expect_read_back(changed(experiment, contacts=contacts))
            table = (self.folder / "contacts.csv").read_text()
            self.assertNotIn("x_min", table)
            self.assertEqual(",side," in table, shape == ContainerShape.cylinder)

    def test_contacts_below_the_stated_threshold_are_kept(self):
        experiment = awkward()
        experiment.recording.scans.contacts[1].force[0] = (0, 0, 0.999e-3)
        self.expect_read_back(experiment)

    def test_without_grains_and_contacts_those_tables_are_not_written(self):
        experiment = awkward()
        write_experiment(self.folder, experiment, gzip=True)
        bare = changed(experiment, position=(np.zeros((0, 3)),) * 4, contacts=tuple(one.rows(slice(0)) for one in
                                                                                   experiment.recording.scans.contacts))
        bare = replace(bare, recording=replace(bare.recording, diameter=np.zeros(0)))
        self.expect_read_back(bare)  # replaces the compressed table: no old table may remain
        self.assertEqual(set(os.listdir(self.folder)), {"experiment.toml", "plate.csv"})

    def test_what_cannot_be_written_is_named(self):
        (self.folder / "plate.csv").mkdir()
        (self.folder / "plate.csv/there").touch()
        with self.assertRaises((RunError, OSError)) as refused:
            write_experiment(self.folder, awkward())
        self.assertIn(f"{self.folder}/plate.csv", str(refused.exception))
        self.assertFalse((self.folder / "experiment.toml").exists())


if __name__ == "__main__":
    unittest.main()
