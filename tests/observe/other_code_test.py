"""The metrics of curves that LIGGGHTS computed for the authors' packing. other_code_test.py

MCDEM_SHARED_DATA names the folder of the data (tests/README.md); exit code 77: they are not there
"""
import csv
import os
import pathlib
import sys
import unittest

import numpy as np
from synthetic import scans, with_force

from mcdem.observe.compare import compare
from mcdem.observe.replicas import Setting
from mcdem.results import Box, Phase, Recording

DATA = pathlib.Path(os.environ.get("MCDEM_SHARED_DATA") or pathlib.Path(__file__).parents[3] / "shared/data") / "hydrogel"
HERTZ, HALF_SPACE = (DATA / f"liggghts_{name}.csv" for name in ("hertz", "half_space_gamma_1"))


def curve(file):
    with file.open(encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    made = scans(len(rows), phase=np.array([Phase[row["phase"]] for row in rows]), coordination_number=np.full(len(rows), np.nan),
                 plate_z=-1e-3 * np.array([float(row["plate_displacement_mm"]) for row in rows]))
    return with_force(Recording(file.stem, {}, Box(), 0.0, np.zeros(0), made), [float(row["top_force_N"]) for row in rows])


class OtherCode(unittest.TestCase):
    def test_the_ratio_of_its_peaks_is_known(self):
        one = compare(Setting("hertz", [curve(HERTZ)]), [curve(HALF_SPACE)])
        self.assertAlmostEqual(one.Rtop.value, 6.69 / 13.29, delta=6e-4)  # both peaks are rounded to 0.01 N
        self.assertEqual(one.levels_errf, one.reference_levels)
        self.assertGreater(one.errf.value, 1)
        self.assertFalse(one.errZ.available())


if __name__ == "__main__":
    if missing := [file for file in (HERTZ, HALF_SPACE) if not file.exists()]:
        print(f"the authors' data are not here (tests/README.md): {missing[0]}")
        sys.exit(77)
    unittest.main()
