"""The plan of a challenge: drawn from one seed, with the given numbers, amplitudes and an even distribution. plan_test.py"""
import collections
import json
import dataclasses
import math
import pathlib
import unittest

from mcdem.challenge.outside_effects import OUTSIDE_EFFECTS
from mcdem.challenge.case import CaseKind, in_first_half
from mcdem.challenge.plan import CHALLENGED_EFFECTS, ChallengeSize, SceneFacts, draw_challenge
from mcdem.challenge.truth import parse_truth, seal_of, truth_text
from mcdem.diagnosis.effects import EFFECTS, find_effect
from mcdem.errors import InputError

# Of scenes/challenge.toml; 1 for all other effects.
SCALES = {"friction": 0.03, "adhesion": 83.45283333333333, "buoyancy": 11.5, "diameter_error": 0.02149,
          "plate_compliance": 0.00034334763948497857}
SIGMAS = {"modulus": 0.05, "strain_offset": 0.0002149}
FACTS = SceneFacts({effect.name: SCALES.get(effect.name, 1.0) for effect in EFFECTS},
              {effect.name: "no grains have it" if effect.name == "finite_strain" else "" for effect in EFFECTS}, SIGMAS)
PUBLISHED = pathlib.Path(__file__).with_name("truth.json")


def drawn(seed, size=ChallengeSize(), tried=CHALLENGED_EFFECTS, facts=FACTS):
    return draw_challenge(size, tried, facts, "scene", seed)


def of_kind(challenge, kind):
    return [case for case in challenge.cases if case.kind == kind]


class Plan(unittest.TestCase):
    def test_one_seed_gives_one_challenge(self):
        self.assertEqual(drawn(5), drawn(5))
        self.assertNotEqual(seal_of(truth_text(drawn(5)).encode()), seal_of(truth_text(drawn(6)).encode()))

    def test_the_published_challenge_is_drawn_from_its_seed(self):
        published = parse_truth(PUBLISHED.read_bytes(), PUBLISHED)
        tried = [name for name in CHALLENGED_EFFECTS if name != "buoyancy"]
        again = draw_challenge(ChallengeSize(15, 2, 8, 8, 5, 24), tried, FACTS, published.scene_sha256, published.seed)
        without_effects = [dataclasses.replace(challenge, cases=tuple(dataclasses.replace(case, effects=()) for case in challenge.cases))
                           for challenge in (published, again)]
        self.assertEqual(*without_effects)
        for sealed, case in zip(published.cases, again.cases):
            if any(effect.name in ("box_error", "vertical_stretch") for effect in sealed.effects):
                continue  # kinds that are in the library by now; others take their place
            self.assertEqual([effect.name for effect in sealed.effects], [effect.name for effect in case.effects])
            for own, first in zip(sealed.effects, case.effects):  # weakened in steps where the packing ran away
                self.assertTrue(any(math.isclose(own.amplitude, 0.8**steps * first.amplitude) for steps in range(4)))

    def test_has_the_given_number_of_each_kind(self):
        challenge = drawn(1)
        self.assertGreaterEqual(len(CHALLENGED_EFFECTS), 10)
        self.assertEqual(collections.Counter(case.kind for case in challenge.cases),
                         {"none": 60, "effect": 8 * len(CHALLENGED_EFFECTS), "pair": 20, "unknown": 40, "outside_prior": 20})
        self.assertEqual(len(set(challenge.packing_seeds)), 24)
        self.assertEqual(len(challenge.packing_seeds), 24)
        self.assertEqual([case.folder for case in challenge.cases[:2]], ["case_0001", "case_0002"])
        self.assertEqual(len({case.seed for case in challenge.cases} - set(challenge.packing_seeds)), len(challenge.cases))

    def test_amplitudes_span_the_range_of_the_library(self):
        smallest, largest = collections.defaultdict(lambda: math.inf), collections.defaultdict(float)
        for case in of_kind(drawn(2, ChallengeSize(per_effect=40)), CaseKind.effect):
            hidden, = case.effects
            effect, over = find_effect(hidden.name), hidden.amplitude / FACTS.scales[hidden.name]
            smaller, larger = sorted((abs(effect.first), abs(effect.second)))
            self.assertTrue(0.1 * smaller * (1 - 1e-9) <= abs(over) <= 1.5 * larger * (1 + 1e-9), hidden)
            self.assertTrue(effect.low - 1e-9 <= over <= effect.high + 1e-9, hidden)
            smallest[hidden.name] = min(smallest[hidden.name], abs(over))
            largest[hidden.name] = max(largest[hidden.name], abs(over))
        for name in CHALLENGED_EFFECTS:  # 40 draws span more than half of the range, on a logarithmic scale
            self.assertGreater(math.log(largest[name] / smallest[name]), 0.5 * math.log(15))

    def test_signs_are_random_if_both_are_plausible(self):
        signs = collections.defaultdict(set)
        for case in of_kind(drawn(3, ChallengeSize(per_effect=40)), CaseKind.effect):
            signs[case.effects[0].name].add(case.effects[0].amplitude > 0)
        for name, both in {"plate_tilt": True, "diameter_error": True, "adhesion": False, "friction": False}.items():
            # -1 is the lower bound of friction, and smaller than the library's own amplitudes
            self.assertEqual(signs[name], {True, False} if both else {True}, name)

    def test_pairs_are_two_different_clear_effects(self):
        for case in of_kind(drawn(4), CaseKind.pair):
            self.assertEqual(len({hidden.name for hidden in case.effects}), 2)
            for hidden in case.effects:
                effect = find_effect(hidden.name)
                least = min(abs(effect.first), abs(effect.second), effect.high)
                self.assertGreaterEqual(abs(hidden.amplitude) / FACTS.scales[hidden.name], least * (1 - 1e-9))

    def test_unknown_effects_are_not_in_the_library_of_their_diagnosis(self):
        others = {one.name: (one.low, one.high, one.both_signs) for one in OUTSIDE_EFFECTS}
        outside, struck = collections.Counter(), 0
        for case in of_kind(drawn(5), CaseKind.unknown):
            hidden, = case.effects
            if case.struck:
                struck += 1
                self.assertEqual(case.struck, ("plate_tilt", "plate_tilt_y") if hidden.name == "plate_tilt" else (hidden.name,))
            else:
                low, high, both_signs = others[hidden.name]
                self.assertIsNone(find_effect(hidden.name))
                self.assertTrue(low <= abs(hidden.amplitude) <= high and (both_signs or hidden.amplitude > 0), hidden)
                outside[hidden.name] += 1
        self.assertEqual(struck, 10)
        self.assertEqual(set(outside), set(others))
        self.assertLessEqual(max(outside.values()) - min(outside.values()), 1)

    def test_nuisances_are_drawn_from_their_priors_or_far_outside(self):
        within, far = [], []
        for case in drawn(6).cases:
            self.assertEqual([shift.name for shift in case.nuisances], list(SIGMAS))
            for shift in case.nuisances:
                sigmas = abs(shift.amplitude) / SIGMAS[shift.name]
                (far if case.kind == CaseKind.outside_prior and sigmas >= 4 else within).append(sigmas)
        self.assertEqual(len(far), 20)
        self.assertLessEqual(max(far), 8)
        # chi-square, four sigmas
        self.assertAlmostEqual(sum(s * s for s in within) / len(within), 1, delta=4 * math.sqrt(2 / len(within)))

    def test_every_kind_is_in_both_halves(self):
        dealt, packings = collections.defaultdict(lambda: [0, 0]), collections.Counter()
        for case in drawn(7).cases:
            what = case.effects[0].name if case.kind == CaseKind.effect else case.kind
            dealt[what][in_first_half(case.packing)] += 1
            packings[case.packing] += 1
        for what, (first, second) in dealt.items():
            self.assertLessEqual(abs(first - second), 1, what)
        self.assertEqual(len(packings), 24)
        self.assertLessEqual(max(packings.values()) - min(packings.values()), 1)

    def test_order_is_random(self):
        """Mean position of the cases without an effect: the middle, within four standard errors."""
        cases = drawn(8).cases
        places = [k for k, case in enumerate(cases) if case.kind == CaseKind.none]
        self.assertAlmostEqual(sum(places) / len(places), (len(cases) - 1) / 2, delta=4 * len(cases) / math.sqrt(12 * len(places)))

    def test_invalid_options_are_reported(self):
        with self.assertRaises(InputError) as raised:
            drawn(1, ChallengeSize(pairs=-1, packings=3), ["friction", "magic", "finite_strain"])
        self.assertEqual([problem.split(";")[0] for problem in raised.exception.problems], [
            "--pairs must be 0 or more, got -1", "--packings must be an even number, one half for the limits and one for the score, got 3",
            "--effects: magic is not an effect", "--effects: finite_strain cannot be tried: no grains have it"])
        with self.assertRaisesRegex(InputError, "--effects: two at least are needed, for pairs"):
            drawn(1, tried=["friction"])


class Truth(unittest.TestCase):
    def test_is_read_back_as_written(self):
        self.assertEqual(parse_truth(truth_text(drawn(9)).encode(), "truth.json"), drawn(9))

    def test_a_published_truth_is_written_again(self):
        """The same content; another version wrote some numbers with one digit more."""
        content = PUBLISHED.read_bytes()
        self.assertEqual(json.loads(truth_text(parse_truth(content, PUBLISHED))), json.loads(content))

    def test_others_are_refused(self):
        text = truth_text(drawn(9, ChallengeSize(1, 0, 0, 0, 0, 2)))
        for content, problem in ((text.replace('"format": 1', '"format": 2'), "made by another version"),
                                 (text.replace('"none"', '"nothing"'), "not the truth of a challenge .there is no nothing"),
                                 (text[:-9], "not the truth of a challenge")):
            with self.assertRaisesRegex(InputError, f"^t.json: {problem}"):
                parse_truth(content.encode(), "t.json")


if __name__ == "__main__":
    unittest.main()
