"""mcdem diagnose: where a simulation and an experiment differ, and which effect is consistent with the difference."""
import argparse
import contextlib
import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from ..parts import PartedWork, SharedWork, add_sharing_options, interruptible, is_shared, share
from ..program import say
from ..progress import StageProgress
from .command_line import add_numbers, any_seed, given, names, number_in, output_path, whole_in
from .scene_options import add_scene_options, read_scene

if TYPE_CHECKING:
    from .._engine import Scene
    from ..diagnosis.diagnose import Listener, Options
    from ..diagnosis.diagnosis_types import Diagnosis
    from ..diagnosis.simulations import Simulations
    from ..experiment.experiment import Experiment

EPILOG = """\
The scene describes the simulation; box, plate and scans are taken from the experiment. Prints the verdict in
six lines, after one with stated parameters to check first if there are any, and writes
diagnosis.json, diagnosis.html and figures to DIR. Simulations are kept in
DIR/simulations: nothing is computed twice, and the same command continues an interrupted diagnosis.
Many devices or nodes can compute the simulations of the library in parts; --merge then does the rest of the
diagnosis (`mcdem distribute diagnose ..` does both).
Several packings of one experiment (--experiment A --experiment B) get one verdict and one amplitude, and a
check of how well they agree. Each packing takes as long as a diagnosis of its own.
Verdicts: no_gap, effect, group (effects that these data cannot tell apart), unknown_effect (none of the
library), not_converged (the simulation's own numerics), calibration_suspect.
The first entry under Next says what to do with the verdict.
`mcdem experiment check DIR` reports beforehand what can be diagnosed from the data.
Example, with a simulation as the experiment:
  mcdem run scenes/small.toml --set protocol.scan_at_start=true --out out/begun
  mcdem experiment from-run out/begun --replica mc_dem --out out/measured
  mcdem diagnose scenes/small.toml --set contact.model=independent --experiment out/measured --out out/diagnosis"""


NUMBERS = {
    "replicates": (32, "N", whole_in(8, 10_000), "Number of runs of the unchanged scene; their scatter is the noise floor"),
    "pairs": (8, "N", whole_in(2, 10_000), "Number of runs of each effect at each of its two amplitudes; at most --replicates"),
    "confirmations": (8, "N", whole_in(0, 10_000),
                      "Number of runs that confirm each proposed effect at its fitted amplitude; 0: none"),
    "refine": (4, "FACTOR", number_in(1, 64),
               "If the scene is not converged: largest factor by which plate.speed, grains.density or numerics.time_step is lowered before "
               "the diagnosis is repeated (runs take up to that much longer); 1: never, and pauses of the experiment's plate are not "
               "simulated"),
    "seed": (1, "N", any_seed, "Seed of all random numbers"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument("--experiment", metavar="DIR", action="append", required=True, dest="experiments",
                        help="Experiment folder; may be repeated to diagnose several packings together")
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True,
                        help="Folder for the verdict, the page and the simulations")
    parser.add_argument("--candidates", metavar="A,B,..", type=names, action="extend", default=[], help="Candidate effects; default: all")
    add_numbers(parser, NUMBERS)
    parser.add_argument("--library", metavar="FILE", type=output_path,
                        help="File with the simulated changes by each effect, for use with further experiments; read if it exists, "
                             "otherwise computed and written")
    parser.add_argument("--no-figures", action="store_true", help="Do not draw figures")
    add_sharing_options(parser)


def run(options: argparse.Namespace) -> int:
    scene = read_scene(options)
    if not is_shared(options):
        return _run_alone(options, scene)
    return share(SharedWork(options.out, lambda _: _begin_parts(options, scene), lambda: _run_alone(options, scene)), options)


@contextlib.contextmanager
def _begin_parts(options: argparse.Namespace, scene: "Scene") -> Iterator[PartedWork]:
    from ..diagnosis.library_parts import LibraryParts
    from ..outputs import output_folder
    experiments = _read(options)
    with output_folder(options.out, shared=True) as folder:
        yield LibraryParts(_simulations(options, scene, experiments), folder, options.library)


def _run_alone(options: argparse.Namespace, scene: "Scene") -> int:
    from ..diagnosis.diagnosis_json import diagnosis_json
    from ..outputs import DIAGNOSIS, PAGE, expect_replaceable, make_folder_of, output_folder, remove_temporaries, replace_own
    from ..report.draw import expect_replaceable_figures
    from ..report.present_diagnosis import present
    experiments = _read(options)
    with output_folder(options.out) as folder:
        remove_temporaries(folder / "simulations")
        if options.library:
            make_folder_of(options.library)
        for name, kind in (("diagnosis.json", DIAGNOSIS), ("diagnosis.html", PAGE)):
            expect_replaceable(folder / name, kind)
        if not options.no_figures:
            expect_replaceable_figures(folder, ("where", "which", "how_far", "law"))
        diagnosis = _diagnose(options, scene, experiments)
        replace_own(folder / "diagnosis.json", DIAGNOSIS, diagnosis_json(diagnosis).encode())
        present(options.out, figures=not options.no_figures)
    return 0


def _diagnose(options: argparse.Namespace, scene: "Scene", experiments: "Sequence[Experiment]") -> "Diagnosis":
    from ..diagnosis.diagnose import Listener, diagnose

    class Teller(Listener):
        def progress(self, stage: str, fraction: float) -> None:
            stages.show(stage, fraction)

        def note(self, text: str) -> None:
            stages.clear()
            say(text)

    with interruptible(), StageProgress() as stages:
        simulations = _simulations(options, scene, experiments, Teller())
        say(f"{scene.name} against {', '.join(one.name for one in experiments)} on {simulations.device_name}")
        _warn_of_odd_data(experiments)
        return diagnose(scene, simulations, _diagnosis_options(options), Teller())


def _diagnosis_options(options: argparse.Namespace) -> "Options":
    from ..diagnosis.diagnose import Options
    return Options(candidates=options.candidates, library=options.library, **given(options, NUMBERS))


def _read(options: argparse.Namespace) -> "list[Experiment]":
    from ..experiment.read import read_experiments
    return read_experiments(options.experiments, "--experiment")


def _simulations(options: argparse.Namespace, scene: "Scene", experiments: "Sequence[Experiment]",
                 listener: "Listener | None" = None) -> "Simulations":
    from ..diagnosis.diagnose import make_simulations
    return make_simulations(scene, experiments, os.path.join(options.out, "simulations"), _diagnosis_options(options), options.device,
                            listener)


def _warn_of_odd_data(experiments: "Sequence[Experiment]") -> None:
    from ..experiment.check import Severity, check_experiment
    for experiment in experiments:
        odd = [finding.text for finding in check_experiment(experiment) if finding.severity == Severity.odd]
        if odd:
            more = f"; and {len(odd) - 1} more" if len(odd) > 1 else ""
            say(f"{experiment.name} has suspicious data: {odd[0]}{more}; `mcdem experiment check` lists them")
