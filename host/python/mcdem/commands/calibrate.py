"""mcdem calibrate: keys of a scene from an experiment; gamma of MC-DEM, or E of another model, from its top force."""
import argparse
import contextlib
import functools
import math
from typing import TYPE_CHECKING

from ..errors import InputError
from ..number_text import mm
from ..parts import interruptible
from ..program import say
from ..progress import Progress
from .command_line import add_numbers, at_least_zero, given, names, output_path, whole_in
from .scene_options import add_device_option, add_scene_options, read_scene
from .sources import add_reference_options

if TYPE_CHECKING:
    from ..calibration.scene_calibration import SceneCalibration
    from ..observe.estimate import Estimate

EPILOG = """\
Without --fit one number is fitted to one: gamma, or E, to the top force at maximum compression. The
scene gives packings, materials and protocol; its contact.model and contact.gamma are not used.

With --fit any numeric keys of the scene are fitted together, by least squares with a trust region:
to the force on the plate over its displacement, loading and unloading, and to the contacts per grain
(Z) where both know them; programmes and cells scan by scan. The scene gives the start and the
contact model. All trials use the same packings. Reported are errors, correlations, keys which the
data do not determine, and what difference remains (the paper's Rtop, errf and errZ). Limits are those
of the keys, or KEY=LOW..HIGH. effects.diameter_error is an error of all diameters, strain_offset one
of the plate's zero; KEY+KEY move together and keep their ratio. With --out trials are kept in
DIR/trials: the same command continues an interrupted fit, and calibration.json has what was found
after every round.

More packings (batch.replicas) reduce the error: single runs scatter by 1 to 3 %.
Examples (DIR: your experiment folder):
  mcdem calibrate scenes/compression.toml --set contact.model=hyperelastic_sphere --experiment DIR \\
      --fit grains.youngs_modulus,grains.friction=0..0.3,strain_offset --out out/fit
  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --model mc_dem --fit grains.youngs_modulus --rounds 2
  mcdem calibrate scenes/compression.toml --experiment DIR --discard 5 --out out/gamma
  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --rounds 2
  mcdem calibrate scenes/small.toml --experiment out/small --setting mc_dem --model hyperelastic_sphere"""


SEARCH = {
    "low": (0.5, "VALUE", at_least_zero, "Lower end of the search: gamma, or E divided by the scene's E; not with --fit"),
    "high": (1.5, "VALUE", at_least_zero, "Upper end of the search: gamma, or E divided by the scene's E; not with --fit"),
    "tolerance": (0.005, "ERROR", at_least_zero, "Stop at this standard error of gamma, or of E divided by the scene's E; with --fit of each key over "
                  "its value"),
    "batch": (6, "N", whole_in(3, 10_000), "Number of values that are simulated together in one round; several keys: one, and two for each key"),
    "rounds": (8, "N", whole_in(1, 10_000), "Maximum number of rounds"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add_reference_options(parser, "--experiment", "Experiment folder or run whose mean top force at maximum compression, or with --fit its curves, are "
                          "the target; may be repeated",
                          required=True)
    parser.add_argument("--fit", metavar="KEY,..", type=names, action="extend", default=[],
                        help="Keys to fit together, each also as KEY=LOW..HIGH (SI units)")
    parser.add_argument("--compare", metavar="NAME,..", type=names, action="extend", default=[],
                        help="With --fit: what to compare, of force, coordination, top_force, force@MM, unloading_force@MM, coordination@MM "
                             "(MM: a displacement); default: force and coordination, or all of a programme")
    parser.add_argument("--model", metavar="MODEL",
                        help="mc_dem: fit gamma; any other contact model: fit Young's modulus of the grains (default: mc_dem). "
                             "With --fit: the contact model, by default the scene's")
    parser.add_argument("--out", metavar="DIR", type=output_path, help="Folder for calibration.json, with --fit also for the trials")
    add_device_option(parser)
    add_numbers(parser, SEARCH)


def run(options: argparse.Namespace) -> int:
    from ..calibration.calibrate import calibration_document
    from ..calibration.scene_calibration import Options, calibrate_scene, calibrated_model
    from ..calibration.search import SearchOptions
    from ..json_text import json_text
    from ..observe.reference import load_reference
    from ..outputs import CALIBRATION, expect_replaceable, output_folder, replace_own
    if options.fit:
        return _fit(options)
    if options.compare:
        raise InputError("--compare: is an option of --fit")
    wanted = Options(calibrated_model(options.model or "mc_dem", "--model"), SearchOptions(**given(options, SEARCH)), options.device)
    scene = read_scene(options)
    reference = load_reference(options.experiment, options.setting, options.discard, scene=scene)
    with contextlib.ExitStack() as stack:
        if options.out:
            file = stack.enter_context(output_folder(options.out)) / "calibration.json"
            expect_replaceable(file, CALIBRATION)
        with interruptible("nothing is kept"), Progress() as progress:
            def note(text: str) -> None:
                progress.clear()
                say(text)

            result = calibrate_scene(scene, reference.replicas, wanted, progress.show, note)
        print(_text(result))
        if options.out:
            document = calibration_document(result, scene.text, reference.label)
            replace_own(file, CALIBRATION, json_text(document, sort_keys=True).encode())
            print(f"wrote {file}")
    return 0


def _fit(options: argparse.Namespace) -> int:
    """Several keys."""
    from ..calibration.calibrate import fit_document
    from ..calibration.scene_fit import FitOptions, fit_scene
    from ..observe.reference import load_reference
    from ..outputs import CALIBRATION, expect_replaceable, output_folder, remove_temporaries
    from ..report.scene_fit import fit_text, round_text
    from .rounds import kept_words, told_and_kept
    scene = read_scene(options)
    reference = load_reference(options.experiment, options.setting, options.discard, scene=scene)
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(output_folder(options.out)) if options.out else None
        file = folder / "calibration.json" if folder else None
        if folder and file:
            expect_replaceable(file, CALIBRATION)
            remove_temporaries(folder / "trials")
        wanted = FitOptions(options.fit, options.compare, options.model or "", options.tolerance, options.batch, options.rounds,
                            options.device, folder / "trials" if folder else None)
        with interruptible(kept_words(folder)), Progress() as progress:
            document = functools.partial(fit_document, scene=scene.text, reference=reference.label)
            after_round = told_and_kept(progress, round_text, file, CALIBRATION, document)
            result = fit_scene(scene, reference.replicas, wanted, progress.show, after_round)
        print(fit_text(result))
        if file:
            print(f"wrote {file}")
    return 0


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
    lines = [f"target: {_with_error(result.target, 3)} N at {mm(result.displacement)} mm; {result.replicas} "
             f"replica{'' if result.replicas == 1 else 's'} for each value",
             f"{name} = {_with_error(found, 4)}{in_kPa}"
             + ("" if result.found.converged else " (tolerance not reached: raise --rounds, or use more replicas)")]
    if not result.knows_scatter:
        single = ("the reference has" if math.isfinite(result.simulated.standard_error) else
                  "the scene has" if math.isfinite(result.target.standard_error) else "scene and reference each have")
        lines.append(f"the error leaves out the scatter between packings, because {single} a single packing; this is correct only if both "
                     "are the same packing")
    return "\n".join([to_text(table), *lines])


def _with_error(estimate: "Estimate", decimals: int) -> str:
    """ "0.430 ± 0.012"; without the error if it is unknown. More decimals if fewer than two significant digits would be left, of the value
    or of a larger error."""
    has_error = math.isfinite(estimate.standard_error)
    size = max(abs(estimate.value), estimate.standard_error if has_error else 0)
    if size > 0:
        decimals = max(decimals, 1 - math.floor(math.log10(size)))
    value = f"{estimate.value:.{decimals}f}"
    return f"{value} ± {estimate.standard_error:.{decimals}f}" if has_error else value
