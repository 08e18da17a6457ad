"""Table and figure of a convergence study show its numbers."""
import dataclasses
import unittest

from mcdem.convergence.convergence_types import CauseErrors, BinError, Convergence, Limits
from mcdem.observe.observables import observables
from mcdem.report.convergence import convergence_figure_values, table_of_convergence
from mcdem.report.text_table import to_text

OBSERVABLES = [one.name for one in observables()]


def example():
    """Two causes: the first makes the top force 2 % too large while loading at 10 mm; everything else is within limits."""
    def bin(name, error, standard_error, beyond=False):
        limit = {"top_force": 0.005, "mean_force": 0.005}.get(name, 0.05)
        return BinError(name, "load", 10.0, 1.0, 0.1, error, standard_error, True, limit, beyond)

    def bins(error, standard_error):
        return [bin(name, error, standard_error) for name in OBSERVABLES for _ in range(4)]

    speed = bins(0.001, 0.0005)
    speed[0] = bin("top_force", 0.02, 0.002, True)
    margin = bins(-0.0005, 0.0005)
    margin[2] = bin("top_force", -0.0009, 0.0005)  # the largest of this cause
    return Convergence("small", 32, "jittered copies of one packing", ("Not converged.",), Limits(0.005, 0.5),
                       (CauseErrors("plate speed", tuple(speed)), CauseErrors("list margin", tuple(margin))), 1.0)


class ConvergenceTest(unittest.TestCase):
    def test_the_table_marks_errors_beyond_their_limit(self):
        text = to_text(table_of_convergence(example()))
        for part in ("+2.00 +- 0.20 % *", "-0.09 +- 0.05 %", "+0.01 +- 0.01 sd", "32 jittered copies of one packing",
                     "*: beyond 0.5 % (forces) or 0.5 sd"):
            self.assertIn(part, text)
        self.assertEqual(text.count(" *\n") + text.count(" *  "), 1)

    def test_the_figure_has_a_row_per_observable_and_a_series_per_cause(self):
        values = convergence_figure_values(example())
        self.assertEqual((len(values["rows"]), values["causes"][0]["words"], values["rows"][0]["words"]),
                         (len(OBSERVABLES), "plate speed", "top force"))
        self.assertAlmostEqual(values["rows"][0]["errors"][0]["over_limit"], 4)  # 2 % over 0.5 %
        self.assertAlmostEqual(values["rows"][0]["errors"][0]["standard_error"], 0.4)

    def test_an_observable_without_errors_of_a_cause_has_a_gap(self):
        speed, margin = example().causes
        made = dataclasses.replace(example(), causes=(speed, CauseErrors("list margin", margin.errors[:4])))
        self.assertEqual(table_of_convergence(made).rows[1][2], "-")
        self.assertIsNone(convergence_figure_values(made)["rows"][1]["errors"][1])


if __name__ == "__main__":
    unittest.main()
