"""An experiment of any size, compared with a part of it: [sample]."""
import math
import unittest
from dataclasses import replace

import numpy as np
from small_folder import FolderCase

import mcdem
from mcdem.errors import InputError
from mcdem.experiment.sample import EMPTY_HEIGHT, Sample, part_of
from mcdem.experiment.settings import settings_text
from mcdem.experiment.write import write_experiment
from mcdem.experiment.read import read_experiment
from mcdem.results.engine_run import run_of
from mcdem.results.names import ContainerShape, Phase

BED = """name = "a bed"
[sample]
height = 0.022
diameter = 0.05
"""
# Of grains of 1 mm: {count} of them in a period of {size}.
SCENE = """name = "part"
[container]
shape = "periodic"
size_x = {size}
size_y = {size}
[grains]
youngs_modulus = 1e6
poisson_ratio = 0.3
density = 1000
excess_density = 0
friction = 0.3
[contact]
model = "independent"
[packing]
count = {count}
diameter_mean = 1e-3
diameter_sd = 1e-4
diameter_min = 8e-4
diameter_max = 1.2e-3
packing_fraction = 0.6
[plate]
start = {start}
end = {end}
[protocol]
scans_per_stroke = 4
"""


def scene(count=60, size=4e-3, start=3.35e-3, end=3.0e-3, **keys):
    return mcdem.Scene.parse(SCENE.format(count=count, size=size, start=start, end=end), set={key.replace("__", "."): value for key, value in keys.items()})


EMPTY = EMPTY_HEIGHT * 1e-3


class Samples(FolderCase):
    def setUp(self):
        super().setUp()
        self.texts = {"experiment.toml": BED, "plate.csv": self.texts["plate.csv"]}

    def test_strains_and_stresses_are_those_of_the_sample(self):
        self.replace("experiment.toml", "[sample]", "[uncertainty]\nplate.start = 2.2e-4\n[plate]\nspeed = 1e-3\n[sample]")
        sample = self.read()
        self.assertEqual((sample.recording.box.size_x, sample.recording.plate_start), (0.05, 0.022))
        part = part_of(sample, scene())
        scans, of_sample = part.recording.scans, sample.recording.scans
        np.testing.assert_allclose(1 - (scans.plate_z - EMPTY) / (3.35e-3 - EMPTY), 1 - of_sample.plate_z / 0.022, atol=1e-12)
        np.testing.assert_allclose(scans.top_force / 4e-3**2, of_sample.top_force / (math.pi / 4 * 0.05**2))
        self.assertEqual((part.recording.box.shape, part.recording.box.size_x, part.sample), (ContainerShape.periodic, 4e-3, None))
        self.assertAlmostEqual(part.uncertainty["plate.start"], 0.01 * (3.35e-3 - EMPTY))
        self.assertAlmostEqual(part.plate_speed, 1e-3 * (3.35e-3 - EMPTY) / 0.022)  # the same rate
        self.assertIs(part_of(part, scene()), part)

    def test_what_is_stated_is_written_and_read_again(self):
        self.replace("experiment.toml", "diameter = 0.05", "area = 2e-3\nmass = 0.066\nsolid_density = 2500.0\nwall_friction = 0.2")
        sample = self.read()
        self.assertAlmostEqual(sample.sample.packing_fraction, 0.066 / (2500 * 2e-3 * 0.022))
        write_experiment(self.place / "again", sample)
        self.assertEqual(read_experiment(self.place / "again").sample, sample.sample)
        self.assertNotIn("[box]", settings_text(sample))

    def test_a_programme_has_the_places_forces_and_speeds_of_the_part(self):
        self.texts["experiment.toml"] += ("[[programme]]\nposition = 0.019\nspeed = 1e-3\nscan_at = [0.0205, 0.019]\n[[programme]]\nstage = \"cycle\"\nforce = 2.0\nback = 0.5\n"
                                          "[[programme]]\nstage = \"hold\"\ntime = 2.0\n")
        self.texts["plate.csv"] = ("frame,cycle,phase,plate_z_m,top_force_N,time_s\n0,0,load,0.022,0,0\n1,0,load,0.0205,0.2,1.5\n2,0,load,0.019,0.4,3\n"
                                   "3,0,load,0.018,2,4\n4,0,unload,0.0185,0.5,5\n5,0,unload,0.0185,0.5,7\n")
        part = part_of(self.read(), scene())
        by, area = (3.35e-3 - EMPTY) / 0.022, 4e-3**2 / (math.pi / 4 * 0.05**2)
        for key, value in (("1.position", EMPTY + 0.019 * by), ("1.speed", 1e-3 * by), ("2.force", 2 * area), ("2.back", 0.5 * area), ("3.time", 2)):
            self.assertAlmostEqual(part.recording.value(f"programme.{key}"), value, places=12)
        np.testing.assert_allclose(part.recording.value("programme.1.scan_at"), [EMPTY + 0.0205 * by, EMPTY + 0.019 * by])
        self.replace("experiment.toml", "position = 0.019\nspeed = 1e-3\nscan_at = [0.0205, 0.019]", "strain = 0.136\nscan_at = [0.068, 0.136]")
        strained = part_of(self.read(), scene()).recording
        position = 3.35e-3 * (1 - strained.value("programme.1.strain"))
        self.assertAlmostEqual((position - EMPTY) / (3.35e-3 - EMPTY), 1 - 0.136, places=12)

    def test_janssen(self):
        """Against the sum of a column of discs, each of which loses what its rim carries."""
        sample = Sample(math.pi / 4 * 0.05**2, wall_friction=0.25, lateral_ratio=0.6)
        height, discs = 0.04, 20000
        for phase, sign in ((Phase.load, 1), (Phase.unload, -1)):
            loss = sign * 0.25 * 0.6 * math.pi * 0.05 * (height / discs) / sample.area  # of the stress, in a disc
            stress = (1 - loss) ** (np.arange(discs) + 0.5)
            self.assertAlmostEqual(float(sample.mean_over_top(np.array([height]), np.array([phase]))[0]), stress.mean(), places=4)
        self.assertEqual(Sample(1.0).mean_over_top(np.array([1.0]), np.array([Phase.load]))[0], 1)

    def test_what_is_missing_or_said_twice_is_a_problem(self):
        for stated, told in (("height = 0.022", "must state diameter [m] or area [m2]"), ("diameter = 0.05", "must state height [m] at no strain, or plate.start"),
                             ("height = 0.022\ndiameter = 0.05\nmass = 1.0", "must state mass with solid_density"),
                             ("height = 0.022\ndiameter = 0.05\nmass = 1.0\nsolid_density = 1000.0", "must leave a packing fraction of at most 1, got 23.15"),
                             ("height = 0.022\ndiameter = 0.05\n[box]\nsize = [1.0, 1.0]", "leave [box] and [container] out"),
                             ("height = 0.022\ndiameter = -1", "sample.diameter must be a number > 0"),
                             ("height = 0.022\ndiameter = 0.05\ncolour = 3", "sample.colour is not a key of an experiment")):
            self.texts["experiment.toml"] = "[sample]\n" + stated + "\n"
            self.assertTrue(any(told in problem for problem in self.problems()), (told, self.problems()))

    def refusal(self, experiment, of_scene):
        with self.assertRaises(InputError) as refused:
            part_of(experiment, of_scene)
        return " ".join(refused.exception.problems)

    def test_a_part_is_of_one_bed_without_walls_and_with_its_packing_fraction(self):
        sample = self.read()
        self.assertIn("compared with a part of it by diagnose, calibrate and what-if only", self.refusal(sample, None))
        self.assertIn("container.shape must be periodic", self.refusal(sample, scene(container__shape="box")))
        dense = replace(sample, sample=replace(sample.sample, packing_fraction=0.6))
        part_of(dense, scene(start=3.45e-3))  # 60 grains of 0.536 mm3 fill 3.35 mm with 0.6
        self.assertIn("plate.start must be 0.00344911 m for a bed, where", self.refusal(dense, scene()))
        self.assertIn("little of the plate's stress reaches the floor", self.refusal(replace(sample, sample=Sample(1e-5, wall_friction=0.5)), scene()))

    def test_a_small_part_has_the_stress_of_a_large_bed(self):
        """800 grains in a height of 11 diameters, and four parts of 100 in one of 5.5. The empty height at its floor and plate is not of the large bed."""
        large = run_of(mcdem.simulate(scene(800, 7.8e-3, 11.7e-3, 10.8e-3, protocol__rate_tolerance=0.03))).recordings[0]
        of_part = scene(100, 3.9e-3, 5.9e-3, 5.45e-3, protocol__rate_tolerance=0.03, batch__replicas=4)
        small = run_of(mcdem.simulate(of_part)).recordings
        fraction = math.pi / 6 * (large.diameter**3).sum() / (7.8e-3**2 * (large.plate_start - EMPTY))
        scans = replace(large.scans, plate_z=large.scans.plate_z - EMPTY)
        bed = replace(large, parameters={}, diameter=np.zeros(0), plate_start=large.plate_start - EMPTY, scans=scans)
        part = part_of(replace(self.read(), sample=Sample(7.8e-3**2, fraction), recording=bed), of_part).recording
        loading = slice(1, 4)  # from a tenth of the largest force on
        forces = np.array([np.interp(-part.scans.plate_z[loading], -one.scans.plate_z[:4], one.scans.top_force[:4]) for one in small])
        ratio, error = forces.mean(0) / part.scans.top_force[loading], forces.std(0, ddof=1) / 2 / part.scans.top_force[loading]
        self.assertTrue((abs(ratio - 1) < 0.08 + 2 * error).all(), (ratio, error))  # another packing for each, and 1 % of strain is 25 % of the force


if __name__ == "__main__":
    unittest.main()
