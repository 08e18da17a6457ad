"""mcdem what-if: keys of a scene moved alone until a quantity is the measured one."""
import argparse
import contextlib
import functools

from ..errors import InputError
from ..parts import interruptible
from ..problems import to_number
from ..progress import Progress
from .command_line import above_zero, add_numbers, given, names, output_path, whole_in
from .scene_options import add_device_option, add_scene_options, read_scene
from .sources import add_reference_options

EPILOG = """\
Which key, moved alone, would bring the simulation to the measurement, and does the rest then agree?
Each key is moved until the target is met, or as near to it as it comes. All trials of a round are
simulated together, on the same packings. The table has the value needed, its relative change, and
what other quantities become. Quantities: top_force (at maximum compression), force@MM (on the plate,
loading), unloading_force@MM, coordination@MM (Z, contacts per grain), force_share@MM (over the top
force); MM: plate displacement in mm. effects.diameter_error is an error of all diameters,
strain_offset one of the plate's zero; KEY+KEY move together and keep their ratio. With --out trials
are kept: the same command continues.
Examples (DIR: your experiment folder):
  mcdem what-if scenes/compression.toml --set contact.model=hyperelastic_sphere --experiment DIR --out out/what-if
  mcdem what-if scenes/small.toml --set contact.model=mc_dem --target top_force=2.5 --keys grains.youngs_modulus --rounds 2
  mcdem what-if scenes/compression.toml --set contact.model=hyperelastic_sphere --set packing.file=input.data \\
      --target top_force=15.5 --keys grains.youngs_modulus,effects.diameter_error,grains.friction+walls.friction --show force_share@18"""

NUMBERS = {
    "accuracy": (0.005, "X", above_zero, "Relative difference from the target at which it counts as met"),
    "rounds": (6, "N", whole_in(1, 1000), "Maximum number of rounds"),
}


def target(text: str) -> tuple[str, float]:
    """NAME=VALUE"""
    name, _, value = text.partition("=")
    number = to_number(value)
    if not name or number is None:
        raise argparse.ArgumentTypeError(f"must be NAME=VALUE, as in top_force=15.5, got {text}")
    return name, number


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add_reference_options(parser, "--experiment", "Experiment folder or run; not needed with --target")
    parser.add_argument("--keys", metavar="KEY,..", type=names, action="extend", default=[],
                        help="Keys to move, each also as KEY=LOW..HIGH (SI units); default: moduli, friction, diameters, the plate's zero")
    parser.add_argument("--target", metavar="NAME=VALUE", type=target, help="Quantity and its value; default: the measured top force")
    parser.add_argument("--show", metavar="NAME,..", type=names, action="extend", default=[],
                        help="Other quantities in the table; default: force share at half stroke, Z at half and at full stroke")
    parser.add_argument("--out", metavar="DIR", type=output_path, help="Folder for what_if.json, the figure and the trials")
    add_device_option(parser)
    add_numbers(parser, NUMBERS)


def run(options: argparse.Namespace) -> int:
    from ..calibration.what_if import WhatIfOptions, what_if
    from ..observe.reference import load_reference
    from ..outputs import WHAT_IF, expect_replaceable, output_folder, remove_temporaries
    from ..report.draw import draw_figures, draw_if_possible, expect_replaceable_figures
    from ..report.what_if import round_text, what_if_document, what_if_figure_values, what_if_text
    from .rounds import kept_words, told_and_kept
    if not options.experiment and not options.target:
        raise InputError("--target: is required without --experiment, as in --target top_force=15.5")
    scene = read_scene(options)
    reference = load_reference(options.experiment, options.setting, options.discard, scene=scene) if options.experiment else None
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(output_folder(options.out)) if options.out else None
        file = folder / "what_if.json" if folder else None
        if folder and file:
            expect_replaceable(file, WHAT_IF)
            expect_replaceable_figures(folder, ("what_if",))
            remove_temporaries(folder / "trials")
        wanted = WhatIfOptions(options.keys, options.target, options.show, **given(options, NUMBERS), device=options.device,
                               folder=folder / "trials" if folder else None)
        document = functools.partial(what_if_document, scene=scene.text, reference=reference.label if reference else "")
        with interruptible(kept_words(folder)), Progress() as progress:
            after_round = told_and_kept(progress, round_text, file, WHAT_IF, document)
            result = what_if(scene, reference.replicas if reference else None, wanted, progress.show, after_round)
        print(what_if_text(result), end="")
        if file:
            print(f"wrote\n  {file}", flush=True)
            for figure in draw_if_possible(lambda: draw_figures(options.out, {"what_if": what_if_figure_values(result)})):
                print(f"  {figure}")
    return 0
