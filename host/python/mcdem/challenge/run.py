"""Diagnoses every case of a blind challenge from its experiment only."""
import contextlib
import hashlib
import json
import os
import pathlib
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from .. import _engine as engine
from ..diagnosis.decision import Findings
from ..diagnosis.diagnose import Listener, diagnose, make_simulations
from ..diagnosis.diagnose import Options as DiagnoseOptions
from ..diagnosis.diagnosis_json import diagnosis_json
from ..diagnosis.evidence import Evidence
from ..diagnosis.evidence_file import evidence_text, findings_text
from ..diagnosis.library import Library, library_text, read_library, write_library
from ..diagnosis.library_origin import expect_origin
from ..diagnosis.library_parts import expect_device, missing_parts
from ..diagnosis.library_simulations import build_library
from ..diagnosis.simulations import Simulations
from ..errors import InputError
from ..experiment.experiment import Experiment
from ..experiment.read import read_experiment
from ..files import read_input, write_whole
from ..look import is_there
from ..manifest import keep_manifest, manifest_file
from ..outputs import make_folder, make_folder_of, output_folder, remove_temporaries, remove_temporaries_of
from .files import OpenCase, OpenChallenge, answer_file, evidence_file, findings_file, read_open_challenge

FILE_OF_A_RUN = re.compile(r"run\.h5|checkpoint\..*|segment-\d{1,6}\.h5|parts", re.ASCII | re.DOTALL)

Progress = Callable[[float], object]


@dataclass(frozen=True)
class Options:
    challenge: str  # its folder
    out: str  # folder: case_0001.json .., library.json, evidence/, findings/, simulations/
    library: str  # file; computed if it does not exist
    library_packings: int = 16  # of a new library: generated, different from those of the cases
    library_replicates: int = 4  # per packing
    library_pairs: int = 1  # number of replicates that are repeated with every effect
    candidates: Sequence[str] = ()  # of a new library; none: all
    replicates: int = 8  # of the unchanged scene for each experiment
    confirmations: int = 4
    seed: int = 1
    device: str = ""


@contextlib.contextmanager
def challenge_work(scene: engine.Scene, options: Options, tell: Callable[[str], object], shared: bool) -> Iterator["ChallengeWork"]:
    """The diagnoses of a challenge, while the folder is locked. `tell` receives why a case cannot be diagnosed; its file contains the
    reason, and it counts as a miss.

    Raises InputError, also if the folder contains a run, is in use by other programs, or contains diagnoses with other options; RunError.
    """
    challenge = read_open_challenge(options.challenge)
    if hashlib.sha256(scene.text.encode()).hexdigest() != challenge.scene_sha256:
        raise InputError(f"{scene.name}: is not the scene that {os.path.join(options.challenge, 'challenge.json')} was made with")
    for case in challenge.cases:
        if not is_there(os.path.join(options.challenge, case.folder, "experiment.toml")):
            raise InputError(f"{options.challenge}: {case.folder} is not made yet: continue with `mcdem challenge make`")
    with output_folder(options.out, shared) as out:
        for entry in sorted(os.listdir(out)):
            if FILE_OF_A_RUN.fullmatch(entry):
                raise InputError(f"{out}: holds a run ({entry}): give another folder for the diagnoses of a challenge")
        _expect_own_options(scene, options)
        make_folder_of(options.library)  # before the library is computed
        remove_temporaries_of(options.library)
        for folder in ("evidence", "findings"):
            make_folder(out / folder)
        for folder in ("", "simulations", "evidence", "findings"):
            remove_temporaries(out / folder)
        yield ChallengeWork(scene, options, challenge, tell)


def _expect_own_options(scene: engine.Scene, options: Options) -> None:
    """Raises InputError if the diagnoses in the folder were begun with other options."""
    numbers = {f"--{name.replace('_', '-')}": str(getattr(options, name)) for name in
               ("replicates", "confirmations", "library_packings", "library_replicates", "library_pairs", "seed")}
    content = read_input(os.path.join(options.challenge, "challenge.json"))
    keep_manifest(manifest_file(options.out), {**engine.manifest_of(scene), **numbers, "challenge": hashlib.sha256(content).hexdigest(),
                                               "--candidates": ",".join(options.candidates)})


class ChallengeWork:
    """The diagnoses, one part each, and before them batches of the library's simulations if the library does not exist yet."""

    def __init__(self, scene: engine.Scene, options: Options, challenge: OpenChallenge, tell: Callable[[str], object]) -> None:
        self._scene, self._options, self._tell = scene, options, tell
        self._folder, self._cases = pathlib.Path(options.out), challenge.cases
        self._library: Library | None = None

    def count(self) -> int:
        return len(self._cases) + self._others.count_parts()

    def missing(self) -> list[int]:
        """Cases have the first numbers, but are computed last because they need the library."""
        cases = self._missing_cases()
        if not cases or is_there(self._options.library):
            return cases
        return [len(self._cases) + part for part in missing_parts(self._others, self._folder)] or cases

    def compute(self, part: int, progress: Progress) -> None:
        if part >= len(self._cases):
            if not is_there(self._options.library):
                expect_device(self._others, self._folder)
                self._others.compute_part(part - len(self._cases), progress)
        elif not self._is_done(self._cases[part]):
            self._diagnose(self._cases[part], self._make_library(progress), progress)

    def merge(self) -> bool:
        return not self._missing_cases()

    def all(self, progress: Progress) -> None:
        """Everything that is missing."""
        cases = self._missing_cases()
        if not cases:
            return
        done = 0.0 if is_there(self._options.library) else self._work_of_library()
        a_case = self._options.replicates + 2 * self._options.confirmations
        whole = done + a_case * len(cases)
        library = self._make_library(lambda fraction: progress(done * fraction / whole))

        def after(before: float) -> Progress:
            return lambda fraction: progress((before + a_case * fraction) / whole)

        for number, case in enumerate(cases):
            self._diagnose(self._cases[case], library, after(done + a_case * number))

    def _is_done(self, case: OpenCase) -> bool:
        return is_there(answer_file(self._folder, case))

    def _missing_cases(self) -> list[int]:
        return [number for number, case in enumerate(self._cases) if not self._is_done(case)]

    @cached_property
    def _others(self) -> Simulations:
        """The library's simulations: other packings of the same kind, measured as the first case."""
        options = self._options
        return Simulations.of_others(
            self._scene, self._first_experiment, options.library_packings, self._folder / "simulations",
            candidates=list(options.candidates), replicates=options.library_replicates, pairs=options.library_pairs, seed=options.seed,
            device=options.device)

    @cached_property
    def _first_experiment(self) -> Experiment:
        """Its measurement determines the library."""
        return self._experiment(self._cases[0])

    @cached_property
    def _first(self) -> Simulations:
        return self._simulations(self._first_experiment, self._how(()))

    def _work_of_library(self) -> float:
        """Number of simulations, for the progress."""
        facts = self._others.facts()
        return float(facts["packings"] * facts["replicates"] + 2 * len(facts["probes"]) * len(facts["paired_rows"]))

    def _make_library(self, progress: Progress) -> Library:
        """Reads the library, or computes it for the measurement of the first case, and copies it to the results. Raises InputError if its
        origin differs, or the results belong to another one."""
        if self._library:
            return self._library
        file, copy = self._options.library, self._folder / "library.json"
        expect_device(self._first, self._folder)
        if not is_there(file):  # another process may write the same library in the meantime
            write_library(file, build_library(self._others, progress))
        library = read_library(file)
        expect_origin(library, self._first.origin, file)
        if not write_library(copy, library) and read_input(copy) != library_text(library).encode():
            raise InputError(f"{copy}: is another library than {file}, and cases there were diagnosed with it: give that library, or "
                             "another folder (--out)")
        self._library = library
        return library

    def _experiment(self, case: OpenCase) -> Experiment:
        return read_experiment(os.path.join(self._options.challenge, case.folder))

    def _how(self, candidates: Sequence[str]) -> DiagnoseOptions:
        options = self._options
        return DiagnoseOptions(candidates=candidates, replicates=options.replicates, confirmations=options.confirmations,
                               paper_metrics=False, seed=options.seed, library=self._folder / "library.json")  # metrics are not scored

    def _simulations(self, experiment: Experiment, how: DiagnoseOptions) -> Simulations:
        return make_simulations(self._scene, [experiment], self._folder / "simulations", how, self._options.device)

    def _diagnose(self, case: OpenCase, library: Library, progress: Progress) -> None:
        folder = self._folder

        class Keeper(Listener):
            def progress(self, stage: str, fraction: float) -> None:
                progress(0.5 * fraction if stage == "baseline" else 0.5 + 0.5 * fraction)

            def evidence(self, evidence: Evidence) -> None:
                write_whole(evidence_file(folder, case), evidence_text(evidence).encode())

            def findings(self, findings: Findings) -> None:
                write_whole(findings_file(folder, case), findings_text(findings).encode())

        how = self._how([effect.name for effect in library.effects if case.candidates is None or effect.name in case.candidates])
        try:
            text = diagnosis_json(diagnose(self._scene, self._simulations(self._experiment(case), how), how, Keeper()))
        except InputError as error:
            text = json.dumps({"problem": str(error)}, indent=1, ensure_ascii=False) + "\n"
            self._tell(f"{case.folder}: could not be diagnosed: {error}")
        write_whole(answer_file(folder, case), text.encode())


def run_challenge(scene: engine.Scene, options: Options, progress: Progress, tell: Callable[[str], object]) -> None:
    """Diagnoses all cases that are not diagnosed yet. Raises as challenge_work."""
    with challenge_work(scene, options, tell, shared=False) as work:
        work.all(progress)
