"""The paper's metrics before and after a gap is closed, for recordings with known forces. paper_metrics_test.py"""
import math
import pathlib
import sys
import unittest
from dataclasses import replace

import numpy as np

from mcdem.diagnosis.paper_metrics import paper_metrics
from mcdem.errors import InputError

sys.path.append(str(pathlib.Path(__file__).parents[1] / "observe"))
from synthetic import changed, recording, rows, with_force, with_parameters  # noqa: E402

LEVELS = 5
DISPLACEMENT_MM = 2.0 * np.arange(1, LEVELS + 1)


def stroke(stiffness, contacts=0):
    """Loading to 10 mm and unloading, in steps of 2 mm: the top force is `stiffness` times the square of the displacement [N/mm2]."""
    made = recording(levels=LEVELS, stroke=10e-3, contacts=contacts)
    made = with_force(made, stiffness * (1e3 * made.displacement) ** 2)
    return made if contacts else changed(made, coordination_number=np.full(len(made.scans), math.nan))


class PaperMetrics(unittest.TestCase):
    def forces(self, metrics):
        """(levels, 3) of experiment, before and after [N]."""
        return np.array([[row.experiment_N, row.before_N, row.after_N] for row in metrics.top_force])

    def test_before_and_after_are_correct(self):
        metrics = paper_metrics([stroke(0.01)], [stroke(0.005), stroke(0.007)], [stroke(0.011)])
        self.assertEqual(list(metrics.values), ["Rtop", "errf"])  # no contacts: without errZ and bhat
        np.testing.assert_allclose(metrics.values["Rtop"], [0.6, 1.1], rtol=1e-12)
        # Root mean square of 0.04 k^2 N over the levels: k = 1 to 5 while loading, 4 to 0 while unloading.
        force = math.sqrt(np.mean((0.04 * np.array([1, 2, 3, 4, 5, 4, 3, 2, 1, 0]) ** 2) ** 2))
        np.testing.assert_allclose(metrics.values["errf"], [0.4 * force, 0.1 * force], rtol=1e-12)
        self.assertEqual([row.displacement_mm for row in metrics.top_force], DISPLACEMENT_MM.tolist())  # rounded to a nanometre
        np.testing.assert_allclose(self.forces(metrics), np.outer(0.01 * DISPLACEMENT_MM**2, [1, 0.6, 1.1]), rtol=1e-12)

    def test_contacts_give_all_four(self):
        experiment = stroke(0.01, contacts=500)
        stronger = changed(experiment, contacts=tuple(replace(one, force=16 * one.force) for one in experiment.scans.contacts))
        metrics = paper_metrics([experiment], [stronger], [experiment])
        self.assertEqual({name: after for name, (_, after) in metrics.values.items()}, {"Rtop": 1, "errf": 0, "errZ": 0, "bhat": 0})
        # Forces of exponential distributions with means in the ratio 16: B = 8/17; 450 contacts: an error of 0.03 at each of ten levels
        self.assertAlmostEqual(metrics.values["bhat"][0], -math.log(8 / 17), delta=0.04)

    def test_what_one_side_lacks_is_left_out(self):
        known = stroke(0.01, contacts=50)
        for before, after in ((stroke(0.01), known), (known, stroke(0.01))):
            self.assertEqual(list(paper_metrics([known], [before], [after]).values), ["Rtop", "errf"])

    def test_forces_are_unknown_where_a_simulation_did_not_get(self):
        whole = stroke(0.01)
        short = rows(whole, whole.displacement < 7e-3)
        forces = self.forces(paper_metrics([whole], [short], [whole]))
        self.assertEqual(np.isnan(forces).tolist(), [[False] * 3] * 3 + [[False, True, False]] * 2)

    def test_an_experiment_without_levels_is_an_error(self):
        with self.assertRaisesRegex(InputError, "reference: must have scans"):
            paper_metrics([with_parameters(stroke(0.01), protocol__discard="1")], [stroke(0.01)], [stroke(0.01)])


if __name__ == "__main__":
    unittest.main()
