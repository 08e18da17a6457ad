"""Draws the cases of a challenge from one seed."""
import enum
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from .. import _engine as engine
from ..diagnosis.effects import EFFECTS, find_effect
from ..errors import InputError
from .case import CaseKind, Challenge, ChallengeCase, Hidden
from .case_simulator import CaseSimulator
from .outside_effects import OUTSIDE_EFFECTS

# Default effects of a challenge: of contacts, grains, plate and measurement.
CHALLENGED_EFFECTS = ("cross_contact", "friction", "adhesion", "viscoelasticity", "stiffening", "plasticity", "buoyancy",
                      "diameter_error", "modulus_scatter", "plate_tilt", "plate_compliance", "force_bias", "gauge_drift")

TWINS = (("plate_tilt", "plate_tilt_y"),)  # effects that differ only in direction

EVERY_STRUCK = 4  # of the unknown cases, one in this number has its effect removed from the library
NEAREST, FARTHEST = 4.0, 8.0  # shifts of nuisances outside their prior, in sigmas
FAR_NUISANCES = "modulus", "strain_offset"


@dataclass(frozen=True)
class ChallengeSize:
    """Number of cases of each kind."""
    none: int = 60
    per_effect: int = 8
    pairs: int = 20
    unknown: int = 40  # one in four with its effect removed from the library, the others with each of OUTSIDE_EFFECTS in turn
    outside_prior: int = 20  # modulus and strain_offset in turn
    packings: int = 24  # an even number


@dataclass(frozen=True)
class SceneFacts:
    """What the draws need to know of the scene, by names of effects and nuisances."""
    scales: Mapping[str, float]  # natural scales of amplitudes
    hindrances: Mapping[str, str]  # reasons why the scene cannot have an effect; empty if it can
    sigmas: Mapping[str, float]  # priors of the nuisances


def facts_of(simulator: CaseSimulator) -> SceneFacts:
    stated = simulator.stated
    return SceneFacts({effect.name: effect.scale(stated) for effect in EFFECTS}, {effect.name: effect.hindrance(stated) for effect in EFFECTS},
                 {one.name: one.sigma for one in simulator.nuisances})


class Strength(enum.Enum):
    """Smallest amplitude, of the smaller and the larger one of the library."""
    any = "a tenth of the smaller"
    clear = "the smaller"
    strong = "the larger"


class Drawing:
    def __init__(self, facts: SceneFacts, seed: int) -> None:
        self._facts = facts
        self.random = engine.Random(seed, "challenge")

    def effect(self, name: str, strength: Strength) -> Hidden:
        """Log-uniform up to 1.5 times the larger amplitude of the library's paired runs, and plausible."""
        effect = find_effect(name)
        assert effect
        smaller, larger = sorted((abs(effect.first), abs(effect.second)))
        least = {Strength.any: 0.1 * smaller, Strength.clear: smaller, Strength.strong: larger}[strength]
        size = self._log_uniform(least, 1.5 * larger)
        has_both_signs = -effect.low >= larger
        amplitude = max(-size, effect.low) if has_both_signs and self._sign() < 0 else min(size, effect.high)
        return Hidden(name, amplitude * self._facts.scales[name])

    def outside(self, name: str, low: float, high: float, both_signs: bool) -> Hidden:
        """An effect that is in no library."""
        size = self._log_uniform(low, high)
        return Hidden(name, size * self._sign() if both_signs else size)

    def from_priors(self) -> tuple[Hidden, ...]:
        """Shifts of all nuisances."""
        normals = self.random.normals(len(self._facts.sigmas)).tolist()
        return tuple(Hidden(name, sigma * normal) for (name, sigma), normal in zip(self._facts.sigmas.items(), normals, strict=True))

    def outside_prior(self, name: str) -> Hidden:
        sign = self._sign()
        return Hidden(name, sign * self.random.uniform(NEAREST, FARTHEST) * self._facts.sigmas[name])

    def _log_uniform(self, low: float, high: float) -> float:
        return float(low * (high / low) ** self.random.uniform())

    def _sign(self) -> int:
        return -1 if self.random.uniform() < 0.5 else 1


def _with_twin(name: str) -> tuple[str, ...]:
    """The effect, and the same effect in another direction if there is one."""
    return next((pair for pair in TWINS if name in pair), (name,))


def _draw_cases(size: ChallengeSize, effects: Sequence[str], draw: Drawing) -> list[ChallengeCase]:
    """Cases of all kinds, sorted by kind."""
    cases = list[ChallengeCase]()

    def add(kind: CaseKind, hidden: Sequence[Hidden] = (), struck: Sequence[str] = ()) -> None:
        cases.append(ChallengeCase("", kind, tuple(hidden), draw.from_priors(), tuple(struck), 0, 0))

    for _ in range(size.none):
        add(CaseKind.none)
    for name in effects:
        for _ in range(size.per_effect):
            add(CaseKind.effect, [draw.effect(name, Strength.any)])
    for _ in range(size.pairs):
        both = draw.random.shuffled(len(effects))[:2]
        add(CaseKind.pair, [draw.effect(effects[k], Strength.clear) for k in both])
    struck = [effects[k] for k in draw.random.shuffled(len(effects))]
    others = [(one.name, one.low, one.high, one.both_signs) for one in OUTSIDE_EFFECTS]
    for k in range(size.unknown):
        strikes, is_other = divmod(k, EVERY_STRUCK)
        if is_other:
            add(CaseKind.unknown, [draw.outside(*others[(k - strikes - 1) % len(others)])])
        else:
            name = struck[strikes % len(struck)]
            add(CaseKind.unknown, [draw.effect(name, Strength.strong)], _with_twin(name))
    for k in range(size.outside_prior):
        shift = draw.outside_prior(FAR_NUISANCES[k % 2])
        add(CaseKind.outside_prior)
        cases[-1] = replace(cases[-1], nuisances=tuple(shift if own.name == shift.name else own for own in cases[-1].nuisances))
    return cases


def _deal_packings(cases: list[ChallengeCase], packings: int, random: engine.Random) -> None:
    """Distributes every kind evenly over both halves, and over the packings of each half."""
    for half in range(2):
        mine = range(half, len(cases), 2)
        for k, place in enumerate(random.shuffled(len(mine))):
            cases[mine[place]] = replace(cases[mine[place]], packing=2 * (k % (packings // 2)) + half)


def _check(size: ChallengeSize, effects: Sequence[str], facts: SceneFacts) -> None:
    options = {"none": size.none, "per-effect": size.per_effect, "pairs": size.pairs, "unknown": size.unknown,
               "outside": size.outside_prior}
    problems = [f"--{option} must be 0 or more, got {value}" for option, value in options.items() if value < 0]
    if size.packings < 2 or size.packings % 2:
        problems.append(f"--packings must be an even number, one half for the limits and one for the score, got {size.packings}")
    for name in effects:
        if not find_effect(name):
            known = ", ".join(effect.name for effect in EFFECTS)
            problems.append(f"--effects: {name} is not an effect; there are {known}")
        elif facts.hindrances[name]:
            problems.append(f"--effects: {name} cannot be tried: {facts.hindrances[name]}")
    if len(effects) < 2:
        problems.append("--effects: two at least are needed, for pairs")
    if problems:
        raise InputError(problems)


def draw_challenge(size: ChallengeSize, effects: Sequence[str], facts: SceneFacts, scene: str, seed: int) -> Challenge:
    """Nuisances are drawn from their priors. Every kind is distributed evenly over both halves, and the order of cases and packings is
    random. `scene`: SHA-256 of its text. Raises InputError if size or effects are unsuitable."""
    _check(size, effects, facts)
    draw = Drawing(facts, seed)
    cases = _draw_cases(size, effects, draw)
    _deal_packings(cases, size.packings, draw.random)
    order = draw.random.shuffled(len(cases))
    packing_seeds, seeds = (tuple(engine.derived_seed(seed, number + 1) for number in numbers) for numbers in
                            (range(size.packings), range(size.packings, size.packings + len(cases))))
    ordered = (replace(cases[place], seed=own_seed) for place, own_seed in zip(order, seeds, strict=True))
    return Challenge(seed, scene, packing_seeds, tuple(replace(case, folder=f"case_{k + 1:04}") for k, case in enumerate(ordered)))
