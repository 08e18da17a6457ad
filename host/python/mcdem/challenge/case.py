"""The hidden truth of a challenge: the differences of each simulated experiment from the scene."""
import enum
from dataclasses import dataclass


class CaseKind(enum.StrEnum):
    none = "none"  # only what every case has: hidden nuisances, other numerics, noise
    effect = "effect"  # one effect of the library
    pair = "pair"  # two of them
    unknown = "unknown"  # an effect that the library of its diagnosis does not have
    outside_prior = "outside_prior"  # no effect, but a nuisance far outside its prior


@dataclass(frozen=True)
class Hidden:
    """An effect or a nuisance with its amplitude."""
    name: str
    amplitude: float


@dataclass(frozen=True)
class ChallengeCase:
    folder: str  # of its experiment, in the folder of the challenge
    kind: str  # a CaseKind
    effects: tuple[Hidden, ...]  # of the library; for unknown ones others, or effects removed from the library
    nuisances: tuple[Hidden, ...]  # shifts of all nuisances
    struck: tuple[str, ...]  # effects that its diagnosis may not name
    packing: int  # number of its packing
    seed: int  # for its jitter, random properties of its effects, and its noise


@dataclass(frozen=True)
class Challenge:
    seed: int
    scene_sha256: str  # of the scene's text
    packing_seeds: tuple[int, ...]  # by packing
    cases: tuple[ChallengeCase, ...]  # in the order of their folders


def in_first_half(packing: int) -> bool:
    """Limits are set on the cases of one half of the packings and scored on the other."""
    return packing % 2 == 0
