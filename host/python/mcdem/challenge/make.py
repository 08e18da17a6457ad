"""Generates a blind challenge: experiments with hidden effects are simulated, measured, and written as experiments that do not
reveal them."""
import os
import secrets
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from .. import _engine as engine
from ..diagnosis.effects import EFFECTS
from ..errors import InputError, RunError
from ..experiment.experiment import Measurement
from ..experiment.from_run import experiment_from
from ..experiment.write import write_experiment
from ..files import create_whole, read_input
from ..look import Path, is_there
from ..outputs import make_folder_of, output_folder, remove_temporaries, remove_temporaries_of
from .case import Challenge, ChallengeCase, Hidden
from .case_simulator import CaseSimulator
from .files import OpenCase, OpenChallenge, open_challenge_text, read_open_challenge
from .plan import CHALLENGED_EFFECTS, ChallengeSize, SceneFacts, draw_challenge, facts_of
from .truth import parse_truth, seal_of, truth_text

WEAKER = 0.8  # factor of the amplitudes of a case that diverged, for the next try
MAX_TRIES = 10
PART_OF_TRIES = 0.3  # of the progress: only the loading, and not all cases

Progress = Callable[[float], object]


@dataclass(frozen=True)
class Options:
    folder: str  # of the challenge
    truth: str  # truth file
    seed: int | None = None  # default: that of an existing truth file, otherwise a random one that nobody knows
    size: ChallengeSize = field(default_factory=ChallengeSize)
    effects: Sequence[str] = ()  # none: CHALLENGED_EFFECTS
    measurement: Measurement = Measurement(1e-4, 2e-5, 0.05, 0.004)
    device: str = ""
    measure: str = "all"  # of each experiment (from_run.MEASURED)


def make_challenge(scene: engine.Scene, options: Options, progress: Progress = lambda fraction: None) -> str:
    """Tests whether all cases can be simulated, and reduces the amplitudes of those that diverge. Then writes the truth,
    challenge.json, and missing folders, in this order. Returns the seal, the SHA-256 of the truth.

    Raises InputError if the scene is unsuitable or the folder contains another challenge, RunError if a simulation fails, and what
    `progress` raises.
    """
    simulator = CaseSimulator(scene, options.measurement, options.device)
    if os.path.realpath(options.truth) == os.path.realpath(_open_file(options)):
        raise InputError(f"{options.truth}: is what may be known of the challenge: give another file for the truth")
    with output_folder(options.folder):
        make_folder_of(options.truth)
        remove_temporaries_of(options.truth)
        return _Making(simulator, seal_of(scene.text.encode()), options, progress).all()


def _open_file(options: Options) -> str:
    return os.path.join(options.folder, "challenge.json")


def _effects_to_try(options: Options, facts: SceneFacts) -> Sequence[str]:
    return options.effects or [name for name in CHALLENGED_EFFECTS if not facts.hindrances[name]]


def _of_another_challenge(file: Path) -> InputError:
    return InputError(f"{file}: is of another challenge; choose another folder, or the same scene, seed and numbers")


def _changed(challenge: Challenge, numbers: Sequence[int], factor: float) -> Challenge:
    """With the amplitudes of the effects of these cases multiplied."""
    cases = list(challenge.cases)
    for number in numbers:
        hidden = tuple(Hidden(effect.name, factor * effect.amplitude) for effect in cases[number].effects)
        cases[number] = replace(cases[number], effects=hidden)
    return replace(challenge, cases=tuple(cases))


def _are_alike(one: Challenge, other: Challenge) -> bool:
    """Whether they are equal except for the amplitudes of effects, which may have been reduced."""
    first, second = (_changed(challenge, range(len(challenge.cases)), 0) for challenge in (one, other))
    return first == second


def _without_answer(case: ChallengeCase) -> OpenCase:
    names = tuple(effect.name for effect in EFFECTS if effect.name not in case.struck)
    return OpenCase(case.folder, names if case.struck else None)


class _Making:
    def __init__(self, simulator: CaseSimulator, scene_sha256: str, options: Options, progress: Progress) -> None:
        self._simulator, self._options, self._progress = simulator, options, progress
        self._sealed = read_input(options.truth) if is_there(options.truth) else None  # content of the truth file
        sealed = parse_truth(self._sealed, options.truth) if self._sealed is not None else None
        seed = options.seed if options.seed is not None else sealed.seed if sealed else secrets.randbits(64)
        facts = facts_of(simulator)
        self._challenge = draw_challenge(options.size, _effects_to_try(options, facts), facts, scene_sha256, seed)
        if sealed and not _are_alike(sealed, self._challenge):
            raise _of_another_challenge(options.truth)
        self._challenge = sealed or self._challenge

    def all(self) -> str:
        count = len(self._challenge.cases)
        missing = [number for number in range(count) if self._sealed is None or not self._is_complete(number)]
        if missing:
            self._simulator.make_packings(self._challenge.packing_seeds)
        if self._sealed is None:
            self._weaken_diverging()
        seal = self._seal_all()

        def progress(fraction: float) -> None:
            self._progress(PART_OF_TRIES + (1 - PART_OF_TRIES) * (1 - (1 - fraction) * len(missing) / count))

        for place, number, failure in self._simulated(missing, False, progress):
            self._write(place, number, failure)
        return seal

    def _is_complete(self, number: int) -> bool:
        """experiment.toml is written last."""
        return is_there(os.path.join(self._folder(number), "experiment.toml"))

    def _folder(self, number: int) -> str:
        return os.path.join(self._options.folder, self._challenge.cases[number].folder)

    def _simulated(self, numbers: Sequence[int], loading: bool, progress: Progress) -> Iterator[tuple[int, int, str]]:
        """Place in its batch, number, and why it failed, of each case: while its batch is the last one that was simulated."""
        size = self._simulator.at_once() if numbers else 1
        for first in range(0, len(numbers), size):
            batch = numbers[first:first + size]
            cases = [self._challenge.cases[number] for number in batch]
            failures = self._simulator.simulate(
                cases, loading, lambda fraction: progress((first + fraction * len(batch)) / len(numbers)))
            yield from zip(range(len(batch)), batch, failures, strict=True)

    def _weaken_diverging(self) -> None:
        """Dense packings with interacting contacts have no static solution above some amplitude. Such cases are loaded again with weaker
        effects before the truth is sealed."""
        tried = [number for number, case in enumerate(self._challenge.cases) if case.effects]
        for tries in range(MAX_TRIES + 1):
            failed = [number for _, number, failure in self._simulated(
                tried, True, lambda fraction: self._progress(PART_OF_TRIES * (1 if tries else fraction))) if failure]
            if not failed:
                return
            self._challenge, tried = _changed(self._challenge, failed, WEAKER), failed
        raise RunError(f"{len(tried)} simulated experiments diverge even with weak effects; compress less")

    def _seal_all(self) -> str:
        """Writes the truth first, then the public data."""
        truth = truth_text(self._challenge).encode() if self._sealed is None else self._sealed
        seal = seal_of(truth)
        public = OpenChallenge(self._challenge.scene_sha256, seal, tuple(map(_without_answer, self._challenge.cases)))
        file = _open_file(self._options)
        is_public = is_there(file)
        if is_public and read_open_challenge(self._options.folder) != public:
            raise _of_another_challenge(file)
        if not is_public:
            self._expect_no_cases()
        if self._sealed is None and not create_whole(self._options.truth, truth):
            raise _of_another_challenge(self._options.truth)
        if not is_public:
            create_whole(file, open_challenge_text(public).encode())
        return seal

    def _expect_no_cases(self) -> None:
        """Folders that exist before the challenge belong to something else."""
        for folder in map(self._folder, range(len(self._challenge.cases))):
            if is_there(folder):
                raise InputError(f"{folder}: is there without a challenge.json beside it, and is not replaced: give another folder (--out)")

    def _write(self, place: int, number: int, failure: str) -> None:
        """The case at this place of those that were simulated last."""
        if failure:
            raise RunError(f"{self._challenge.cases[number].folder}: its simulation failed at {failure}")
        recording, folder = self._simulator.measured(place), self._folder(number)
        remove_temporaries(folder)
        write_experiment(folder, experiment_from(recording, self._options.measurement, self._options.measure), gzip=True)
