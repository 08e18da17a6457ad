"""The law of contacts from the gap of the overlaps, against a known law. contact_law_test.py"""
import math
import pathlib
import sys
import unittest

import numpy as np

from mcdem.diagnosis.contact_law import COEFFICIENTS, contact_laws
from mcdem.diagnosis.evidence import gap_data
from mcdem.observe.contact_residuals import Material
from mcdem.observe.grid import bins_each, bins_of
from mcdem.observe.observables import index_of

sys.path.append(str(pathlib.Path(__file__).parents[1] / "challenge"))
from known_evidence import GRID, evidence  # noqa: E402

MATERIAL, DIAMETER = Material(youngs_modulus=23.3e3, poisson_ratio=0.5), 0.02
PLACES = bins_each(len(bins_of(GRID)))


def mean_force(overlap):
    """Hertz's for two grains at an overlap over R* [N]."""
    return 4 / 3 * MATERIAL.youngs_modulus / (2 * 0.75) * (DIAMETER / 4) ** 2 * overlap**1.5


def evidence_of_law(exponent, overlap, noise=1e-6):
    """Forces that grow with the power 3/2 + exponent and are Hertz's at 0.1 R*; the mean one is Hertz's of this overlap."""
    made = evidence()
    implied = overlap * np.geomspace(0.3, 2, 60)
    measured = (implied**1.5 * 0.1**exponent) ** (1 / (1.5 + exponent))
    made.library.baseline *= noise
    made.baseline = made.baseline * noise
    made.observed = made.baseline.mean(axis=0)
    for name, value in zip(COEFFICIENTS, np.polynomial.polynomial.polyfit(implied, implied - measured, 2)):
        made.observed[index_of(name) * PLACES:][:PLACES] += value
    made.observed[index_of("mean_force") * PLACES:][:PLACES] = math.log(mean_force(overlap))
    return made


def laws_of(made):
    return contact_laws(made, gap_data(made), MATERIAL, DIAMETER)


class TheLaw(unittest.TestCase):
    def test_of_another_exponent_is_found(self):
        """A parabola follows these overlaps within 3 % of the force."""
        for exponent in (-0.15, 0.0, 0.15):
            laws = laws_of(evidence_of_law(exponent, 0.12))
            self.assertEqual(len(laws), PLACES)
            self.assertEqual([law.phase for law in laws], ["load"] * 4 + ["unload"] * 4)
            self.assertEqual([law.displacement_mm for law in laws[:4]], [4, 6, 8, 9.8])
            for law in laws:
                expected = (np.array(law.overlap) / 0.1) ** exponent - 1
                np.testing.assert_allclose(law.change, expected, atol=0.03)
                self.assertAlmostEqual(law.exponent, 1.5 + exponent, delta=0.02)

    def test_errors_are_those_of_the_noise(self):
        """Three standard deviations of a hundred draws, which scatter by 7 %, are compared with the stated errors."""
        random, exact = np.random.default_rng(4), evidence_of_law(0.1, 0.12, noise=2e-4)
        data = gap_data(exact)
        chosen = [index_of(name) * PLACES for name in COEFFICIENTS]
        rows = data.noise[:, chosen]
        sigma = np.linalg.cholesky((1 + 1 / data.mean_of) * rows.T @ rows / len(rows))
        gap, drawn = data.gap.copy(), []
        for _ in range(100):
            data.gap = gap.copy()
            data.gap[chosen] += sigma @ random.standard_normal(3)
            drawn.append(contact_laws(exact, data, MATERIAL, DIAMETER)[0])
        data.gap = gap
        law = contact_laws(exact, data, MATERIAL, DIAMETER)[0]
        self.assertAlmostEqual(np.std([one.exponent for one in drawn]) / law.exponent_error, 1, delta=0.25)
        self.assertAlmostEqual(np.std([one.change[4] for one in drawn]) / law.change_error[4], 1, delta=0.25)

    def test_needs_forces_and_positions(self):
        made = evidence_of_law(0.1, 0.12)
        made.observed[index_of("overlap_slope") * PLACES:][:4] = math.nan
        self.assertEqual([law.phase for law in laws_of(made)], ["unload"] * 4)


if __name__ == "__main__":
    unittest.main()
