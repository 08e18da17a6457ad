"""Texts of diagnoses: headline, sentence and lines of every verdict."""
import math
import re
import unittest

from diagnosis_samples import VERDICTS, bare, cause, cell, fit, missing, of, packing, sample, with_texts

from mcdem.report.diagnosis_text import diagnosis_text, verdict_lines
from mcdem.report.verdict import suspects_of, verdict_words


def changed(verdict, change):
    d = sample(verdict)
    change(d)
    return d


def line(d, about):
    return dict(verdict_lines(of(d))).get(about, "")


def add_cause(d, number, **changes):
    d["causes"].append(d["ranking"][number] | changes)


def set_in(part, **values):
    return lambda d: d[part].update(values)


def far_packings(differ):
    return lambda d: d.update(packings=[packing("out/A", 0.001, 2e-4, 1e-5, 0.3, differ[0]),
                                        packing("out/B", 0.2, 1e-4, 1e-5, 0.3, differ[1])])


def framed(*cells):
    return lambda d: d.update(where=[], cells=[cell(*one) for one in cells])


def without_gap_in_held_out_data(d):
    d["shrink"]["before"] = -0.3
    d["explanation"]["held_out"] = False


def suspect_cause(d):
    add_cause(d, 6, effect="modulus", group=["modulus", "stiffening"])


def one_displacement(p_value):
    return lambda d: d["gap"].update(p_value=p_value, p_omnibus=1e-4, p_directed=0.2)


def same(d):
    pass


UNREFINED = "consistent with a numerical error of the simulation, which must be removed before an effect is named: speed of the plate; set "

# Verdict, change of its sample, line (or "sentence", "headline"), what it contains ("^": begins with, "$": ends with, "-": lacks).
CASES = [
    ("no_gap", same, "Gap", ["^none", "p = 0.44"]),
    ("no_gap", same, "Which", ["^no effect is needed."]),
    ("no_gap", same, "Limits", ["adhesion from 0.08 mJ/m²", "and 11 more", "never show rolling resistance and bias of positions"]),
    ("no_gap", one_displacement(0.3), "Gap", ["they differ at one displacement only, where grains may have rearranged"]),
    ("no_gap", one_displacement(0.01), "Gap", ["they differ at one displacement only"]),
    ("no_gap", one_displacement(2e-4), "Gap", ["noise alone gives differences like these"]),
    ("no_gap", lambda d: d["ranking"].reverse(), "Limits", ["would show shifted force threshold from 1 mN, bias of contact forces"]),
    ("no_gap", lambda d: d.update(refinements=sample("not_converged")["refinements"][:1]), "sentence",
     ["^No gap is detectable, with plate.speed = 0.025 m/s instead of 0.1 (p = 0.44).$"]),
    ("effect", same, "Gap", ["^yes", "p = 0.004", "; 2 packings together, which agree."]),
    ("effect", same, "Which",
     ["^consistent with adhesion (0.264 ± 0.024 mJ/m²), with a probability of 87 % (18 effects were tested)"]),
    ("effect", same, "How far",
     ["^adding adhesion takes away 79 % of the gap in held-out data (unloading", "from full simulations",
      "random effects (placebo) take away at most 12 %", "21 % of the gap remains unexplained (p < 0.0001)",
      "the signatures had predicted 81 % (90 % interval: 66 to 93 %)"]),
    ("effect", same, "headline", ["^A gap; one effect takes away 79 % of the gap$"]),
    ("effect", same, "sentence", ["; adding it takes away 79 % of the gap.$"]),
    ("effect", same, "Limits",
     ["not measured: forces on the side walls", "; friction between grains has no value in 4 of 8 bins (50 %), whose gap counts as not "
      "explained by it; modulus of the grains has no value in 1 of 9 bins (11 %), which are not compared"]),
    ("effect", lambda d: d.update(missing_bins=[missing("adhesion", 4, 8, False), missing("plasticity", 4, 8, False),
                                                missing("", 2, 10, True)]), "Limits",
     ["; adhesion and plasticity have no value in 4 of 8 bins (50 %), whose gap counts as not explained by it; some runs of the scene as "
      "it stands have no value in 2 of 10 bins"]),
    ("effect", lambda d: add_cause(d, 2), "Which",
     ["mJ/m²) together with friction between grains (0.0182 ± 0.0048 higher than in the scene)"]),
    ("effect", lambda d: add_cause(d, 2), "How far", ["^adding adhesion and friction between grains takes away 79 %"]),
    ("effect", lambda d: add_cause(d, 2), "sentence",
     ["together with friction between grains", "; adding both takes away 79 % of the gap.$"]),
    ("effect", lambda d: add_cause(d, 2), "headline", ["^A gap; a pair of effects takes away 79 % of the gap$"]),
    ("effect", without_gap_in_held_out_data, "How far", ["of the whole gap: the held-out data alone show none", "-had predicted"]),
    ("effect", set_in("explanation", held_out=False), "How far", ["-had predicted"]),
    ("effect", set_in("shrink", before=-0.3), "How far", ["in held-out data", "-had predicted"]),
    ("effect", lambda d: d.update(explanation=None), "How far", ["^not known: nothing was tried.$"]),
    ("effect", set_in("explanation", leaves_more_than_noise=False), "How far",
     ["the remainder cannot be distinguished from noise", "-remains unexplained", "-rearranged"]),
    ("effect", set_in("explanation", leaves_more_than_noise=False, without="13.6 mm of loading"), "How far",
     [", except at 13.6 mm of loading, where grains may have rearranged"]),
    ("group", same, "Gap", ["-packings"]),
    ("group", same, "Which",
     ["adhesion (0.264", "contacts made by surface displacement (0.332", "and friction between grains (0.0182", "cannot tell them apart",
      "-together with"]),
    ("group", same, "sentence",
     ["any of adhesion, contacts made by surface displacement and friction between grains, which these data cannot tell apart; adding the "
      "first of them takes away 64 %"]),
    ("group", far_packings((False, False)), "Gap", ["; 2 packings together, which agree."]),
    ("group", far_packings((False, False)), "Limits", ["-difference between packings"]),
    ("group", far_packings((False, True)), "Gap", ["of which out/B differs from the others by more than noise"]),
    ("group", far_packings((False, True)), "Limits", ["a difference between packings is not an effect"]),
    ("group", far_packings((True, True)), "Gap", ["which differ from one another by more than noise"]),
    ("group", same, "Next",
     ["^measure 3 more packings and diagnose each, to distinguish adhesion from friction (probability of success: 83 %); press a second "
      "cycle.$"]),
    ("group", lambda d: d["next"].clear(), "Next", ["^no measurement"]),
    ("unknown_effect", same, "Which",
     ["^no tested effect explains it (18 effects were tested)", "adhesion", "takes away 7 % of the gap, and 60 % would be needed"]),
    ("unknown_effect", same, "How far", ["takes away 7 % of the gap", "(placebo) take away at most 12 %"]),
    ("unknown_effect", same, "sentence", ["the best one takes away 7 % of the gap"]),
    ("unknown_effect", set_in("explanation", reduction=0.598, needed=0.602), "Which", ["a little less than is needed to name it"]),
    ("unknown_effect", set_in("explanation", reduction=0.92, placebo=0.93, needed=1.03), "Which",
     ["^these data cannot tell an effect from chance (18 effects were tested)", "takes away 92 % of the gap",
      "random effects (placebo) take away up to 93 %", "-103 %"]),
    ("unknown_effect", set_in("explanation", needed=1.03), "sentence", ["^There is a gap whose cause these data cannot tell"]),
    ("unknown_effect", set_in("explanation", needed=0.97), "sentence", ["^There is a gap that no tested effect explains"]),
    ("unknown_effect", set_in("explanation", reduction=-0.4, placebo=0.94), "Which", ["makes the gap 40 % larger.$"]),
    ("unknown_effect", set_in("explanation", reduction=-0.4), "How far", ["all of the gap remains unexplained"]),
    ("unknown_effect", set_in("explanation", reduction=-0.4), "sentence", ["the best one makes the gap 40 % larger.$"]),
    ("unknown_effect", framed(("top_force", "load", 10, 15.2, 1), ("mean_force", "load", 10, 4, -2)), "Where",
     ["^2 of 2 values are beyond 3.9 sigma with the parameters as stated (largest: top force, 15.2 sigma), and none after "
      "recalibration.$"]),
    ("unknown_effect", framed(("top_force", "load", 10, 15.2, 1), ("mean_force", "load", 10, 4, -5)), "Where",
     ["^1 of 2 values is beyond 3.9 sigma after recalibration (largest: mean force, -5.0 sigma).$"]),
    ("no_gap", framed(("mean_force", "load", 10, 4, -5)), "Where", ["sigma); with this many values, chance alone can give that.$"]),
    ("unknown_effect", framed(("top_force", "load", 10, 1, 1)), "Where", ["^no single value stands out from the noise.$"]),
    ("calibration_suspect", same, "Which", ["modulus of the grains: 2.30 ± 0.20 kPa higher than stated (4.6 times"]),
    ("calibration_suspect", same, "How far", ["^correcting the parameter"]),
    ("calibration_suspect", suspect_cause, "Which", ["cannot tell from stiffening at large strain"]),
    ("not_converged", same, "headline", ["^The simulation is not converged$"]),
    ("not_converged", same, "sentence", ["; set plate.speed = 0.0125 m/s instead of 0.025.$"]),
    ("not_converged", same, "Gap", [", with plate.speed = 0.025 m/s instead of 0.1 (p"]),
    ("not_converged", same, "Which", [f"^{UNREFINED}plate.speed"]),
    ("not_converged", same, "How far", ["^refining the setting takes away 85 %"]),
]


class Texts(unittest.TestCase):
    def expect(self, text, part):
        begins, ends, lacks = part.startswith("^"), part.endswith("$"), part.startswith("-")
        part = part.lstrip("^-").removesuffix("$")
        self.assertEqual(part in text, not lacks, text)
        self.assertTrue(text.startswith(part) or not begins, text)
        self.assertTrue(text.endswith(part) or not ends, text)

    def test_cases(self):
        for verdict, change, about, parts in CASES:
            d = changed(verdict, change)
            text = getattr(verdict_words(of(d)), about) if about.islower() else line(d, about)
            for part in parts:
                with self.subTest(verdict, about=about, part=part):
                    self.expect(text, part)

    def test_the_strongest_place_is_first(self):
        d = sample("effect")
        strongest = max(d["where"], key=lambda entry: abs(entry["z_score"]))
        place, phase = strongest["observable"].replace("_", " "), strongest["phase"]
        first, last = strongest["displacement_mm"]
        self.expect(line(d, "Where"), f"^{place} while {phase}ing, at a displacement of {first} to {last} mm")
        self.expect(line(d, "Where"), f"({strongest['z_score']:.1f} sigma, {strongest['z_score_refitted']:.1f} after recalibration)")
        self.expect(line(d, "Where"), f"; and {len({entry['observable'] for entry in d['where']}) - 2} more observables.$")

    def test_every_verdict_has_six_sentences(self):
        for verdict in VERDICTS:
            for d in (sample(verdict), with_texts(sample(verdict), "a\nb\r"), bare(verdict)):
                self.assertEqual(diagnosis_text(of(d)).count("\n"), 6)
                for _, says in [*verdict_lines(of(d)), ("", verdict_words(of(d)).sentence)]:
                    self.assertRegex(says, r"[^.]\.$")
                    self.assertNotRegex(says, "[\n\r]")

    def test_no_verdict_claims_proof(self):
        for verdict in VERDICTS:
            d = of(sample(verdict))
            text = diagnosis_text(d) + verdict_words(d).sentence
            for claim in ("caused by", "because of", "is due to", "proves", "is proven"):
                self.assertNotIn(claim, text)
            if verdict not in ("no_gap", "unknown_effect"):
                self.assertTrue(dict(verdict_lines(d))["Which"].startswith("consistent with "))
                self.assertIn("consistent with", verdict_words(d).sentence)

    def test_lines_are_aligned(self):
        lines = diagnosis_text(of(sample("effect"))).splitlines()
        self.assertEqual([text[:9] for text in lines],
                         ["Gap:     ", "Where:   ", "Which:   ", "How far: ", "Limits:  ", "Next:    "])

    def test_parameters_far_from_what_is_stated_are_the_first_line(self):
        """The main cause may be a parameter: nothing before it, and nothing that hides it."""
        check = ("check what is stated: modulus of the grains must be 81.0 ± 3.6 % higher than stated to fit (at least 12 sigma) and zero "
                 "of the displacement must be 0.700 ± 0.060 mm lower than stated to fit (3.5 sigma); all that follows assumes these "
                 "shifts.")
        for verdict in VERDICTS:
            d = sample(verdict)
            before = of(d)
            d["check_first"] = [fit("modulus", math.log(1.81), 0.02, 0.05, "relative", True),
                                fit("strain_offset", -7e-4, 6e-5, 2e-4, "m", False)]
            if d["explanation"]:
                d["explanation"]["leaves_more_than_noise"] = False
                self.assertIn("cannot be distinguished from noise, with the shifts of parameters under First", line(d, "How far"))
            self.assertTrue(diagnosis_text(of(d)).startswith(f"First:   {check}\nGap:"))
            self.assertEqual(verdict_words(of(d)).sentence, f"C{check[1:]} {verdict_words(before).sentence}")
            self.assertEqual(verdict_words(of(d)).headline,
                             f"Check first: modulus of the grains (at least 12 sigma) and 1 more. {verdict_words(before).headline}")

    def test_suspects_are_the_best_parameter_or_those_at_their_bounds(self):
        d = bare() | {"nuisances": [fit("gamma", 0.2, 0.01, 0.05, "", True), fit("modulus", 0.3, 0.02, 0.05, "relative", True),
                                    fit("friction", 0.001, 0.001, 0.01, "", False)]}
        self.assertEqual([suspect.name for suspect in suspects_of(of(d))], ["modulus", "gamma"])  # 6 sigma, before 4
        d["causes"] = [cause("friction", 0.08, 0.01)]
        self.assertEqual([(suspect.name, suspect.shift, suspect.error) for suspect in suspects_of(of(d))], [("friction", 0.08, 0.01)])


def parts_of_the_gap(text):
    """All phrases like "81 % of the gap" and "makes the gap 20 % larger", the latter with a minus; not what remains of it."""
    return {*re.findall(r"((?:< )?-?[0-9]+ %) of the gap(?! remains)", text),
            *("-" + more for more in re.findall(r"gap ((?:< )?[0-9]+ %) larger", text))}


class Agreement(unittest.TestCase):
    """Wherever a number is told, it is the same."""

    def test_one_reduction_everywhere(self):
        for verdict in VERDICTS[1:]:
            for reduction, words in ((-0.2, "-20 %"), (-0.002, "-< 1 %"), (0.003, "< 1 %"), (0.604, "60 %"), (0.997, "100 %")):
                if reduction < 0 and verdict in ("effect", "group"):
                    continue  # never named
                d = sample(verdict)
                d["explanation"]["reduction"] = reduction
                self.assertEqual(parts_of_the_gap(self.all_of(d)), {words})
            self.assertEqual(parts_of_the_gap(self.all_of(d | {"explanation": None})), set())

    def all_of(self, d):
        diagnosis = of(d)
        return f"{verdict_words(diagnosis).headline}; {verdict_words(diagnosis).sentence}; {diagnosis_text(diagnosis)}"


if __name__ == "__main__":
    unittest.main()
