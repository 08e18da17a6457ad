"""What an experiment lacks for a diagnosis."""
import pathlib
import sys
import unittest
from unittest import mock

import numpy as np
sys.path.append(str(pathlib.Path(__file__).parents[1] / "experiment"))
from lattice import first_scans, lattice, with_measurement, with_recording, with_scans

from mcdem.diagnosis.needed import needed_to_diagnose
from mcdem.results import NO_CONTACTS
from mcdem.results.recording import NO_VECTORS


class Needed(unittest.TestCase):
    def needed(self, experiment, known=8, displacements=(0.002, 0.004, 0.0061234, 0.008)):
        """`known`: number of points of the comparison that have a force."""
        with mock.patch("mcdem.diagnosis.needed.compared_forces", return_value=(list(displacements), known)):
            return needed_to_diagnose(experiment)

    def test_nothing_of_a_whole_experiment(self):
        self.assertEqual(self.needed(lattice()), [])
        self.assertEqual(self.needed(lattice(), known=4), [])

    def test_each_lack_is_told_with_its_remedy(self):
        without_rest = tuple(one if s else np.zeros((0, 3)) for s, one in enumerate(lattice().recording.scans.position))
        for spoilt, found in (
                (with_scans(lattice(), position=without_rest), "lattice: grains.csv must have the positions of frame 0, from which simulations start"),
                (with_recording(lattice(), plate_start=0.087), "lattice: plate.csv must have loading frames below plate.start"),
                (with_scans(lattice(), phase=np.ones(9, int)), "lattice: plate.csv must have loading frames below plate.start"),
                (first_scans(lattice(), 1), "lattice: plate.csv must have loading frames below plate.start"),
                (with_measurement(lattice(), position_error=0.0), "lattice: experiment.toml must state how well positions are known: "),
                (with_measurement(lattice(), force_error=0.0), "lattice: experiment.toml must state how well the forces of contacts.csv")):
            with self.subTest(found):
                text, = self.needed(spoilt)
                self.assertTrue(text.startswith(found), text)

    def test_a_curve_needs_no_grains(self):
        curve = with_scans(with_measurement(lattice(), position_error=0.0, force_error=0.0), position=(NO_VECTORS,) * 9, contacts=(NO_CONTACTS,) * 9)
        self.assertEqual(self.needed(curve), [])

    def test_errors_of_forces_need_contacts(self):
        bare = with_scans(with_measurement(lattice(), force_error=0.0), contacts=(NO_CONTACTS,) * 9)
        self.assertEqual(self.needed(bare), [])

    def test_the_compared_displacements_need_forces(self):
        self.assertEqual(self.needed(lattice(), known=3), [
            "lattice: plate.csv must have frames with a force above 0 around 2, 4, 6.12, 8 mm of displacement, where it is compared while "
            "loading and unloading: 3 of these 8 places have one, and 4 are needed"])


if __name__ == "__main__":
    unittest.main()
