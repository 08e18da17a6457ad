"""The examples of CONTRIBUTING.md work as they stand there. contributing_test.py"""
import pathlib
import re
import subprocess
import sys
import unittest

import numpy as np
from small_trials import Small

from mcdem.diagnosis import effects

TEXT = (pathlib.Path(__file__).parents[2] / "CONTRIBUTING.md").read_text()


def examples(section):
    """The code blocks of a section."""
    return re.findall(r"^```py\n(.*?)^```$", TEXT.partition(f"\n## {section}\n")[2].partition("\n## ")[0], re.M | re.S)


class Examples(unittest.TestCase):
    def test_an_effect_is_a_candidate_and_a_parameter_is_refitted(self):
        effect, nuisance = (eval(block, vars(effects)) for block in examples("Adding an effect to the diagnosis"))
        small = Small(self)
        plan = small.plan(candidates=[effect], nuisances=[nuisance])
        self.assertEqual([probe.amplitudes for probe in plan.probes()], [(-0.3, -0.1), (-0.02, 0.02)])
        self.assertAlmostEqual(effect.apply(small.model, -0.3)["grains.restitution"], small.model["grains.restitution"] - 0.3, 12)
        rows = small.observe(small.trial(1), small.trial(1, effect.apply(small.model, -0.3)))
        self.assertTrue(np.isfinite(rows[:, 0]).all())
        self.assertNotEqual(rows[0, 0], rows[1, 0], "the simulation has it")

    def test_an_observable_is_in_the_table_and_has_a_value(self):
        """In a process of its own, before the table is read."""
        block, = examples("Adding an observable")
        code = f"""
import numpy as np
from mcdem.observe import force_observables
exec({block!r}, vars(force_observables))
from scans_by_hand import SOFT, Lattice
from mcdem.observe.observables import index_of, observables
from mcdem.observe.observation import scan_observables
lattice = Lattice(5)
lattice.contacts.force[:40] *= 0.5
row = scan_observables(lattice.recording(), [0], SOFT)[0]
mean = (40 * 0.5 + (len(lattice.contacts) - 40)) / len(lattice.contacts)
assert observables()[index_of("weakest_force")].meaning.startswith("5 % quantile")
np.testing.assert_allclose(row[index_of("weakest_force")], 0.5 / mean)
"""
        scans = str(pathlib.Path(__file__).parents[1] / "observe")
        made = subprocess.run([sys.executable, "-c", f"import sys; sys.path.append({scans!r}); import mcdem\n{code}"], capture_output=True, text=True)
        self.assertEqual((made.returncode, made.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
