"""mcdem calibrate: gamma of MC-DEM, or E of another model, from the top force of an experiment."""
import argparse
import contextlib
import math
from typing import TYPE_CHECKING

from ..parts import interruptible
from ..program import say
from ..progress import Progress
from .command_line import at_least_zero, output_path, whole_in
from .scene_options import add_device_option, add_scene_options, read_scene
from .sources import add_reference_options

if TYPE_CHECKING:
    from .._engine import Scene
    from ..calibration.scene_calibration import Options, SceneCalibration
    from ..observe.estimate import Estimate
    from ..observe.replicas import Replicas

EPILOG = """\
The scene gives packings, materials and protocol; its contact.model and contact.gamma are not used.
More packings (batch.replicas) reduce the error: single runs scatter by 1 to 3 %.
Examples (DIR: your experiment folder):
  mcdem calibrate scenes/compression.toml --experiment DIR --discard 5 --out out/gamma
  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --rounds 2
  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --model hyperelastic_sphere"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add_reference_options(parser, "--experiment", "Experiment folder or run whose mean top force at maximum compression is the target",
                          required=True)
    parser.add_argument("--model", metavar="MODEL", default="mc_dem",
                        help="mc_dem: fit gamma; any other contact model: fit Young's modulus of the grains")
    parser.add_argument("--out", metavar="DIR", type=output_path, help="Folder for calibration.json")
    add_device_option(parser)
    parser.add_argument("--low", metavar="VALUE", type=at_least_zero, default=0.5,
                        help="Lower end of the search: gamma, or E divided by the scene's E")
    parser.add_argument("--high", metavar="VALUE", type=at_least_zero, default=1.5,
                        help="Upper end of the search: gamma, or E divided by the scene's E")
    parser.add_argument("--tolerance", metavar="ERROR", type=at_least_zero, default=0.005,
                        help="Stop at this standard error of gamma, or of E divided by the scene's E")
    parser.add_argument("--batch", metavar="N", type=whole_in(3, 10_000), default=6,
                        help="Number of values that are simulated together in one round")
    parser.add_argument("--rounds", metavar="N", type=whole_in(1, 10_000), default=8, help="Maximum number of rounds")


def run(options: argparse.Namespace) -> int:
    from .. import _engine
    from ..calibration.calibration_json import calibration_document, calibration_json
    from ..observe.reference import load_reference
    from ..outputs import CALIBRATION, expect_replaceable, output_folder, replace_own
    wanted = _calibration_options(options)
    reference = load_reference(options.experiment, options.setting, options.discard)
    scene = read_scene(options)
    with contextlib.ExitStack() as stack:
        if options.out:
            file = stack.enter_context(output_folder(options.out)) / "calibration.json"
            expect_replaceable(file, CALIBRATION)
        result = _calibrate(scene, reference.replicas, wanted)
        print(_text(result))
        if options.out:
            document = calibration_document(result, scene.text, reference.label, _engine.__version__)
            replace_own(file, CALIBRATION, calibration_json(document).encode())
            print(f"wrote {file}")
    return 0


def _calibration_options(options: argparse.Namespace) -> "Options":
    from ..calibration.scene_calibration import Options, calibrated_model
    from ..calibration.search import Bracket, SearchOptions
    return Options(calibrated_model(options.model, "--model"), Bracket(options.low, options.high),
                   SearchOptions(options.tolerance, options.batch, options.rounds), options.device)


def _calibrate(scene: "Scene", reference: "Replicas", options: "Options") -> "SceneCalibration":
    from ..calibration.scene_calibration import calibrate_scene
    with interruptible("nothing is kept"), Progress() as progress:
        def note(text: str) -> None:
            progress.clear()
            say(text)

        return calibrate_scene(scene, reference, options, progress.show, note)


def _text(result: "SceneCalibration") -> str:
    """A table of all evaluations, the target, the value found and its error."""
    from ..observe.estimate import Estimate
    from ..report.text_table import Column, TextTable, to_text
    name, in_kPa, unit = ("E", " kPa", 1e-3 * result.unit) if result.of_modulus else ("gamma", "", 1.0)
    rows = [[str(number), f"{unit * value:.4f}", _with_error(Estimate(force), 3) if math.isfinite(force) else "runs away"]
            for number, one in enumerate(result.found.rounds, 1)
            for value, force in zip(one.values.tolist(), one.top_force.tolist(), strict=True)]
    table = TextTable([Column("round"), Column("E [kPa]" if result.of_modulus else "gamma"), Column("top force [N]")], rows)
    found = Estimate(unit * result.found.value, unit * result.standard_error)
    lines = [f"target: {_with_error(result.target, 3)} N at {result.displacement * 1e3:.2f} mm; {result.replicas} "
             f"replica{'' if result.replicas == 1 else 's'} for each value",
             f"{name} = {_with_error(found, 4)}{in_kPa}"
             + ("" if result.found.converged else " (tolerance not reached: raise --rounds, or use more replicas)")]
    if not result.knows_scatter:
        lines.append(f"the error leaves out the scatter between packings, because {_single(result)} a single packing; this is correct only "
                     "if both are the same packing")
    return "\n".join([to_text(table), *lines])


def _single(result: "SceneCalibration") -> str:
    if math.isfinite(result.simulated.standard_error):
        return "the reference has"
    return "the scene has" if math.isfinite(result.target.standard_error) else "scene and reference each have"


def _with_error(estimate: "Estimate", decimals: int) -> str:
    """ "0.430 ± 0.012"; without the error if it is unknown. More decimals if fewer than two significant digits would be left, of the value
    or of a larger error."""
    has_error = math.isfinite(estimate.standard_error)
    size = max(abs(estimate.value), estimate.standard_error if has_error else 0)
    if size > 0:
        decimals = max(decimals, 1 - math.floor(math.log10(size)))
    value = f"{estimate.value:.{decimals}f}"
    return f"{value} ± {estimate.standard_error:.{decimals}f}" if has_error else value
